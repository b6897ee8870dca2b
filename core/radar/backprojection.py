"""Images by back-projection: slow, exact in the near field, and the reference for fast imaging."""

from concurrent.futures import ThreadPoolExecutor

import numba
import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.radar.aperture import aperture_weights, wave_directions
from core.radar.phase_history import PhaseHistory
from core.radar.waveform import SPEED_OF_LIGHT_M_PER_S
from core.radar.window import HAMMING, Window

OVERSAMPLING = 16
"""Samples of a range profile per Rayleigh cell; linear interpolation errs by at most 0.5 %."""

BLOCK_POINTS = 2048
"""Points that one call takes: neighbours read the same stretch of a profile, which stays cached."""

WORKERS = 4
"""Threads that share the blocks of an image; the kernel holds no lock."""


def backproject(
    history: PhaseHistory, points_m: Floats, *, window: Window = HAMMING
) -> NDArray[np.complex64]:
    """Return the complex image at points (…, 3) of the target frame, a unit point giving 1.

    Points outside the unambiguous swath of a pulse, c / 4Δf on either side of the origin, get
    nothing from it.

    Args:
        history: with the track's range_m the wavefronts are spheres about the radar, without they
            are planes.
        points_m: where to image; any plane or surface.
        window: weighs frequency and turn.

    Returns:
        (…) complex64, the shape of `points_m` without its last axis.

    Source: Munson, O'Brien and Jenkins, "A tomographic formulation of spotlight-mode synthetic
    aperture radar", 1983; Gorham and Moore, "SAR image formation toolbox for MATLAB", 2010.
    """
    track = history.track
    points = np.asarray(points_m, dtype=np.float64)
    flat = np.ascontiguousarray(points.reshape(-1, 3))
    profiles, cell_m = _range_profiles(history, window)
    range_m = np.full(len(track), np.inf) if track.range_m is None else track.range_m
    wavenumber = 4 * np.pi / SPEED_OF_LIGHT_M_PER_S * float(history.frequency_hz.mean())
    directions = np.ascontiguousarray(wave_directions(history, slice(None)))
    image = np.zeros(len(flat), dtype=np.complex128)

    def add_block(start: int) -> None:
        where = slice(start, start + BLOCK_POINTS)
        _accumulate(profiles, cell_m, wavenumber, directions, range_m, flat[where], image[where])

    with ThreadPoolExecutor(WORKERS) as pool:
        list(pool.map(add_block, range(0, len(flat), BLOCK_POINTS)))
    return image.astype(np.complex64).reshape(points.shape[:-1])


def pulse_contributions(history: PhaseHistory, points_m: Floats) -> NDArray[np.complex64]:
    """Return what each pulse alone adds to the image at points (…, 3), (pulses, …).

    Summed over the pulses it is `backproject`'s image; a pulse whose phase is off by φ adds its
    part turned by φ, so that autofocus can work on these parts without imaging anew.
    """
    track = history.track
    points = np.asarray(points_m, dtype=np.float64)
    flat = np.ascontiguousarray(points.reshape(-1, 3))
    profiles, cell_m = _range_profiles(history, HAMMING)
    range_m = np.full(len(track), np.inf) if track.range_m is None else track.range_m
    wavenumber = 4 * np.pi / SPEED_OF_LIGHT_M_PER_S * float(history.frequency_hz.mean())
    directions = np.ascontiguousarray(wave_directions(history, slice(None)))
    parts = np.empty((len(track), len(flat)), dtype=np.complex64)

    def one_pulse(pulse: int) -> None:
        only = slice(pulse, pulse + 1)
        part = np.zeros(len(flat), dtype=np.complex128)
        direction = directions[only]
        _accumulate(profiles[only], cell_m, wavenumber, direction, range_m[only], flat, part)
        parts[pulse] = part

    with ThreadPoolExecutor(WORKERS) as pool:
        list(pool.map(one_pulse, range(len(track))))
    return parts.reshape(len(track), *points.shape[:-1])


def _range_profiles(history: PhaseHistory, window: Window) -> tuple[NDArray[np.complex64], float]:
    """Return weighted range profiles (pulses, cells) about the origin, and the cell's length.

    The middle of the band is taken out, so that a profile varies slowly from cell to cell.
    """
    by_pulse, by_frequency = aperture_weights(history, slice(None), window)
    count = len(by_frequency)
    weights = np.multiply.outer(by_pulse, by_frequency)
    cells = OVERSAMPLING * 2 ** int(np.ceil(np.log2(count)))
    spectrum = np.fft.ifft(history.samples * weights, cells, axis=1)
    place = np.arange(cells) - cells // 2
    to_middle = np.exp(-1j * np.pi * (count - 1) * place / cells)
    profiles = np.fft.fftshift(spectrum, axes=1) * (cells * to_middle)
    cell_m = SPEED_OF_LIGHT_M_PER_S / (2 * history.frequency_step_hz * cells)
    return profiles.astype(np.complex64), cell_m


@numba.njit(cache=True, nogil=True)  # type: ignore[untyped-decorator]
def _accumulate(
    profiles: NDArray[np.complex64],
    cell_m: float,
    wavenumber: float,
    line_of_sight: Floats,
    range_m: Floats,
    points_m: Floats,
    image: NDArray[np.complex128],
) -> None:  # pragma: no cover - compiled
    """Add to `image` (points,) what every pulse's profile (pulses, cells) says of each point."""
    pulses, cells = profiles.shape
    for pulse in range(pulses):
        k_x, k_y, k_z = line_of_sight[pulse]
        radar_m = range_m[pulse]
        for i in range(points_m.shape[0]):
            x, y, z = points_m[i]
            beyond = x * k_x + y * k_y + z * k_z
            if radar_m < np.inf:
                # R(p) − R(0) without the difference of two large numbers.
                square = x * x + y * y + z * z + 2 * radar_m * beyond
                beyond = square / (np.sqrt(square + radar_m * radar_m) + radar_m)
            place = beyond / cell_m + cells // 2
            cell = int(np.floor(place))
            if 0 <= cell < cells - 1:
                share = np.float32(place - cell)
                here, there = profiles[pulse, cell], profiles[pulse, cell + 1]
                phase = wavenumber * beyond
                turn = complex(np.cos(phase), np.sin(phase))
                image[i] += (here + share * (there - here)) * turn
