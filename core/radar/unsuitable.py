"""The parts of a pass that make no sharp image, by name."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby

from core.geometry.track import LineOfSightTrack
from core.radar.intervals import AssessedInterval


@dataclass(frozen=True, slots=True, kw_only=True)
class UnsuitablePart:
    """A stretch of a pass whose intervals were all rejected for the same reason.

    Attributes:
        name: such as "zenith part".
        start_s, stop_s: first and last pulse, on the track's time scale.
        intervals: how many were rejected.
        reason: of the worst of them.
    """

    name: str
    start_s: float
    stop_s: float
    intervals: int
    reason: str


def unsuitable_parts(
    track: LineOfSightTrack, assessed: Sequence[AssessedInterval]
) -> tuple[UnsuitablePart, ...]:
    """Return the stretches of a pass whose intervals were rejected, each by its name."""
    parts = []
    for part, run in groupby(assessed, lambda each: each.verdict.part if each.used is None else ""):
        if part:
            members = list(run)
            worst = max(members, key=lambda each: each.verdict.quadratic_phase_rad or 0.0)
            parts.append(
                UnsuitablePart(
                    name=part,
                    start_s=float(track.time_s[members[0].wanted.start]),
                    stop_s=float(track.time_s[members[-1].wanted.stop - 1]),
                    intervals=len(members),
                    reason=worst.verdict.reason,
                )
            )
    return tuple(parts)
