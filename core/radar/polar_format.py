"""Polar format and keystone: images free of range migration, by a nonuniform Fourier transform."""

import finufft
import numpy as np
from numpy.typing import NDArray
from scipy import fft

from core.arrays import Floats
from core.radar.aperture import Aperture

TRANSFORM_PRECISION = 1e-4
"""Asked of the nonuniform Fourier transform; images then differ from the direct sum by less than
10⁻⁴ of their brightest point (−80 dB), far below any window's sidelobes."""

NYQUIST_SHARE = 0.8
"""Of the band that the keystone's columns carry before its cross-range is focused."""

MARGIN_CELLS = 10.0
"""That the keystone images on either side beyond its blur, for the sidelobes that come in."""


def polar_format(
    aperture: Aperture, shape: tuple[int, int], spacing_m: tuple[float, float]
) -> NDArray[np.complex64]:
    """Return the polar-format image, (rows, columns).

    The samples lie on a polar raster of the wave-vector plane, (f cos α, f sin α) for the angle
    α of each pulse from the middle one; a type-1 nonuniform Fourier transform takes them straight
    to the pixels, so that a scatterer's walk through range cells and its Doppler's change during
    the interval cost nothing.

    Args:
        aperture: weighed samples with their places.
        shape: (rows, columns); the origin lies at (rows // 2, columns // 2).
        spacing_m: size of a pixel in range and cross-range.

    Source: Walker, "Range-Doppler imaging of rotating objects", 1980, for the polar raster;
    Barnett, Magland and af Klinteberg, 2019, for the transform.
    """
    return _transformed(aperture, aperture.along, shape, spacing_m)


def keystone(
    aperture: Aperture, shape: tuple[int, int], spacing_m: tuple[float, float]
) -> NDArray[np.complex64]:
    """Return the image by the keystone transform, (rows, columns).

    Slow time is stretched by the frequency, so that all frequencies share one cross-range
    wavenumber K = k sin α and the walk through range cells is gone, whatever the cross-range. What
    is left of the turn, √(k² − K²) − k per metre of range, is taken out row by row at the middle
    frequency; polar format needs no such step.

    Args:
        aperture: weighed samples with their places.
        shape: (rows, columns); the origin lies at (rows // 2, columns // 2).
        spacing_m: size of a pixel in range and cross-range.

    Source: Perry, DiPietro and Fante, "SAR imaging of moving targets", 1999.
    """
    rows, columns = shape
    wavenumber = aperture.wavenumber_rad_per_m
    middle, steepest = float(wavenumber.mean()), float(np.abs(aperture.across).max())
    finer = int(
        np.ceil(steepest * float(wavenumber.max()) * spacing_m[1] / (np.pi * NYQUIST_SHARE))
    )
    fine_m, asked = spacing_m[1] / finer, columns * finer
    range_m = (np.arange(rows) - rows // 2) * spacing_m[0]
    cell_m = np.pi / (middle * steepest)
    margin_m = steepest * float(np.abs(range_m).max()) + MARGIN_CELLS * cell_m
    count = fft.next_fast_len(asked + 2 * int(np.ceil(margin_m / fine_m)))
    walked = _transformed(
        aperture, np.ones_like(aperture.along), (rows, count), (spacing_m[0], fine_m)
    )
    across = 2 * np.pi * fft.fftfreq(count, fine_m)
    curve = np.sqrt(np.maximum(middle**2 - across**2, 0.0)) - middle
    turn = np.exp(1j * np.multiply.outer(range_m, curve)).astype(np.complex64)
    focused = fft.ifft(fft.fft(walked, axis=1) * turn, axis=1)
    first = count // 2 - finer * (columns // 2)
    image: NDArray[np.complex64] = focused[:, first : first + asked : finer]
    return image


def _transformed(
    aperture: Aperture,
    along: Floats,
    shape: tuple[int, int],
    spacing_m: tuple[float, float],
) -> NDArray[np.complex64]:
    wavenumber = aperture.wavenumber_rad_per_m
    # The middle wavenumber turns a row's phase, not its amplitude. Small differences are all that
    # single precision has to carry.
    off_middle = ((wavenumber - wavenumber.mean()) * spacing_m[0]).astype(np.float32)
    short = np.multiply.outer(
        ((along - 1) * spacing_m[0]).astype(np.float32), wavenumber.astype(np.float32)
    )
    across = np.multiply.outer(
        (aperture.across * spacing_m[1]).astype(np.float32), wavenumber.astype(np.float32)
    )
    image: NDArray[np.complex64] = finufft.nufft2d1(
        (short + off_middle).ravel(),
        across.ravel(),
        aperture.samples.ravel(),
        shape,
        eps=TRANSFORM_PRECISION,
        upsampfac=1.25,
        isign=1,
        nthreads=1,  # several add in any order, and the last digits change from run to run
    )
    return image
