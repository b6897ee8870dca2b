"""The CPI part of the physics experiment: constant resolution, and which intervals can be sharp."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from core.experiments.demo import demo_tracks
from core.experiments.physics.intervals_picture import timeline_picture
from core.experiments.physics.part import Part, Progress
from core.experiments.physics.point_spread import measured, with_points
from core.experiments.results import Figure
from core.geometry.track import LineOfSightTrack
from core.radar.focus import LARGEST_PHASE_RAD, FocusCriterion, quadratic_phase
from core.radar.imaging import ImagingSettings, interval_frame, interval_projection
from core.radar.intervals import AssessedInterval, CoherentInterval, Division, assess
from core.radar.phase_history import PhaseHistory
from core.radar.unsuitable import unsuitable_parts
from core.radar.waveform import Waveform
from core.targets import tiangong_like

ZENITH_PASS = 2
"""Of the demo's, the one that culminates 84° high."""

OVERLAPS = (0.0, 0.5)
RIM_PIXEL_M = 0.02
WIDENED = "<= 5 %"


def intervals_part(progress: Progress) -> Part:
    """Measure resolution and focus along the demo's three passes of Tiangong-1's orbit.

    Args:
        progress: told of stage, steps done and steps in all.
    """
    waveform = Waveform()
    tracks = demo_tracks(waveform)
    division = Division(
        wavelength_m=waveform.wavelength_m,
        cross_range_resolution_m=ImagingSettings().cross_range_resolution_m,
    )
    figures = [
        figure
        for number, track in enumerate(tracks, start=1)
        for figure in _resolution_figures(f"pass {number}", track, division)
    ]
    radius_m = float(np.linalg.norm(tiangong_like().mesh().vertices, axis=1).max())
    focused = replace(division, target_radius_m=radius_m)
    figures.append(Figure(name="target's radius about its origin", value=radius_m, unit="m"))
    for number, track in enumerate(tracks, start=1):
        figures += _verdict_figures(f"pass {number}", track, focused)
        progress("verdicts", number, len(tracks))
    figures += _zenith_figures(tracks[ZENITH_PASS], focused)
    figures += _rim_figures(tracks[0], replace(focused, criterion="bending"), waveform, progress)
    return Part(figures=tuple(figures), pictures=(timeline_picture(tracks[ZENITH_PASS], focused),))


def _resolution_figures(title: str, track: LineOfSightTrack, division: Division) -> list[Figure]:
    """Return how far frames are from the wanted resolution, and the overlap reached."""
    figures = []
    for overlap in OVERLAPS:
        found = [each.wanted for each in assess(track, replace(division, overlap=overlap))]
        reached = np.array([division.wavelength_m / (2 * each.turn_rad) for each in found])
        wanted_m = division.cross_range_resolution_m
        figures.append(
            Figure(
                name=f"{title}, overlap {100 * overlap:g} %: resolution of {len(found)} frames "
                f"from the wanted {wanted_m:g} m, worst",
                value=100 * float(np.abs(reached / wanted_m - 1).max()),
                unit="%",
                wanted="<= 1 %",
            )
        )
    return figures


def _verdict_figures(title: str, track: LineOfSightTrack, division: Division) -> list[Figure]:
    """Count the verdicts by each criterion, and hold what is used to the bound."""
    figures = []
    criteria: tuple[FocusCriterion, ...] = ("angles", "bending", "motion")
    for criterion in criteria:
        assessed = assess(track, replace(division, criterion=criterion))
        counts = Counter(each.verdict.status for each in assessed)
        figures += [
            Figure(name=f"{title}, {criterion}: {status} of {len(assessed)}", value=counts[status])
            for status in ("accepted", "shortened", "rejected")
        ]
        figures.append(
            Figure(
                name=f"{title}, {criterion}: largest quadratic phase of what is used",
                value=_largest_phase_rad(track, assessed, division, criterion),
                unit="rad",
                wanted=f"<= {LARGEST_PHASE_RAD:.6f} rad",
            )
        )
    return figures


