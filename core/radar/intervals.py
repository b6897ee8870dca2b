"""Division of a pass into coherent processing intervals."""

from dataclasses import dataclass

import numpy as np

from core.geometry.track import LineOfSightTrack, accumulated_turn_rad

MIN_PULSES = 8
"""Pulses that an interval must hold for its window to mean anything."""


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


def divide(
    track: LineOfSightTrack,
    *,
    wavelength_m: float,
    cross_range_resolution_m: float,
    overlap: float = 0.0,
) -> tuple[CoherentInterval, ...]:
    """Return intervals of constant accumulated angle δ = λ / 2ρ, and so of constant resolution.

    Intervals never span a gap between bursts, and those of a burst are spread evenly over it.

    Args:
        track: the line of sight at every pulse.
        wavelength_m: λ at the middle of the band.
        cross_range_resolution_m: ρ, the wanted Rayleigh resolution.
        overlap: share of an interval that the next one uses again, 0 ≤ overlap < 1.

    Raises:
        ValueError: no burst turns far enough for even one interval, or the pulses are too sparse.

    Source: eq. 10, whose azimuth resolution is λ / 2Δδ.
    """
    if not (wavelength_m > 0 and cross_range_resolution_m > 0 and 0 <= overlap < 1):
        raise ValueError(
            "CPI division needs a positive wavelength and resolution in metres and an overlap of "
            f"0 to below 1; got {wavelength_m}, {cross_range_resolution_m} and {overlap}."
        )
    wanted_rad = wavelength_m / (2 * cross_range_resolution_m)
    intervals: list[CoherentInterval] = []
    longest_rad = 0.0
    _check_sampling(track, wanted_rad, wavelength_m)
    for start, stop in track.bursts():
        turn = accumulated_turn_rad(track.line_of_sight[start:stop])
        # N pulses integrate N intervals' worth of turn, half a step beyond the outer ones.
        total_rad = float(turn[-1]) * (stop - start) / max(stop - start - 1, 1)
        longest_rad = max(longest_rad, total_rad)
        # A burst made for one interval may fall short of it by rounding.
        span_rad = min(wanted_rad, total_rad) if total_rad > 0.99 * wanted_rad else wanted_rad
        count = int((total_rad - span_rad) / (span_rad * (1 - overlap)) + 1e-9) + 1
        if total_rad < span_rad:
            continue
        for begin in np.linspace(0.0, total_rad - span_rad, count):
            first, half, last = np.searchsorted(
                turn, [begin, begin + span_rad / 2, begin + span_rad - 1e-12]
            )
            last = min(int(last), stop - start)
            intervals.append(
                CoherentInterval(
                    start=start + int(first),
                    stop=start + last,
                    middle=start + min(int(half), last - 1),
                    turn_rad=float(turn[last - 1] - turn[first])
                    * (last - first)
                    / (last - first - 1),
                )
            )
    if not intervals:
        raise ValueError(
            f"A cross-range resolution of {cross_range_resolution_m} m needs the line of sight to "
            f"turn by {np.rad2deg(wanted_rad):.2f}°, but it turns by at most "
            f"{np.rad2deg(longest_rad):.2f}° without a gap; ask for a coarser resolution."
        )
    return tuple(intervals)


def _check_sampling(track: LineOfSightTrack, wanted_rad: float, wavelength_m: float) -> None:
    steps = [np.diff(accumulated_turn_rad(track.line_of_sight[a:b])) for a, b in track.bursts()]
    widest_rad = max((float(step.max()) for step in steps if len(step)), default=0.0)
    if wanted_rad < MIN_PULSES * widest_rad:
        coarsest_m = wavelength_m / (2 * MIN_PULSES * widest_rad)
        raise ValueError(
            f"The line of sight turns by up to {np.rad2deg(widest_rad):.3f}° from pulse to pulse, "
            f"so {np.rad2deg(wanted_rad):.3f}° holds fewer than {MIN_PULSES} pulses; "
            f"a resolution of {coarsest_m:.2g} m or finer can be had from these echoes."
        )
