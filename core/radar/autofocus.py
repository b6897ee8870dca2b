"""Autofocus: the phase errors of pulses, from the image alone.

Both estimators take what each pulse adds to an image (`pulse_contributions`), so that plane and
spherical wavefronts and the walk through range cells are treated exactly. A constant phase shows
nowhere in an image and one that grows evenly from pulse to pulse only shifts it along
cross-range: neither can be observed, and both are left out of the phases returned.
"""

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.radar.phase_history import PhaseHistory

GRADIENT_ROUNDS = 20
"""Rounds of the phase gradient; the window has reached its least width after 14."""

WINDOW_SHRINKS = 0.9
"""By which the window narrows from round to round."""

LEAST_WINDOW = 0.25
"""Share of the cross-range that the window keeps. Narrower ones pay for lone points, but cost a
diffuse body half a percent of entropy: there the noise is the body itself, at all Dopplers."""

PIXELS_PER_ROW = 3
"""Brightest pixels of a row that are taken for points."""

CLUTTER_FLOOR = 0.3
"""Clutter that every pixel is credited with, of the mean power: dark rows hold only noise."""

ENTROPY_ROUNDS = 150
"""Rounds of the minimum entropy at most."""

SETTLED = 1e-4
"""Change of the entropy in a round at which the phases count as found."""


def image_entropy(amplitude: NDArray[np.floating]) -> float:
    """Return the entropy −Σ p ln p of an image's power shares p, in nats; small is in focus.

    Raises:
        ValueError: the image is dark.

    Source: Kragh, "Monotonic iterative algorithm for minimum-entropy autofocus", 2006.
    """
    power = np.square(np.asarray(amplitude, dtype=np.float64))
    total = float(power.sum())
    if not total > 0:
        raise ValueError("A dark image has no entropy; all its amplitudes are zero.")
    share = power / total
    share = share[share > 0]
    return float(-(share * np.log(share)).sum())


