"""A body measured by specs at one go: values with intervals, grades, and directions in all frames.

A body is a hull with the views that carved it, or a mesh, of which nothing is known but itself: it
has neither intervals nor grades.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from typing import Any

import numpy as np
import trimesh
from skyfield.api import EarthSatellite

from core.analysis.measurement_grades import graded
from core.arrays import Floats
from core.formats.measurement_entries import Entry, reading_of
from core.geometry.directions import Direction, FrameName, direction_in_frames
from core.geometry.grid import VoxelGrid
from core.hull.casting import UNWATCHED, Watch
from core.hull.closed_mesh import Surface
from core.hull.view import View
from core.hull.volume import VoteVolume
from core.measurement.axis_order import all_like
from core.measurement.extents import Extent, axis_extents
from core.measurement.intervals import COMMON_EDGE_CELLS, Interval, measured_intervals
from core.measurement.measuring import measure_all
from core.measurement.measuring_job import MeasuringContext
from core.measurement.observability import Grade
from core.measurement.regions import WholeSurface
from core.measurement.results import Lost, Measurement
from core.measurement.specs import (
    Area,
    BoundingBox,
    OrientedBox,
    PrincipalAxes,
    Spec,
    Volume,
)
from core.reconstruction import ReconstructionSettings, vote_threshold

DEFAULT_SPECS: tuple[Spec, ...] = (
    BoundingBox(name="extents"),
    PrincipalAxes(name="principal lines"),
    OrientedBox(name="box"),
    Volume(name="volume"),
    Area(name="area"),
)
"""What is measured of a body of which nobody said what to measure."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Body:
    """What is measured, and what is known of how it came about.

    Attributes:
        surface: closed, target frame.
        views: that carved it, as they voted; empty for a mesh.
        grid: that they voted on, None for a mesh.
        threshold: votes that a voxel has at least, 0 for a mesh.
        tolerated_misses: views that may miss a voxel.
        revision: of the hull.
        key_points: (3,) places by name, target frame.
    """

    surface: Surface
    views: tuple[View, ...] = ()
    grid: VoxelGrid | None = None
    threshold: int = 0
    tolerated_misses: int = 0
    revision: int = 0
    key_points: Mapping[str, Floats] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Row:
    """One spec and what it found.

    Attributes:
        spec: how it was measured.
        result: the measurement, or why there is none.
        interval: of its value, None without one.
        size_intervals: of each of its `sizes_m`, empty without.
        observability: how well the views constrain it, None for a mesh or one that is lost.
        size_grades: the same of each of its `sizes_m`, empty for a mesh.
        direction: of the result in all frames that are known, None without one.
    """

    spec: Spec
    result: Measurement | Lost
    interval: Interval | None = None
    size_intervals: tuple[Interval, ...] = ()
    observability: Grade | None = None
    size_grades: tuple[Grade, ...] = ()
    direction: Direction | None = None

    @property
    def is_plain(self) -> bool:
        """Whether the value may be shown as a number: measured, and not unobserved."""
        return isinstance(self.result, Measurement) and self.observability != "unobserved"

    def entry(self, frame: FrameName = "target") -> Entry:
        """Return the row as files of measurements hold it; what is unobserved has no reading.

        Raises:
            ValueError: a frame that needs an orbit where none is known.
        """
        if not isinstance(self.result, Measurement) or not self.is_plain:
            return Entry(spec=self.spec)
        ends: dict[str, Any] = {}
        if self.interval is not None and self.interval.is_stated:
            ends = {"low": self.interval.low, "high": self.interval.high}
        reading = reading_of(self.result, direction=self.direction, frame=frame, **ends)
        return Entry(spec=self.spec, reading=reading)


@dataclass(frozen=True, slots=True, kw_only=True)
class Orbit:
    """Where directions are given in RTN and TEME too.

    Attributes:
        satellite: its orbit.
        at_utc: the time at which the target's attitude is meant, with its time zone.
    """

    satellite: EarthSatellite
    at_utc: datetime


def body_of_mesh(mesh: trimesh.Trimesh) -> Body:
    """Return a mesh's body, to be measured as it is: in metres, along the target frame's axes."""
    return Body(surface=Surface(vertices_m=mesh.vertices, faces=mesh.faces))


def body_of_views(views: Sequence[View], settings: ReconstructionSettings) -> Body:
    """Carve the hull of views, as they vote, on the settings' grid.

    Raises:
        ValueError: no views, or an outline that cannot vote.
    """
    if not views:
        raise ValueError("No view votes, so there is no hull to measure.")
    volume = VoteVolume(settings.grid())
    volume.add_many(views)
    volume.threshold = vote_threshold(len(views), settings)
    return Body(
        surface=volume.surface(),
        views=tuple(views),
        grid=volume.grid,
        threshold=volume.threshold or 0,
        tolerated_misses=settings.tolerated_misses,
    )


