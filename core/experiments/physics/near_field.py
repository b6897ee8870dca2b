"""Circular aperture at close range, held against where its points are."""

from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure as Canvas
from numpy.typing import NDArray
from scipy.ndimage import zoom

from core.arrays import Floats
from core.experiments.physics.part import Part, Progress
from core.experiments.pictures import Picture
from core.experiments.results import Figure
from core.frame import Frame
from core.geometry.track import LineOfSightTrack
from core.radar.circular_sar import (
    NearFieldSettings,
    body_waveform,
    circular_track,
    late_m,
    near_field_echoes,
    near_field_frames,
    sub_apertures,
)
from core.radar.phase_history import PhaseHistory

RANGE_M = 6.0
ALONG_M = (-0.9, -0.45, 0.0, 0.45, 0.9)
ACROSS_M = (-0.35, 0.0, 0.3)
HEIGHT_M = 0.3
"""How far off the frame's plane the second set of points stands: half a body's depth and more."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Shot:
    """Points before one sub-aperture, their frame, and where they ought to land."""

    frame: Frame
    points_m: Floats
    late_m: Floats

    def found(self) -> Floats:
        """Return where the points landed, (points, 2) as (row, column)."""
        wanted = self.wanted()
        return np.array([_peak_near(self.frame, place) for place in wanted])

    def wanted(self) -> Floats:
        """Return where the projection puts them, moved by what heights add to range."""
        spacing_m = self.frame.row_spacing_m or 1.0
        added = np.stack([self.late_m / spacing_m, np.zeros(len(self.late_m))], axis=-1)
        wanted: Floats = self.frame.projection.image_points(self.points_m) + added
        return wanted


def near_field_part(progress: Progress) -> Part:
    """Image points before a 27 GHz, 6 GHz, 120° aperture and look where they land, how sharp.

    Frames are 383 × 160 pixels of 5 mm. A lattice of points lies in the middle sub-aperture's
    own plane over a body's height, lopsided, so that a mirrored image would show; another stands
    0.3 m off it.
    """
    track = circular_track(range_m=RANGE_M)
    flat = _shot(track, 0.0)
    progress("near field", 1, 2)
    raised = _shot(track, HEIGHT_M)
    progress("near field", 2, 2)
    off = np.abs(flat.found() - flat.wanted())
    raised_off = np.abs(raised.found() - raised.wanted())
    return Part(
        figures=(
            _pixels("near field: points of the frame's plane, worst miss along range", off[:, 0]),
            _pixels("near field: points of the frame's plane, worst miss across", off[:, 1]),
            _pixels("near field: points 0.3 m off it, with their late_m, range", raised_off[:, 0]),
            _pixels("near field: points 0.3 m off it, across", raised_off[:, 1]),
            Figure(
                name="near field: points 0.3 m off it, later than the affine projection says",
                value=1e3 * float(raised.late_m.max()),
                unit="mm",
            ),
            *_width_figures(flat.frame),
        ),
        pictures=(
            Picture(
                name="near-field-points",
                caption="Points in the plane of a near-field frame (circles: where they are), and "
                "0.3 m off it (crosses: where the affine projection puts them; they come late); "
                "range downward, dB of the peak.",
                draw=lambda canvas: _draw(canvas, flat, raised),
                size_in=(8.0, 8.5),
            ),
        ),
    )


def _pixels(name: str, miss: Floats) -> Figure:
    return Figure(name=name, value=float(miss.max()), unit="pixels", wanted="<= 0.5 pixels")


def _shot(track: LineOfSightTrack, height_m: float) -> _Shot:
    waveform, settings = body_waveform(), NearFieldSettings()
    frequency_hz = waveform.frequencies_hz()
    blank = PhaseHistory(
        samples=np.zeros((len(track), len(frequency_hz)), dtype=np.complex64),
        frequency_hz=frequency_hz,
        track=track,
    )
    intervals = sub_apertures(blank, settings)
    interval = intervals[len(intervals) // 2]
    part = track.part(interval.start, interval.stop)
    middle = len(part) // 2
    k, rate = part.line_of_sight[middle], part.line_of_sight_rate_per_s[middle]
    across = rate / np.linalg.norm(rate)
    points_m = np.array(
        [a * k + c * across + height_m * np.cross(k, across) for a in ALONG_M for c in ACROSS_M]
    )
    samples = near_field_echoes(
        points_m, np.ones(len(points_m), dtype=np.complex128), part, frequency_hz
    )
    history = PhaseHistory(samples=samples, frequency_hz=frequency_hz, track=part)
    frame = next(near_field_frames(history, settings))
    return _Shot(frame=frame, points_m=points_m, late_m=late_m(frame, RANGE_M, points_m))


def _peak_near(frame: Frame, place: Floats) -> tuple[float, float]:
    """Return the brightest place within 8 pixels of one, to a part of a pixel by parabolas."""
    row, column = (round(float(at)) for at in place)
    top, left = max(row - 8, 0), max(column - 8, 0)
    cut = frame.amplitude[top : row + 9, left : column + 9]
    i, j = (int(at) for at in np.unravel_index(int(np.argmax(cut)), cut.shape))
    return top + i + _vertex(cut[:, j], i), left + j + _vertex(cut[i], j)


def _vertex(line: NDArray[np.float32], at: int) -> float:
    if not 0 < at < len(line) - 1:
        return 0.0
    before, peak, after = (float(line[at + step]) for step in (-1, 0, 1))
    return 0.5 * (before - after) / (before - 2 * peak + after)


def _width_figures(frame: Frame) -> tuple[Figure, ...]:
    """Return how the −3 dB widths of the point at the origin compare with theory's."""
    rows, columns = frame.shape
    row, column = rows // 2, columns // 2
    lines = {
        "along range": (frame.amplitude[row - 20 : row + 21, column], frame.row_resolution_m),
        "across": (frame.amplitude[row, column - 20 : column + 21], frame.column_resolution_m),
    }
    spacing_m = frame.row_spacing_m or 1.0
    figures = []
    for name, (line, theory_m) in lines.items():
        fine = zoom(line.astype(np.float64), 20, order=3)
        width_m = np.count_nonzero(fine > np.sqrt(0.5) * fine.max()) * spacing_m * 40 / 819
        figures.append(
            Figure(
                name=f"near field: −3 dB width {name} off theory",
                value=100 * abs(width_m / (theory_m or 1.0) - 1),
                unit="%",
                wanted="<= 10 %",
            )
        )
    return tuple(figures)


def _draw(canvas: Canvas, flat: _Shot, raised: _Shot) -> None:
    for place, shot, title, mark in zip(
        canvas.subplots(1, 2),
        (flat, raised),
        ("points in the frame's plane", "points 0.3 m off it"),
        ("o", "x"),
        strict=True,
    ):
        place.imshow(shot.frame.decibels(), vmin=-40, vmax=0)
        wanted = shot.frame.projection.image_points(shot.points_m)
        face = {"facecolors": "none", "edgecolors": "#6fd3ff"} if mark == "o" else {"c": "#6fd3ff"}
        place.scatter(wanted[:, 1], wanted[:, 0], s=90, marker=mark, linewidths=1, **face)
        place.grid(visible=False)
        place.set(title=title, xlabel="column of 5 mm, cross-range", ylabel="row of 5 mm, range")
