"""Echo simulation: what a radar would receive from a target, and with what noise."""

from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.geometry.track import LineOfSightTrack, accumulated_turn_rad
from core.radar.phase_history import PhaseHistory
from core.radar.scatterers import point_echoes
from core.radar.waveform import Waveform

__all__ = ["ScatteringModel", "point_echoes", "receiver_noise", "simulate_echoes"]


class ScatteringModel(Protocol):
    """What a target returns: diffuse points, a conducting surface, or a mixture of such."""

    def reach_m(self) -> float:
        """Return how far from the origin anything scatters."""

    def mean_echo_power(self) -> float:
        """Return the echo power averaged over all aspects, in m²."""

    def echoes(self, direction: Floats, frequency_hz: Floats) -> NDArray[np.complex64]:
        """Return noiseless echoes of pulses between which the lit side hardly changes.

        Args:
            direction: (pulses, 3) as `LineOfSightTrack.phase_direction` gives it.
            frequency_hz: (frequencies,) evenly spaced.

        Returns:
            (pulses, frequencies) with the phase that a `PhaseHistory` defines.
        """


def simulate_echoes(
    target: ScatteringModel,
    track: LineOfSightTrack,
    waveform: Waveform,
    *,
    signal_to_noise_db: float,
    random: np.random.Generator,
    shadow_step_rad: float = np.deg2rad(3.5),
    progress: Callable[[int, int], None] = lambda _done, _total: None,
) -> PhaseHistory:
    """Return the phase history of a self-shadowing target along a track.

    Every sample is the sum of what the lit side returns at the pulse's own line of sight
    (eqs. 1 and 2, after pulse compression and motion compensation to the target's origin), plus
    white receiver noise. What is lit is decided anew by ray casting whenever the line of sight
    has turned by `shadow_step_rad`, about one coherent interval. A bistatic pair's shadows are
    those of its bisector.

    Args:
        target: what scatters: `core.radar.scattering_models` makes one from a body.
        track: the line of sight at every pulse.
        waveform: band and sampling.
        signal_to_noise_db: mean echo power over all aspects (`mean_echo_power`) to noise power,
            both per pulse and frequency sample. It does not depend on which aspects a pass
            shows, nor on whether the target flashes there.
        random: for the noise.
        shadow_step_rad: largest turn over which the lit side is held.
        progress: told how many pulses are done, of how many.

    Raises:
        ValueError: the target is larger than the waveform's unambiguous range.
    """
    reach_m = 2 * target.reach_m()
    if reach_m > waveform.unambiguous_range_m:
        raise ValueError(
            f"The target spans {reach_m:.1f} m about its origin, more than the waveform's "
            f"unambiguous {waveform.unambiguous_range_m:.1f} m; use more frequency samples."
        )
    frequency = waveform.frequencies_hz()
    samples = np.empty((len(track), len(frequency)), dtype=np.complex64)
    direction = track.phase_direction()
    for start, stop in _steady_blocks(track, shadow_step_rad):
        samples[start:stop] = target.echoes(direction[start:stop], frequency)
        progress(stop, len(track))
    noise_power = target.mean_echo_power() * 10 ** (-signal_to_noise_db / 10)
    samples += receiver_noise(samples.shape, noise_power, random)
    return PhaseHistory(samples=samples, frequency_hz=frequency, track=track)


def receiver_noise(
    shape: tuple[int, ...], power: float, random: np.random.Generator
) -> NDArray[np.complex64]:
    """Return circular white Gaussian noise of the given mean power per sample."""
    scale = np.float32(np.sqrt(power / 2))
    parts = random.standard_normal((*shape, 2), dtype=np.float32) * scale
    noise: NDArray[np.complex64] = parts.view(np.complex64)[..., 0]
    return noise


def _steady_blocks(track: LineOfSightTrack, step_rad: float) -> Iterator[tuple[int, int]]:
    """Yield (start, stop) of pulses over which the line of sight turns by at most a step."""
    for start, stop in track.bursts():
        turn = accumulated_turn_rad(track.line_of_sight[start:stop])
        blocks = max(1, int(np.ceil(turn[-1] / step_rad - 1e-6)))
        edges = np.searchsorted(turn, turn[-1] * np.arange(1, blocks) / blocks)
        bounds = [start, *(start + edges).tolist(), stop]
        yield from ((a, b) for a, b in pairwise(bounds) if b > a)
