"""The Hamming window that weighs both axes of an image, and its point response."""

import numpy as np

from core.arrays import Floats

CONSTANT, COSINE = 0.54, 0.46

HALF_POWER_WIDTH_CELLS = 1.303
"""−3 dB width of the point response in Rayleigh cells (Harris, "On the use of windows for
harmonic analysis with the discrete Fourier transform", 1978, table 1: 1.30 bins)."""

FIRST_NULL_CELLS = 2.0
"""First null of the point response from its peak, in Rayleigh cells."""


def hamming(position: Floats) -> Floats:
    """Return the window at positions 0 … 1 across the aperture."""
    window: Floats = CONSTANT - COSINE * np.cos(2 * np.pi * np.asarray(position))
    return window


def point_response(place_cells: Floats) -> Floats:
    """Return the amplitude of the point response, 1 at its peak, `place_cells` away from it."""
    place = np.asarray(place_cells)
    sides = np.sinc(place - 1) + np.sinc(place + 1)
    response: Floats = np.sinc(place) + COSINE / (2 * CONSTANT) * sides
    return response
