"""One hull measured by the book, and each measurement with all that belongs to its number."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from app.measuring_intervals import Intervals, voting_views
from app.snapshot import Snapshot
from core.analysis.measurement_book import MeasurementBook
from core.analysis.measurement_grades import graded
from core.arrays import Floats
from core.measurement.intervals import Interval
from core.measurement.key_point_errors import (
    is_between_key_points,
    marks_errors,
    with_marks_error,
)
from core.measurement.measuring import measure_all
from core.measurement.measuring_job import MeasuringContext
from core.measurement.observability import Grade
from core.measurement.results import Lost, Measurement
from core.measurement.specs import Spec


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Item:
    """A measurement as it stands.

    Attributes:
        spec: how it is measured.
        is_hidden: whether it is left out of the drawing.
        result: on the hull whose revision it names, None until measured.
        interval: of that very value, None while there is none.
        change: of the value against the one on the hull measured before, in its unit; None where
            either is missing.
        observability: how well the views constrain it, None where that is no question.
        old_interval: the interval of the value on an earlier hull, None where there is none or a
            present one; with the revision of that hull.
        old_revision: of that hull.
    """

    spec: Spec
    is_hidden: bool
    result: Measurement | Lost | None
    interval: Interval | None
    change: float | None
    observability: Grade | None = None
    old_interval: Interval | None = None
    old_revision: int = 0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Found:
    """What was found of one entry of the book."""

    result: Measurement | Lost
    observability: Grade | None
    change: float | None
    marks_error: float | None = None
    """Standard error by the marks of key points, None where none enters."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Job:
    """What is to be measured: the hull of a snapshot by the book and its key points."""

    snapshot: Snapshot
    book: MeasurementBook
    key_points: Mapping[str, Floats]
    covariances_m2: Mapping[str, Floats]


def measured(job: Job) -> dict[int, Found]:
    """Measure a hull by every entry of the book, by their keys."""
    snapshot, entries, specs = job.snapshot, job.book.entries, job.book.specs
    hull, surface = snapshot.hull, snapshot.surface
    if hull is None or surface is None or not entries:
        return {}
    context = MeasuringContext(
        revision=hull.revision, threshold=hull.threshold, key_points=job.key_points
    )
    results = measure_all(specs, surface, context)
    by_name = {spec.name: result for spec, result in zip(specs, results, strict=True)}
    errors = marks_errors(specs, surface, context, by_name, job.covariances_m2)
    grades = graded(results, specs, voting_views(snapshot), snapshot.settings.grid(), hull.extents)
    return {
        entry.key: Found(
            result=result,
            # Key points that the frames do not determine have no place to measure between.
            observability=None if is_between_key_points(entry.spec) else grade,
            change=None,
            marks_error=errors.get(entry.name),
        )
        for entry, result, grade in zip(entries, results, grades, strict=True)
    }


def since(before: Found | None, now: Found) -> Found:
    """Return what was found with its change against what was found on the hull before."""
    if before is None or isinstance(before.result, Lost) or isinstance(now.result, Lost):
        return now
    if before.result.revision == now.result.revision:
        return replace(now, change=before.change)
    return replace(now, change=now.result.value - before.result.value)


def with_interval(item: Item, key: int, intervals: Intervals | None) -> Item:
    """Return an item with its interval if that is of its very value, else as an old one."""
    interval = None if intervals is None else intervals.by_key.get(key)
    if intervals is None or interval is None:
        return item
    if isinstance(item.result, Measurement) and item.result.revision == intervals.revision:
        return replace(item, interval=interval)
    return replace(item, old_interval=interval, old_revision=intervals.revision)


def with_marks(item: Item, found: Found | None) -> Item:
    """Return an item whose interval holds what the marks of its key points may be off."""
    if found is None or found.marks_error is None or not isinstance(item.result, Measurement):
        return item
    is_free = is_between_key_points(item.spec)
    if item.interval is None and not is_free:
        return item
    hull = None if is_free else item.interval
    interval = with_marks_error(item.result.value, found.marks_error, hull)
    return replace(item, interval=interval, old_interval=None)
