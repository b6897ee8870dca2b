"""What one coherent interval's echoes are made of: where they lie, and how they are weighed."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.geometry.projection import Projection
from core.geometry.track import accumulated_turn_rad
from core.radar.intervals import CoherentInterval
from core.radar.phase_history import PhaseHistory
from core.radar.waveform import SPEED_OF_LIGHT_M_PER_S
from core.radar.window import Window


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Aperture:
    """The samples of an interval in the wave-vector plane of its image.

    Sample (n, m) belongs to the wave vector wavenumber[m] · (along[n], across[n]).

    Attributes:
        samples: (pulses, frequencies) complex64, weighed; a unit point's add up to 1 in phase.
        along: (pulses,) share of the wave vector along the image's range axis.
        across: (pulses,) share along its cross-range axis.
        wavenumber_rad_per_m: (frequencies,) 4πf / c.
    """

    samples: NDArray[np.complex64]
    along: Floats
    across: Floats
    wavenumber_rad_per_m: Floats


def aperture_of(
    history: PhaseHistory, interval: CoherentInterval, projection: Projection, window: Window
) -> Aperture:
    """Return the weighed samples of an interval with their places."""
    pulses = slice(interval.start, interval.stop)
    axes = projection.matrix[:, :3]
    axes = axes / np.linalg.norm(axes, axis=1, keepdims=True)
    along, across = axes @ wave_directions(history, pulses).T
    by_pulse, by_frequency = aperture_weights(history, pulses, window)
    weights = np.multiply.outer(by_pulse, by_frequency).astype(np.float32)
    return Aperture(
        samples=history.samples[pulses] * weights,
        along=along,
        across=across,
        wavenumber_rad_per_m=4 * np.pi / SPEED_OF_LIGHT_M_PER_S * history.frequency_hz,
    )


def wave_directions(history: PhaseHistory, pulses: slice) -> Floats:
    """Return what 4πf/c is multiplied with to give the wave vectors of some pulses, (pulses, 3)."""
    return history.track.phase_direction()[pulses]


def aperture_weights(history: PhaseHistory, pulses: slice, window: Window) -> tuple[Floats, Floats]:
    """Return the weights of pulses (pulses,) and frequencies (frequencies,), each adding up to 1.

    Pulses are weighed by the turn that each stands for too, so that a line of sight that turns
    faster and faster still gives the window's response.
    """
    turn = accumulated_turn_rad(history.track.line_of_sight[pulses])
    share = np.gradient(turn)
    share = share / share.sum()
    by_pulse = share * window.weights(np.cumsum(share) - share / 2)
    count = len(history.frequency_hz)
    by_frequency = window.weights((np.arange(count) + 0.5) / count)
    return by_pulse / by_pulse.sum(), by_frequency / by_frequency.sum()
