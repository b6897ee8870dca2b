"""The timeline of a pass: how the line of sight moves, and what its intervals are good for."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Canvas
from matplotlib.patches import Patch

from core.arrays import Floats
from core.experiments.pictures import Picture
from core.geometry.track import LineOfSightTrack
from core.radar.focus import LARGEST_PHASE_RAD, FocusCriterion
from core.radar.intervals import AssessedInterval, Division, assess
from core.radar.unsuitable import unsuitable_parts

COLOURS = {"accepted": "#3fbf7f", "shortened": "#e8b33a", "rejected": "#e0524d"}

CRITERIA: dict[FocusCriterion, str] = {
    "angles": "θ̈ and φ̈ (the paper's criterion)",
    "motion": "all motion (what plain range-Doppler leaves)",
    "bending": "bending (what polar format leaves)",
}


def timeline_picture(track: LineOfSightTrack, division: Division) -> Picture:
    """Return a picture of a pass with its intervals accepted, shortened and rejected.

    Args:
        track: with the station's azimuth and elevation.
        division: with a target's radius.
    """
    judged = {
        criterion: assess(track, replace(division, criterion=criterion)) for criterion in CRITERIA
    }

    def draw(canvas: Canvas) -> None:
        shares = {"height_ratios": [1.1, 0.9, *[1.0] * len(CRITERIA)]}
        angles, rate, *phases = canvas.subplots(
            2 + len(CRITERIA), 1, sharex=True, gridspec_kw=shares
        )
        _draw_angles(angles, track)
        rate.plot(track.time_s, np.rad2deg(track.rotation_rate_rad_per_s()), "#4fb3ff")
        rate.set(ylabel="|dk/dt| [°/s]", title="turn of the line of sight in the target frame")
        for axes, (criterion, title) in zip(phases, CRITERIA.items(), strict=True):
            _draw_verdicts(axes, track, judged[criterion])
            axes.set_title(f"quadratic phase on the rim by {title}")
        phases[-1].set(xlabel="time of the pass [s]", xlim=(track.time_s[0], track.time_s[-1]))
        patches = [Patch(color=colour, label=name) for name, colour in COLOURS.items()]
        canvas.legend(handles=patches, loc="outside lower center", ncols=3)

    return Picture(
        name="cpi-timeline",
        caption=(
            f"Coherent intervals of {division.cross_range_resolution_m:g} m resolution along a "
            f"pass that nears the zenith, for a target of {division.target_radius_m:.3g} m radius. "
            "Dots: the quadratic phase of each interval as wanted; dashed: π/4. The paper's angles "
            "reject the zenith part, where the line of sight itself runs straight and polar "
            "format stays sharp."
        ),
        draw=draw,
        size_in=(11.0, 11.0),
    )


def _draw_angles(axes: Axes, track: LineOfSightTrack) -> None:
    if track.azimuth_rad is None or track.elevation_rad is None:
        raise ValueError("A timeline is drawn of a pass over a station, with its angles.")
    axes.plot(track.time_s, np.rad2deg(track.elevation_rad), "#ff9a3c", label="elevation")
    axes.set(ylabel="elevation [°]", ylim=(0, 92), title="the pass as its station sees it")
    other = axes.twinx()
    azimuth: Floats = np.rad2deg(np.unwrap(track.azimuth_rad))
    other.plot(track.time_s, azimuth, "#b58cff", label="azimuth")
    other.set_ylabel("azimuth [°]")
    other.grid(visible=False)
    lines = [*axes.get_lines(), *other.get_lines()]
    axes.legend(lines, [str(line.get_label()) for line in lines], loc="center left")


def _draw_verdicts(
    axes: Axes, track: LineOfSightTrack, assessed: Sequence[AssessedInterval]
) -> None:
    time_s = track.time_s
    for each in assessed:
        colour = COLOURS[each.verdict.status]
        start_s, stop_s = time_s[each.wanted.start], time_s[each.wanted.stop - 1]
        axes.axvspan(start_s, stop_s, color=colour, alpha=0.13, lw=0)
        if each.used is not None:
            used_s = time_s[each.used.start], time_s[each.used.stop - 1]
            axes.axvspan(*used_s, color=colour, alpha=0.3, lw=0)
        phase_rad = max(each.verdict.quadratic_phase_rad or 0.0, 1e-3)
        axes.plot((start_s + stop_s) / 2, phase_rad, "o", color=colour, ms=4)
    axes.axhline(LARGEST_PHASE_RAD, color="#d5dbe5", ls="--", lw=1)
    axes.set(yscale="log", ylim=(5e-3, 300), ylabel="phase [rad]")
    for part in unsuitable_parts(track, assessed):
        middle_s = (part.start_s + part.stop_s) / 2
        axes.text(middle_s, 110, part.name, ha="center", va="center", fontsize=8)
