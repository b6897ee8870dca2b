"""Plain range-Doppler imaging, as in the paper: two Fourier transforms and no more."""

import numpy as np
from numpy.typing import NDArray
from scipy.signal import CZT

from core.radar.intervals import CoherentInterval
from core.radar.phase_history import PhaseHistory
from core.radar.waveform import SPEED_OF_LIGHT_M_PER_S
from core.radar.window import Window

LARGEST_JITTER = 0.01
"""Of a pulse's time, in pulse intervals, that a Fourier transform over pulses does not mind."""


def range_doppler(
    history: PhaseHistory,
    interval: CoherentInterval,
    window: Window,
    shape: tuple[int, int],
    spacing_m: tuple[float, float],
) -> NDArray[np.complex64]:
    """Return the image by a transform over frequency and one over pulses, (rows, columns).

    The range of every scatterer is taken for fixed during the interval and its Doppler for
    constant, so that scatterers smear with their distance from the origin. Chirp-z transforms
    give the transforms' values at the pixels asked for.

    Args:
        history: echoes.
        interval: which pulses.
        window: weighs both axes.
        shape: (rows, columns); the origin lies at (rows // 2, columns // 2).
        spacing_m: size of a pixel in range and cross-range.

    Raises:
        ValueError: the pulses are not evenly spaced in time.

    Source: eqs. 4 to 6; the chirp-z transform: Rabiner, Schafer and Rader, 1969.
    """
    pulses = slice(interval.start, interval.stop)
    pulse_interval_s = _pulse_interval_s(history.track.time_s[pulses])
    rate_rad_per_s = float(history.track.rotation_rate_rad_per_s()[interval.middle])
    per_metre = 4 * np.pi / SPEED_OF_LIGHT_M_PER_S
    # f_d = −(2/λ) dR/dt: cross-range grows along dk/dt, so phases of pulses turn backwards as
    # those of frequencies do, and both transforms turn them forwards.
    steps = (
        per_metre * history.frequency_step_hz * spacing_m[0],
        2 * np.pi * 2 / history.wavelength_m * rate_rad_per_s * pulse_interval_s * spacing_m[1],
    )
    samples = history.samples[pulses]
    by_pulse, by_frequency = (
        window.weights((np.arange(count) + 0.5) / count) / count for count in samples.shape
    )
    profiles = _transform(samples * by_frequency, steps[0], shape[0])
    image = _transform(profiles.T * by_pulse, steps[1], shape[1])
    return image.astype(np.complex64)


def _transform(
    samples: NDArray[np.complex128], step_rad: float, count: int
) -> NDArray[np.complex128]:
    """Return Σₙ x[…, n] exp(+j n step (m − count // 2)) for m = 0 … count − 1."""
    forward = np.exp(1j * step_rad)
    transform = CZT(samples.shape[-1], count, w=forward, a=forward ** (count // 2))
    transformed: NDArray[np.complex128] = transform(samples)
    return transformed


def _pulse_interval_s(time_s: NDArray[np.float64]) -> float:
    step_s = float(time_s[-1] - time_s[0]) / (len(time_s) - 1)
    even = time_s[0] + step_s * np.arange(len(time_s))
    late = float(np.abs(time_s - even).max()) / step_s
    if late > LARGEST_JITTER:
        raise ValueError(
            f"Plain range-Doppler imaging needs evenly spaced pulses, but they come up to "
            f"{late:.2g} pulse intervals early or late; use polar format."
        )
    return step_s
