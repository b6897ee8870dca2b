"""Key points in space: what their marks and the frames' projections give."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from core.analysis.key_point_marks import KeyPointBook, Place
from core.arrays import Floats
from core.geometry.projection import Projection
from core.measurement.key_points import KeyPoint, located
from core.optical.epipolar import epipolar_segment

SUSPICIOUS_SIGMAS = 3.0
"""A mark that lies farther off, in its standard deviations, probably shows another corner."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Mark:
    """A key point's mark in one frame.

    Attributes:
        frame: its number, from 1.
        row, column: where in it.
        residual_px: its distance from where the placed point is projected; None while there is no
            placed point, or no such frame.
        is_suspicious: whether that is more than three standard deviations of a mark.
    """

    frame: int
    row: float
    column: float
    residual_px: float | None
    is_suspicious: bool


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PlacedPoint:
    """A key point with its marks, and its place where they give one.

    Attributes:
        name: of the point.
        marks: by frame; one in a frame that has not come (again) takes no part.
        place: where it is; None where the marks do not say.
        complaint: why they do not, in a sentence; empty where they do.
    """

    name: str
    marks: tuple[Mark, ...]
    place: KeyPoint | None
    complaint: str

    @property
    def standard_errors_m(self) -> Floats | None:
        """(3,) along x, y, z of the target frame."""
        if self.place is None:
            return None
        errors: Floats = np.sqrt(np.diag(self.place.covariance_m2))
        return errors


def placed_points(
    book: KeyPointBook, projections: Mapping[int, Projection]
) -> tuple[PlacedPoint, ...]:
    """Return every key point of a book with its place.

    Marks are taken to err by the book's standard deviation, or by what their own residuals show
    where that is more: covariances grow by the residuals' mean square, in units of that standard
    deviation, where it exceeds one.

    Args:
        book: the marks.
        projections: of the frames that have come, by number.

    Source: the scale factor S of the Particle Data Group, "Review of Particle Physics", 2022,
    section 5.2.2.
    """
    return tuple(
        _placed(name, marks, projections, book.sigma_px) for name, marks in book.marks.items()
    )


def _placed(
    name: str,
    marks: Mapping[int, Place],
    projections: Mapping[int, Projection],
    sigma_px: float,
) -> PlacedPoint:
    here = [frame for frame in marks if frame in projections]
    seen = np.array([marks[frame] for frame in here]).reshape(-1, 2)
    place, complaint = None, ""
    try:
        place = _located(name, [projections[frame] for frame in here], seen, sigma_px)
    except ValueError as error:
        complaint = str(error)
    residuals = {} if place is None else dict(zip(here, place.residual_px.tolist(), strict=True))
    return PlacedPoint(
        name=name,
        marks=tuple(_mark(frame, marks[frame], residuals.get(frame), sigma_px) for frame in marks),
        place=place,
        complaint=complaint,
    )


def _located(name: str, projections: list[Projection], seen: Floats, sigma_px: float) -> KeyPoint:
    as_judged = located(name, projections, seen, sigma_px=sigma_px)
    freedom = 2 * len(seen) - 3
    shown_px = float(np.sqrt((as_judged.residuals_px**2).sum() / freedom))
    if shown_px <= sigma_px:
        return as_judged
    return located(name, projections, seen, sigma_px=shown_px)


def _mark(frame: int, place: Place, residual_px: float | None, sigma_px: float) -> Mark:
    return Mark(
        frame=frame,
        row=place[0],
        column=place[1],
        residual_px=residual_px,
        is_suspicious=residual_px is not None and residual_px > SUSPICIOUS_SIGMAS * sigma_px,
    )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Expectation:
    """Where a key point should be seen in a frame.

    Attributes:
        name: of the point.
        place: (row, column) of the placed point; None where it has no place.
        lines: of a point without one, (2, 2) ends as (row, column) of the line on which each of
            its marks in other frames puts it.
    """

    name: str
    place: Floats | None
    lines: tuple[Floats, ...]


def expectations(
    points: tuple[PlacedPoint, ...],
    frame: int,
    projections: Mapping[int, Projection],
    *,
    reach_m: float,
) -> tuple[Expectation, ...]:
    """Return where every key point should be seen in a frame.

    Args:
        points: as `placed_points` gives them.
        frame: number of one of the frames.
        projections: of the frames that have come, by number.
        reach_m: from the target frame's origin, within which a corner is looked for.
    """
    return tuple(_expected(point, frame, projections, reach_m) for point in points)


def _expected(
    point: PlacedPoint, frame: int, projections: Mapping[int, Projection], reach_m: float
) -> Expectation:
    here = projections[frame]
    if point.place is not None:
        place = here.image_points(point.place.position_m)
        return Expectation(name=point.name, place=place, lines=())
    lines = []
    for mark in point.marks:
        if mark.frame == frame or mark.frame not in projections:
            continue
        seen = np.array([mark.row, mark.column])
        line = epipolar_segment(projections[mark.frame], here, seen, reach_m=reach_m)
        lines += [] if line is None else [line]
    return Expectation(name=point.name, place=None, lines=tuple(lines))
