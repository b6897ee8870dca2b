"""What the errors of key points' marks do to the numbers that are measured between them."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import Any

import numpy as np
from scipy import stats

from core.arrays import Floats
from core.hull.closed_mesh import Surface
from core.measurement.anchors import Anchor, KeyPoint, Point
from core.measurement.intervals import CONFIDENCE, Interval
from core.measurement.measuring import measure
from core.measurement.measuring_job import MeasuringContext
from core.measurement.results import Lost, Measurement
from core.measurement.specs import (
    DependentSpec,
    Length,
    LineFeature,
    PlaneThrough,
    Polyline,
    Spec,
)

FACTOR = float(stats.norm.ppf(0.5 + 0.5 * CONFIDENCE))

Results = Mapping[str, Measurement | Lost]


@dataclass(frozen=True, slots=True, kw_only=True)
class MarksInterval(Interval):
    """An interval that holds what key points' marks may be off.

    Attributes:
        marks_error: standard error of the number by the marks alone.
    """

    marks_error: float

    @property
    def method(self) -> str:
        """What the interval is, for people to read beside it."""
        by_marks = f"{100 * CONFIDENCE:g} % interval: from the marks of its key points"
        if not self.groups:
            return by_marks
        return (
            f"{by_marks}, outlines ± {self.cells:g} cells, and jackknife leaving out "
            f"{self.groups} groups of frames in turn, added in quadrature"
        )


def marks_errors(
    specs: Sequence[Spec],
    surface: Surface,
    context: MeasuringContext,
    results: Results,
    covariances_m2: Mapping[str, Floats],
) -> dict[str, float]:
    """Return by its name the standard error of every number that key points enter.

    Each key point is moved by its standard error to and fro along each principal axis of its
    covariance; half the differences that this makes are added in quadrature. Key points are taken
    to err independently.

    Args:
        specs: of all measurements.
        surface: of the hull, target frame.
        context: with the key points where they are.
        results: of all specs in that context, by their names.
        covariances_m2: (3, 3) of key points by name; one without is taken to be exact.

    Returns:
        In each number's own unit; NaN where it is lost when a key point moves. What key points do
        not enter is left out.
    """
    variances = {spec.name: 0.0 for spec in _touched(specs)}
    for name in sorted({name for spec in specs for name in key_points_of(spec)}):
        if name not in context.key_points or name not in covariances_m2:
            continue
        for step in _steps(covariances_m2[name]):
            ends = [
                _moved(specs, surface, context, results, name, sign * step) for sign in (1.0, -1.0)
            ]
            for number in variances:
                variances[number] += (0.5 * (ends[0][number] - ends[1][number])) ** 2
    return {name: float(np.sqrt(variance)) for name, variance in variances.items()}


def with_marks_error(
    value: float, marks_error: float, hull: Interval | None
) -> MarksInterval | None:
    """Return the interval of a number by its key points' marks and, given one, by the hull.

    Args:
        value: the number.
        marks_error: its standard error by the marks, from `marks_errors`.
        hull: its interval as the hull gives it; None where the hull does not enter it.

    Returns:
        None where the marks allow none.
    """
    if not np.isfinite(marks_error):
        return None
    if hull is None:
        hull = Interval(
            value=value,
            low=value,
            high=value,
            eroded=value,
            dilated=value,
            standard_error=0.0,
            cells=0.0,
            groups=0,
        )
    marks = FACTOR * marks_error
    return MarksInterval(
        value=value,
        low=value - float(np.hypot(value - hull.low, marks)),
        high=value + float(np.hypot(hull.high - value, marks)),
        eroded=hull.eroded,
        dilated=hull.dilated,
        standard_error=float(np.hypot(hull.standard_error, marks_error)),
        cells=hull.cells,
        groups=hull.groups,
        note=hull.note,
        marks_error=marks_error,
    )


def key_points_of(spec: Spec) -> frozenset[str]:
    """Return the names of the key points that a spec itself refers to."""
    return frozenset(_names(spec))


def with_key_point_renamed(spec: Spec, name: str, new_name: str) -> Spec:
    """Return a spec that refers to a key point by its new name."""
    found: Spec = _renamed(spec, name, new_name)
    return found


def is_between_key_points(spec: Spec) -> bool:
    """Whether a spec measures between key points only, so that the hull does not enter.

    Among the key points there may be fixed points.
    """
    if isinstance(spec, Length | LineFeature):
        anchors: tuple[Anchor, ...] = (spec.start, spec.end)
    elif isinstance(spec, Polyline | PlaneThrough):
        anchors = spec.anchors
    else:
        return False
    return bool(key_points_of(spec)) and all(
        isinstance(anchor, KeyPoint | Point) for anchor in anchors
    )


def _names(value: object) -> Iterator[str]:
    if isinstance(value, KeyPoint):
        yield value.name
    elif isinstance(value, tuple):
        for one in value:
            yield from _names(one)
    elif is_dataclass(value):
        for field in fields(value):
            yield from _names(getattr(value, field.name))


def _renamed(value: Any, name: str, new_name: str) -> Any:
    if isinstance(value, KeyPoint):
        return KeyPoint(name=new_name) if value.name == name else value
    if isinstance(value, tuple):
        return tuple(_renamed(one, name, new_name) for one in value)
    if is_dataclass(value) and not isinstance(value, type):
        own = {field.name: getattr(value, field.name) for field in fields(value)}
        return replace(value, **{key: _renamed(one, name, new_name) for key, one in own.items()})
    return value


def _touched(specs: Sequence[Spec]) -> tuple[Spec, ...]:
    """Return the specs that key points enter, directly or by way of another measurement."""
    direct = {spec.name for spec in specs if key_points_of(spec)}
    return tuple(
        spec
        for spec in specs
        if spec.name in direct
        or (isinstance(spec, DependentSpec) and direct & {spec.first, spec.second})
    )


def _steps(covariance_m2: Floats) -> Floats:
    """Return (3, 3) a standard error along each principal axis, one in each row."""
    variances, axes = np.linalg.eigh(covariance_m2)
    steps: Floats = (axes * np.sqrt(np.maximum(variances, 0.0))).T
    return steps


def _moved(
    specs: Sequence[Spec],
    surface: Surface,
    context: MeasuringContext,
    results: Results,
    name: str,
    by_m: Floats,
) -> dict[str, float]:
    """Return the touched numbers with one key point elsewhere, NaN for what is lost then."""
    places = {**context.key_points, name: context.key_points[name] + by_m}
    there = replace(context, key_points=places, measured=results)
    found = dict(results)
    for is_dependent in (False, True):
        for spec in _touched(specs):
            if isinstance(spec, DependentSpec) is is_dependent:
                found[spec.name] = measure(spec, surface, replace(there, measured=found))
    return {spec.name: _value(found[spec.name]) for spec in _touched(specs)}


def _value(result: Measurement | Lost) -> float:
    return result.value if isinstance(result, Measurement) else float("nan")
