"""A transmitter and a receiver apart from each other, seen as one radar between them."""

import numpy as np

from core.arrays import Floats
from core.geometry.track import LineOfSightTrack

LEAST_SCALE = 0.1
"""cos(β/2) at β = 168.5°. Nearer to forward scattering the echoes hold next to no range."""


def bistatic_track(transmitter: LineOfSightTrack, receiver: LineOfSightTrack) -> LineOfSightTrack:
    """Return the track of the one radar that stands for a bistatic pair.

    A far point at p delays a pulse by (k_t + k_r)·p / c, and k_t + k_r is 2 cos(β/2) times the
    unit vector between both, where β is the bistatic angle. So the bisector is the line of sight
    and every frequency counts cos(β/2) times: from here on nothing knows of two radars. The
    delays are exact; that the strengths are a single radar's too holds for single reflections and
    angles at which both radars see the same side of the target.

    Args:
        transmitter: lines of sight from the transmitter to the target.
        receiver: lines of sight from the receiver to the target, at the same pulses.

    Returns:
        A track with `bisector_scale`; without ranges and station angles, which no one radar has.

    Raises:
        ValueError: other pulses, another epoch, or a bistatic angle near 180°.

    Source: Kell, "On the derivation of bistatic RCS from monostatic measurements", 1965.
    """
    _check_same_pulses(transmitter, receiver)
    half_path = (transmitter.line_of_sight + receiver.line_of_sight) / 2
    scale: Floats = np.linalg.norm(half_path, axis=1)
    if float(scale.min()) < LEAST_SCALE:
        raise ValueError(
            f"The bistatic angle reaches {np.rad2deg(2 * np.arccos(scale.min())):.1f}°; beyond "
            f"{np.rad2deg(2 * np.arccos(LEAST_SCALE)):.1f}° a pair hardly measures range. Leave "
            "those pulses out."
        )
    bisector = half_path / scale[:, None]
    half_rate = (transmitter.line_of_sight_rate_per_s + receiver.line_of_sight_rate_per_s) / 2
    across = half_rate - np.sum(half_rate * bisector, axis=1, keepdims=True) * bisector
    return LineOfSightTrack(
        time_s=transmitter.time_s,
        line_of_sight=bisector,
        line_of_sight_rate_per_s=across / scale[:, None],
        bisector_scale=scale,
        epoch_utc=transmitter.epoch_utc,
    )


def _check_same_pulses(transmitter: LineOfSightTrack, receiver: LineOfSightTrack) -> None:
    if len(transmitter) != len(receiver):
        raise ValueError(
            "Both lines of sight of a pair are wanted at the same pulses; got "
            f"{len(transmitter)} of the transmitter and {len(receiver)} of the receiver."
        )
    apart_s = float(np.abs(transmitter.time_s - receiver.time_s).max())
    step_s = float(np.diff(transmitter.time_s).min())
    if transmitter.epoch_utc != receiver.epoch_utc or apart_s > 1e-3 * step_s:
        raise ValueError(
            "Both lines of sight of a pair are wanted at the same pulses; they lie up to "
            f"{apart_s:.3g} s apart, epochs {transmitter.epoch_utc!r} and {receiver.epoch_utc!r}."
        )
    if transmitter.bisector_scale is not None or receiver.bisector_scale is not None:
        raise ValueError("A bistatic pair is made of two single radars, not of pairs.")
