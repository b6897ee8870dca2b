"""Polar format in plain NumPy: the same algorithm as the imaging engine's, without its library."""

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.radar.aperture import Aperture

OVERSAMPLING = 2
"""Of the grid over the image."""

TAPS = 6
"""Grid points over which a sample is spread, along each axis."""

SHAPE = float(np.pi * np.sqrt((TAPS / OVERSAMPLING) ** 2 * (OVERSAMPLING - 0.5) ** 2 - 0.8))
"""β of the Kaiser-Bessel kernel (Beatty, Nishimura and Pauly, 2005, eq. 5)."""


def numpy_polar_format(
    aperture: Aperture, shape: tuple[int, int], spacing_m: tuple[float, float]
) -> NDArray[np.complex128]:
    """Return the polar-format image, (rows, columns): spread, transform, divide by the kernel.

    Source: Jackson, Meyer, Nishimura and Macovski, "Selection of a convolution function for
    Fourier inversion using gridding", 1991.
    """
    wavenumber = aperture.wavenumber_rad_per_m
    along = np.outer(aperture.along, wavenumber) - wavenumber.mean()
    across = np.outer(aperture.across, wavenumber)
    size = (OVERSAMPLING * shape[0], OVERSAMPLING * shape[1])
    places = [
        (vector * step / (2 * np.pi) * count).ravel()
        for vector, step, count in zip((along, across), spacing_m, size, strict=True)
    ]
    first = [np.ceil(place - TAPS / 2).astype(np.int64) for place in places]
    grid = np.zeros(size[0] * size[1], dtype=np.complex128)
    samples = aperture.samples.ravel()
    columns = [(first[1] + tap) for tap in range(TAPS)]
    by_column = [(column % size[1], _kernel(column - places[1])) for column in columns]
    for tap in range(TAPS):
        row = first[0] + tap
        weighed = samples * _kernel(row - places[0])
        start = row % size[0] * size[1]
        for column, weight in by_column:
            np.add.at(grid, start + column, weighed * weight)
    image = np.fft.ifft2(grid.reshape(size)) * grid.size
    rows, row_gain = _central(shape[0], size[0])
    columns_, column_gain = _central(shape[1], size[1])
    found: NDArray[np.complex128] = image[np.ix_(rows, columns_)] / np.outer(row_gain, column_gain)
    return found


def _kernel(distance: Floats) -> Floats:
    inside = np.maximum(1 - (2 * distance / TAPS) ** 2, 0.0)
    kernel: Floats = np.i0(SHAPE * np.sqrt(inside))
    return kernel


def _central(count: int, size: int) -> tuple[NDArray[np.int64], Floats]:
    """Return which rows of the transform are the image's, and what the kernel does to each."""
    place = np.arange(count) - count // 2
    argument = np.sqrt(SHAPE**2 - (np.pi * TAPS * place / size) ** 2)
    return place % size, TAPS * np.sinh(argument) / argument
