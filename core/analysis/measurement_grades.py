"""How well the views constrain what was measured."""

from collections.abc import Sequence

import numpy as np

from core.arrays import Floats
from core.geometry.grid import VoxelGrid
from core.hull.view import View
from core.measurement.extents import Extent
from core.measurement.observability import Grade, Observability, observability
from core.measurement.results import Lost, Measurement
from core.measurement.specs import (
    Area,
    BoundingBox,
    CylinderAxis,
    DependentSpec,
    OrientedBox,
    PrincipalAxes,
    Section,
    Spec,
    Volume,
)

ORDER: tuple[Grade, ...] = ("good", "weak", "unobserved")

OF_BODY = (PrincipalAxes, BoundingBox, OrientedBox, Volume, Area, Section)
"""What reaches wherever the body does, also where the grid ends it."""

ACROSS = 36
"""Directions over half a turn that stand for all across an axis."""


def graded(
    results: Sequence[Measurement | Lost],
    specs: Sequence[Spec],
    views: Sequence[View],
    grid: VoxelGrid,
    extents: Sequence[Extent],
) -> tuple[Grade | None, ...]:
    """Grade each result, None for one that is lost.

    A length is graded along its lines, a body's sizes along its axes, a section's area and a
    cylinder's diameter across their axes, a plane along its normal, a volume and an area along the
    worst direction of all, and what is computed from two others as the worse of them. What ends at
    a side of the grid is the grid's, and unobserved whatever the views are.

    Args:
        results: in the order of the specs.
        specs: by which they were measured.
        views: that carved the hull, as they voted.
        grid: that it was carved on.
        extents: of the hull, which tell whether the grid cuts it.
    """
    seen = observability(views)
    is_cut = any(not extent.is_bounded for extent in extents)
    grades = {
        spec.name: _grade(result, spec, seen, grid, is_cut=is_cut)
        for spec, result in zip(specs, results, strict=True)
    }
    for spec in specs:
        if isinstance(spec, DependentSpec) and grades[spec.name] is not None:
            grades[spec.name] = _worst([grades[name] for name in (spec.first, spec.second)])
    return tuple(grades[spec.name] for spec in specs)


def _grade(
    result: Measurement | Lost, spec: Spec, seen: Observability, grid: VoxelGrid, *, is_cut: bool
) -> Grade | None:
    if isinstance(result, Lost):
        return None
    if isinstance(spec, DependentSpec):
        return "good"  # until it is known of what
    if is_cut and (isinstance(spec, OF_BODY) or _touches(result.points_m, grid)):
        return "unobserved"
    directions = _directions(result, spec)
    if directions is None:
        return seen.grade(seen.worst_direction())
    return _worst([seen.grade(direction) for direction in directions])


def _directions(result: Measurement, spec: Spec) -> Floats | None:
    """Return the directions (n, 3) along which a result's numbers reach, None for all."""
    if isinstance(spec, Volume | Area) or (result.direction is None and not len(result.axes)):
        return None
    if isinstance(spec, Section | CylinderAxis):
        assert result.direction is not None
        return _across(result.direction)
    if len(result.axes):
        return result.axes
    assert result.direction is not None
    return result.direction[None]


def _across(direction: Floats) -> Floats:
    """Return unit vectors (n, 3) across a direction, over half a turn."""
    _, _, axes = np.linalg.svd(direction[None])
    turn = np.pi * np.arange(ACROSS) / ACROSS
    vectors: Floats = np.outer(np.cos(turn), axes[1]) + np.outer(np.sin(turn), axes[2])
    return vectors


def _touches(points_m: Floats, grid: VoxelGrid) -> bool:
    """Whether a point lies on a side of the grid, where it is the grid that ends the hull."""
    margin_m = 0.25 * grid.spacing_m
    low, high = points_m <= grid.origin_m + margin_m, points_m >= grid.upper_m - margin_m
    return bool(np.any(low | high))


def _worst(grades: Sequence[Grade | None]) -> Grade:
    found = [ORDER.index(grade) for grade in grades if grade is not None]
    return ORDER[max(found, default=0)]