def _largest_phase_rad(
    track: LineOfSightTrack,
    assessed: Sequence[AssessedInterval],
    division: Division,
    criterion: FocusCriterion,
) -> float:
    return max(
        (
            quadratic_phase(
                track,
                each.used.start,
                each.used.stop,
                wavelength_m=division.wavelength_m,
                target_radius_m=division.target_radius_m or 0.0,
            ).left_by(criterion)
            for each in assessed
            if each.used is not None
        ),
        default=0.0,
    )


def _zenith_figures(track: LineOfSightTrack, division: Division) -> list[Figure]:
    """Return what the pass near the zenith loses to the paper's angles, and what polar format."""
    assessed = assess(track, division)
    zenith = [part for part in unsuitable_parts(track, assessed) if part.name == "zenith part"]
    high = int(np.argmin(track.line_of_sight[:, 2]))
    over = next(each for each in assessed if each.wanted.start <= high < each.wanted.stop)
    phase = quadratic_phase(
        track,
        over.wanted.start,
        over.wanted.stop,
        wavelength_m=division.wavelength_m,
        target_radius_m=division.target_radius_m or 0.0,
    )
    title = "pass near the zenith"
    return [
        Figure(
            name=f"{title}: intervals rejected as its zenith part",
            value=sum(part.intervals for part in zenith),
            wanted=">= 1",
        ),
        Figure(
            name=f"{title}: length of its zenith part",
            value=sum(part.stop_s - part.start_s for part in zenith),
            unit="s",
        ),
        Figure(
            name=f"{title}: phase that θ̈ and φ̈ make at the culmination",
            value=phase.angles_rad,
            unit="rad",
        ),
        Figure(
            name=f"{title}: phase that polar format leaves there",
            value=phase.bending_rad,
            unit="rad",
            wanted=f"<= {LARGEST_PHASE_RAD:.6f} rad",
        ),
    ]


def _rim_figures(
    track: LineOfSightTrack, division: Division, waveform: Waveform, progress: Progress
) -> list[Figure]:
    """Image a scatterer on the rim, out of the plane, to see whether the verdicts are right."""
    assessed = assess(track, division)
    radius_m = division.target_radius_m or 0.0
    widened: dict[str, list[float]] = {"wanted": [], "used": []}
    chosen = [*assessed[:6], assessed[len(assessed) // 2]]
    for done, each in enumerate(chosen, start=1):
        for kind, interval in (("wanted", each.wanted), ("used", each.used)):
            if interval is not None:
                widened[kind].append(_widened(track, interval, radius_m, waveform))
        progress("rim", done, len(chosen))
    title = "scatterer on the rim above the image plane, polar format"
    return [
        Figure(
            name=f"{title}: −3 dB width from the window's, worst interval as wanted",
            value=100 * max(widened["wanted"]),
            unit="%",
        ),
        Figure(
            name=f"{title}: −3 dB width from the window's, worst interval as used",
            value=100 * max(widened["used"]),
            unit="%",
            wanted=WIDENED,
        ),
    ]


def _widened(
    track: LineOfSightTrack, interval: CoherentInterval, radius_m: float, waveform: Waveform
) -> float:
    """Return by what share a scatterer above the image plane is wider than the window's."""
    part, alone = track.part(interval.start, interval.stop), interval.alone()
    frequency = waveform.frequencies_hz()
    samples = np.zeros((len(part), len(frequency)), dtype=np.complex64)
    silent = PhaseHistory(samples=samples, frequency_hz=frequency, track=part)
    settings = ImagingSettings(shape=(256, 512), pixel_spacing_m=RIM_PIXEL_M)
    above_m = radius_m * interval_projection(silent, alone, settings).viewing_direction()
    echoes = with_points(silent, above_m[None], np.ones(1))
    response = measured(interval_frame(echoes, alone, settings), above_m)
    return abs(response.cuts[1].width_ratio - 1)