def measured(
    body: Body,
    specs: Sequence[Spec] = DEFAULT_SPECS,
    *,
    orbit: Orbit | None = None,
    with_intervals: bool = False,
    cells: float = COMMON_EDGE_CELLS,
    watch: Watch = UNWATCHED,
) -> tuple[Row, ...]:
    """Measure a body by specs, in their order; one that is lost stops no other.

    Args:
        body: a hull or a mesh.
        specs: what to measure.
        orbit: for directions in RTN and TEME.
        with_intervals: carve the hulls of resampled outlines too; not of a mesh.
        cells: by how many pixels all outlines may be off together, with 95 % confidence.
        watch: is told how many of those hulls are done, and may cancel between them.

    Raises:
        ValueError: two specs of one name or a missing reference; intervals of a mesh, or of fewer
            than 3 views.
        Cancelled: `watch` said so.
    """
    results = measure_all(specs, body.surface, _context(body))
    extents = _extents(body)
    grades = _grades(body, specs, results, extents)
    stated = _intervals(body, specs, results, cells, watch) if with_intervals else {}
    return tuple(
        Row(
            spec=spec,
            result=result,
            interval=next(iter(stated.get(spec.name, ())), None),
            size_intervals=stated.get(spec.name, ())[1:],
            observability=grade,
            size_grades=_size_grades(spec, result, grade, extents),
            direction=_direction(result, orbit),
        )
        for spec, result, grade in zip(specs, results, grades, strict=True)
    )


def _context(body: Body) -> MeasuringContext:
    return MeasuringContext(
        revision=body.revision, threshold=body.threshold, key_points=body.key_points
    )


def _extents(body: Body) -> tuple[Extent, ...]:
    if body.grid is None or body.surface.is_empty:
        return ()
    return axis_extents(body.surface, body.grid, body.views)


def _grades(
    body: Body,
    specs: Sequence[Spec],
    results: Sequence[Measurement | Lost],
    extents: tuple[Extent, ...],
) -> tuple[Grade | None, ...]:
    if body.grid is None or not extents:
        return (None,) * len(specs)
    return graded(results, specs, body.views, body.grid, extents)


def _size_grades(
    spec: Spec, result: Measurement | Lost, grade: Grade | None, extents: tuple[Extent, ...]
) -> tuple[Grade, ...]:
    """Return a grade of each size: the extents along the target's axes have their own."""
    if isinstance(result, Lost) or grade is None:
        return ()
    if isinstance(spec, BoundingBox) and isinstance(spec.region, WholeSurface):
        return tuple(each.observability if each.is_bounded else "unobserved" for each in extents)
    return (grade,) * len(result.sizes_m)


def _direction(result: Measurement | Lost, orbit: Orbit | None) -> Direction | None:
    if isinstance(result, Lost) or result.direction is None:
        return None
    return direction_in_frames(
        result.direction,
        satellite=None if orbit is None else orbit.satellite,
        at_utc=None if orbit is None else orbit.at_utc,
        is_undirected=result.is_undirected,
    )


def _intervals(
    body: Body,
    specs: Sequence[Spec],
    results: Sequence[Measurement | Lost],
    cells: float,
    watch: Watch,
) -> dict[str, tuple[Interval, ...]]:
    """Return the intervals of every measurement's value and sizes, by its name."""
    if body.grid is None:
        raise ValueError("A mesh has no views, so no interval of its numbers can be stated.")
    counts = [0 if isinstance(one, Lost) else 1 + len(one.sizes_m) for one in results]

    def numbers(surface: Surface) -> Floats:
        found = all_like(measure_all(specs, surface, _context(body)), results)
        return np.concatenate(
            [np.empty(0), *(_numbers(one, n) for one, n in zip(found, counts, strict=True))]
        )

    stated = measured_intervals(
        body.views,
        body.grid,
        numbers,
        cells=cells,
        tolerated_misses=body.tolerated_misses,
        watch=watch,
    )
    ends = np.cumsum([0, *counts]).tolist()
    return {
        spec.name: stated[first:end]
        for spec, first, end in zip(specs, ends[:-1], ends[1:], strict=True)
    }


def _numbers(result: Measurement | Lost, count: int) -> Floats:
    """Return a result's value and sizes, NaN where it is lost or has other sizes."""
    if isinstance(result, Lost) or 1 + len(result.sizes_m) != count:
        return np.full(count, np.nan)
    return np.array([result.value, *result.sizes_m])