def phase_gradient(contributions: NDArray[np.complex64]) -> Floats:
    """Return the pulses' phase errors in radians, (pulses,), by phase gradient autofocus.

    In every row the brightest pixels are taken as points; what the pulses say of them is weighed
    by their clutter, cut to a window of cross-range that narrows from round to round, and the
    phase's step from pulse to pulse is that of all points' summed products of neighbours.

    It is begun twice, and the image with less entropy decides. From the steps of whole range
    profiles, because points that walk from row to row show in each for a while: in a blurred
    image every row is centred on what it sees meanwhile, and the rounds may settle on a chain of
    such pieces. And from no phases, because a scene as wide as the pulses tell apart has
    unrelated profiles from pulse to pulse.

    Args:
        contributions: (pulses, rows, columns), rows along range, cross-range 0 in the middle.

    Source: Wahl, Eichel, Ghiglia and Jakowatz, "Phase gradient autofocus: a robust tool for high
    resolution SAR phase correction", 1994; the sum of products as the step's estimate is Jakowatz
    and Wahl's, "Eigenvector method for maximum-likelihood estimation of phase errors", 1993;
    several weighed points a row are Chan and Yeo's, "Noniterative quality phase-gradient
    autofocus (QPGA) algorithm for spotlight SAR imagery", 1998.
    """
    pulses, _, columns = contributions.shape
    starts = (np.zeros(pulses), _summed_steps(contributions[:, :, columns // 2]))
    found = [_gradient_rounds(contributions, start) for start in starts]
    best = min(found, key=lambda phase: image_entropy(_brightness(contributions, phase)))
    return without_drift(best)


def _gradient_rounds(contributions: NDArray[np.complex64], phase_rad: Floats) -> Floats:
    pulses = len(contributions)
    width = float(pulses)
    place = np.abs(np.fft.fftfreq(pulses) * pulses)
    for _ in range(GRADIENT_ROUNDS):
        spectrum = np.fft.fft(_weighed_points(contributions, phase_rad), axis=0)
        spectrum[place > width / 2] = 0
        phase_rad = without_line(phase_rad + _summed_steps(np.fft.ifft(spectrum, axis=0)))
        width = max(WINDOW_SHRINKS * width, LEAST_WINDOW * pulses)
    return phase_rad


def _brightness(contributions: NDArray[np.complex64], phase_rad: Floats) -> NDArray[np.float32]:
    """Return the image's amplitude (…) with phases taken out of its pulses."""
    amplitude: NDArray[np.float32] = np.abs(
        np.tensordot(_turned_back(phase_rad), contributions, axes=1)
    )
    return amplitude


def _summed_steps(said: NDArray[np.complexfloating]) -> Floats:
    """Return the phase that products of neighbouring pulses (pulses, points) add up to."""
    step = np.angle(np.sum(np.conj(said[:-1]) * said[1:], axis=1))
    phase: Floats = np.concatenate([[0.0], np.cumsum(step, dtype=np.float64)])
    return phase


def _weighed_points(
    contributions: NDArray[np.complex64], phase_rad: Floats
) -> NDArray[np.complex64]:
    """Return what each pulse says of the brightest pixels, (pulses, points), clutter at one."""
    pulses, rows, _ = contributions.shape
    column = np.argsort(-_brightness(contributions, phase_rad), axis=1)[:, :PIXELS_PER_ROW]
    said = contributions[:, np.arange(rows)[:, None], column].reshape(pulses, -1)
    said = said * _turned_back(phase_rad)[:, None]
    power = np.square(np.abs(said)).mean(axis=0)
    clutter = power - np.square(np.abs(said.mean(axis=0))) + CLUTTER_FLOOR * power.mean()
    weighed: NDArray[np.complex64] = said / np.sqrt(np.maximum(clutter, np.finfo(np.float32).tiny))
    return weighed


def minimum_entropy(
    contributions: NDArray[np.complex64], start_rad: Floats | None = None
) -> Floats:
    """Return the pulses' phase errors in radians, (pulses,), that leave the image least entropy.

    Each round weighs the image's pixels with the logarithm of their power over the mean, nothing
    below it, and turns every pulse to agree with the weighted image. Power times that logarithm
    is convex, so that no round lowers its sum. Without the floor the many dark pixels, whose
    logarithms are large and of noise, rule the weights and hundreds of rounds are needed.

    Args:
        contributions: (pulses, …); columns over the whole unambiguous cross-range keep the
            image's energy constant, so that none is pushed out of it.
        start_rad: (pulses,) phases to begin with, None for zero.

    Source: Kragh, "Monotonic iterative algorithm for minimum-entropy autofocus", 2006.
    """
    pulses = len(contributions)
    flat = contributions.reshape(pulses, -1)
    phase = np.zeros(pulses) if start_rad is None else np.asarray(start_rad, dtype=np.float64)
    before = np.inf
    for _ in range(ENTROPY_ROUNDS):
        image = _turned_back(phase) @ flat
        power = np.square(np.abs(image))
        entropy = image_entropy(np.abs(image))
        if abs(before - entropy) < SETTLED:
            break
        before = entropy
        weight = np.log(np.maximum(power / power.mean(), 1))
        phase = np.angle(flat @ np.conj(weight * image)).astype(np.float64)
    return without_drift(np.unwrap(phase))


def phase_corrected(history: PhaseHistory, phase_rad: Floats) -> PhaseHistory:
    """Return the history with phases (pulses,) in radians taken out of its pulses."""
    return PhaseHistory(
        samples=history.samples * _turned_back(phase_rad)[:, None],
        frequency_hz=history.frequency_hz,
        track=history.track,
        sensor=history.sensor,
    )


def without_drift(phase_rad: Floats) -> Floats:
    """Return phases (pulses,) whose mean step from pulse to pulse, whole turns apart, is zero.

    Noise adds whole turns to summed steps; a straight line fitted to them would shift the image.
    """
    step = float(np.angle(np.exp(1j * np.diff(phase_rad)).sum()))
    left: Floats = phase_rad - step * np.arange(len(phase_rad))
    return left


def without_line(phase_rad: Floats) -> Floats:
    """Return phases (pulses,) without their best straight line, which is not observable."""
    pulse = np.arange(len(phase_rad))
    left: Floats = phase_rad - np.polyval(np.polyfit(pulse, phase_rad, 1), pulse)
    return left


def centring_phase_rad(history: PhaseHistory) -> Floats:
    """Return the even growth of phase, (pulses,), that puts the target's middle off cross-range 0.

    Range alignment holds the body's middle at one range, which is where it stands if its Doppler
    is zero. Autofocus knows of no absolute Doppler and may leave the body anywhere: walking
    otherwise than its place says, it would blur.

    Source: Madsen, "Estimating the Doppler centroid of SAR data", 1989.
    """
    samples = history.samples
    step = np.angle(np.sum(np.conj(samples[:-1]) * samples[1:], dtype=np.complex128))
    line: Floats = step * np.arange(len(samples))
    return line


def _turned_back(phase_rad: Floats) -> NDArray[np.complex64]:
    turned: NDArray[np.complex64] = np.exp(-1j * phase_rad).astype(np.complex64)
    return turned
