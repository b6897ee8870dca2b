"""Division of a pass into coherent processing intervals, and which of them can be sharp."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from core.arrays import Floats
from core.geometry.track import LineOfSightTrack, accumulated_turn_rad
from core.radar.focus import (
    LARGEST_PHASE_RAD,
    FocusCriterion,
    IntervalVerdict,
    QuadraticPhase,
    quadratic_phase,
    verdict_on,
)

MIN_PULSES = 8
"""Pulses that an interval must hold for its window to mean anything."""

COARSEST = 3.0
"""An image this many times coarser than wanted is no longer the one that was asked for."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CoherentInterval:
    """Pulses that make one image.

    Attributes:
        start, stop: pulses start … stop − 1.
        middle: the pulse at half the turn, whose line of sight the image belongs to.
        turn_rad: angle by which the line of sight turns.
    """

    start: int
    stop: int
    middle: int
    turn_rad: float

    def alone(self) -> "CoherentInterval":
        """Return the same interval for a history that holds its own pulses only."""
        return CoherentInterval(
            start=0,
            stop=self.stop - self.start,
            middle=self.middle - self.start,
            turn_rad=self.turn_rad,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class AssessedInterval:
    """An interval of the wanted resolution with its verdict.

    Attributes:
        wanted: the interval of the wanted resolution.
        used: what an image is made of, None for a rejected interval.
        verdict: accepted, shortened or rejected, and why.
    """

    wanted: CoherentInterval
    used: CoherentInterval | None
    verdict: IntervalVerdict


@dataclass(frozen=True, slots=True, kw_only=True)
class Division:
    """How a pass is divided.

    Attributes:
        wavelength_m: λ at the middle of the band.
        cross_range_resolution_m: ρ, the wanted Rayleigh resolution.
        overlap: share of an interval that the next one uses again, 0 ≤ overlap < 1.
        target_radius_m: largest distance of a scatterer from the target frame's origin, for the
            focus criterion; None asks for no focus.
        criterion: what counts against an interval.
        coarsest_resolution_m: to which an interval may be shortened; None for three times ρ.

    Raises:
        ValueError: a length that is not positive, or an overlap out of range.
    """

    wavelength_m: float
    cross_range_resolution_m: float
    overlap: float = 0.0
    target_radius_m: float | None = None
    criterion: FocusCriterion = "angles"
    coarsest_resolution_m: float | None = None

    def __post_init__(self) -> None:
        lengths = (self.wavelength_m, self.cross_range_resolution_m)
        if not (all(np.isfinite(x) and x > 0 for x in lengths) and 0 <= self.overlap < 1):
            raise ValueError(
                "CPI division needs a positive wavelength and resolution in metres and an overlap "
                f"of 0 to below 1; got {self.wavelength_m}, {self.cross_range_resolution_m} and "
                f"{self.overlap}."
            )
        for name in ("target_radius_m", "coarsest_resolution_m"):
            value = getattr(self, name)
            if value is not None and not (np.isfinite(value) and value > 0):
                raise ValueError(f"{name} must be positive metres, got {value}.")

    @property
    def wanted_rad(self) -> float:
        """Turn of an interval, δ = λ / 2ρ (eq. 10)."""
        return self.wavelength_m / (2 * self.cross_range_resolution_m)

    @property
    def least_rad(self) -> float:
        """Turn to which an interval may be shortened."""
        return self.wanted_rad / (
            COARSEST
            if self.coarsest_resolution_m is None
            else max(1.0, self.coarsest_resolution_m / self.cross_range_resolution_m)
        )


def divide(
    track: LineOfSightTrack,
    *,
    wavelength_m: float,
    cross_range_resolution_m: float,
    overlap: float = 0.0,
    target_radius_m: float | None = None,
    criterion: FocusCriterion = "angles",
    coarsest_resolution_m: float | None = None,
) -> tuple[CoherentInterval, ...]:
    """Return intervals of constant accumulated angle δ = λ / 2ρ, and so of constant resolution.

    Intervals never span a gap between bursts, and those of a burst are spread evenly over it.
    Where a target's size is given, those that cannot be sharp are shortened or left out.

    Args:
        track: the line of sight at every pulse.
        wavelength_m: λ at the middle of the band.
        cross_range_resolution_m: ρ, the wanted Rayleigh resolution.
        overlap: share of an interval that the next one uses again, 0 ≤ overlap < 1.
        target_radius_m: for the focus criterion, None for none.
        criterion: what counts against an interval.
        coarsest_resolution_m: to which an interval may be shortened; None for three times ρ.

    Raises:
        ValueError: no burst turns far enough for even one interval, the pulses are too sparse, or
            no interval can be sharp.

    Source: eq. 10, whose azimuth resolution is λ / 2Δδ; eqs. 12–16 for the focus.
    """
    return usable(
        assess(
            track,
            Division(
                wavelength_m=wavelength_m,
                cross_range_resolution_m=cross_range_resolution_m,
                overlap=overlap,
                target_radius_m=target_radius_m,
                criterion=criterion,
                coarsest_resolution_m=coarsest_resolution_m,
            ),
        )
    )


def assess(track: LineOfSightTrack, division: Division) -> tuple[AssessedInterval, ...]:
    """Return all intervals of the wanted resolution in order, each with its verdict.

    Raises:
        ValueError: no burst turns far enough for even one interval, or the pulses are too sparse.
    """
    _check_sampling(track, division)
    assessed = tuple(
        _assessed(track, stretch, division)
        for start, stop in track.bursts()
        for stretch in _stretches(track, start, stop, division)
    )
    if not assessed:
        longest_rad = max(_total_turn_rad(track, *burst) for burst in track.bursts())
        raise ValueError(
            f"A cross-range resolution of {division.cross_range_resolution_m} m needs the line of "
            f"sight to turn by {np.rad2deg(division.wanted_rad):.2f}°, but it turns by at most "
            f"{np.rad2deg(longest_rad):.2f}° without a gap; ask for a coarser resolution."
        )
    return assessed


def usable(assessed: Sequence[AssessedInterval]) -> tuple[CoherentInterval, ...]:
    """Return what images can be made of, in order.

    Raises:
        ValueError: every interval was rejected.
    """
    intervals = tuple(each.used for each in assessed if each.used is not None)
    if not intervals:
        best = min(assessed, key=lambda each: each.verdict.resolution_m).verdict
        raise ValueError(
            f"None of {len(assessed)} intervals can be sharp. The best is in the {best.reason}. "
            "Ask for a coarser resolution, or judge by what the image former leaves (bending)."
        )
    return intervals


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Stretch:
    """A stretch of the turn within a burst: where the burst starts, its turn, and from where."""

    offset: int
    turn_rad: Floats
    begin_rad: float
    span_rad: float

    def interval(self) -> CoherentInterval:
        """Return the pulses of this stretch."""
        begin, span, turn = self.begin_rad, self.span_rad, self.turn_rad
        first, half, last = np.searchsorted(turn, [begin, begin + span / 2, begin + span - 1e-12])
        last = min(int(last), len(turn))
        steps = int(last - first)
        return CoherentInterval(
            start=self.offset + int(first),
            stop=self.offset + last,
            middle=self.offset + min(int(half), last - 1),
            # N pulses integrate N intervals' worth of turn, half a step beyond the outer ones.
            turn_rad=float(turn[last - 1] - turn[first]) * steps / max(steps - 1, 1),
        )

    def cut(self, span_rad: float) -> "_Stretch":
        """Return the middle of this stretch."""
        return _Stretch(
            offset=self.offset,
            turn_rad=self.turn_rad,
            begin_rad=self.begin_rad + (self.span_rad - span_rad) / 2,
            span_rad=span_rad,
        )


def _total_turn_rad(track: LineOfSightTrack, start: int, stop: int) -> float:
    turn = accumulated_turn_rad(track.line_of_sight[start:stop])
    return float(turn[-1]) * (stop - start) / max(stop - start - 1, 1)


def _stretches(
    track: LineOfSightTrack, start: int, stop: int, division: Division
) -> Iterator[_Stretch]:
    """Yield the stretches of one burst, spread evenly over it."""
    wanted_rad = division.wanted_rad
    total_rad = _total_turn_rad(track, start, stop)
    # A burst made for one interval may fall short of it by rounding.
    span_rad = min(wanted_rad, total_rad) if total_rad > 0.99 * wanted_rad else wanted_rad
    if total_rad < span_rad:
        return
    turn = accumulated_turn_rad(track.line_of_sight[start:stop])
    count = int((total_rad - span_rad) / (span_rad * (1 - division.overlap)) + 1e-9) + 1
    for begin in np.linspace(0.0, total_rad - span_rad, count):
        yield _Stretch(offset=start, turn_rad=turn, begin_rad=float(begin), span_rad=span_rad)


def _assessed(track: LineOfSightTrack, stretch: _Stretch, division: Division) -> AssessedInterval:
    interval = stretch.interval()
    if division.target_radius_m is None:
        verdict = IntervalVerdict(
            status="accepted",
            part="",
            reason="no target size was given",
            quadratic_phase_rad=None,
            resolution_m=division.wavelength_m / (2 * interval.turn_rad),
        )
        return AssessedInterval(wanted=interval, used=interval, verdict=verdict)
    return _focused(track, stretch, division, division.target_radius_m)


def _focused(
    track: LineOfSightTrack, stretch: _Stretch, division: Division, radius_m: float
) -> AssessedInterval:
    """Return the interval as wanted, or its longest middle that is sharp, or rejected."""

    def phase_of(interval: CoherentInterval) -> QuadraticPhase:
        return quadratic_phase(
            track,
            interval.start,
            interval.stop,
            wavelength_m=division.wavelength_m,
            target_radius_m=radius_m,
        )

    wanted = stretch.interval()
    used: CoherentInterval | None = wanted
    first = phase = phase_of(wanted)
    span_rad = stretch.span_rad
    while used is not None and phase.left_by(division.criterion) > LARGEST_PHASE_RAD:
        # The phase grows with the square of the turn.
        span_rad *= 0.99 * np.sqrt(LARGEST_PHASE_RAD / phase.left_by(division.criterion))
        used = stretch.cut(span_rad).interval()
        if span_rad < division.least_rad or used.stop - used.start < MIN_PULSES:
            used = None
        else:
            phase = phase_of(used)
    verdict = verdict_on(
        first,
        criterion=division.criterion,
        status="rejected" if used is None else "accepted" if used == wanted else "shortened",
        target_radius_m=radius_m,
        wanted_resolution_m=division.wavelength_m / (2 * wanted.turn_rad),
        sharp_resolution_m=division.wavelength_m / (2 * (used.turn_rad if used else span_rad)),
    )
    return AssessedInterval(wanted=wanted, used=used, verdict=verdict)


def _check_sampling(track: LineOfSightTrack, division: Division) -> None:
    wanted_rad = division.wanted_rad
    steps = [np.diff(accumulated_turn_rad(track.line_of_sight[a:b])) for a, b in track.bursts()]
    widest_rad = max((float(step.max()) for step in steps if len(step)), default=0.0)
    if wanted_rad < MIN_PULSES * widest_rad:
        coarsest_m = division.wavelength_m / (2 * MIN_PULSES * widest_rad)
        raise ValueError(
            f"The line of sight turns by up to {np.rad2deg(widest_rad):.3f}° from pulse to pulse, "
            f"so {np.rad2deg(wanted_rad):.3f}° holds fewer than {MIN_PULSES} pulses; "
            f"a resolution of {coarsest_m:.2g} m or finer can be had from these echoes."
        )
