"""Extents of a hull along the target's axes."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.arrays import Floats, frozen
from core.geometry.grid import VoxelGrid
from core.hull.bounds import confined_widths_m
from core.hull.surface import Surface
from core.hull.view import View
from core.measurement.observability import Grade, observability

CONFINED = 1.1
"""How much wider than measured the views may let a hull be that the grid cuts."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Extent:
    """How far a hull reaches along one direction.

    Attributes:
        name: what a person calls it.
        value_m: distance between the two supporting planes.
        direction: (3,) unit vector, target frame; its sign means nothing.
        observability: how well the views constrain lengths along this direction.
        is_bounded: whether the views limit it; if not, `value_m` is the grid's, or that of views
            which hardly see it, and no measurement.
    """

    name: str
    value_m: float
    direction: Floats
    observability: Grade
    is_bounded: bool

    def __post_init__(self) -> None:
        object.__setattr__(self, "direction", frozen(self.direction, np.float64, (3,), "Direction"))


def axis_extents(
    surface: Surface, grid: VoxelGrid, views: Sequence[View]
) -> tuple[Extent, Extent, Extent]:
    """Return the extents along x, y and z of the target frame.

    An extent along an unobserved direction is not bounded. The others are, by the views alone, of
    a hull that touches no side of the grid. Of one that does, an extent counts as bounded only
    along an axis where the views without the grid confine the hull to within a tenth of it: a
    slanted hull that the grid cuts has the grid's extents on every axis that its open direction
    leans to.

    Args:
        surface: of the hull.
        grid: that it was carved on.
        views: that carved it, as they voted.

    Raises:
        ValueError: the surface is empty.
    """
    if surface.is_empty:
        raise ValueError("The hull is empty, so it has no extents; lower the vote threshold.")
    lower, upper = surface.vertices_m.min(axis=0), surface.vertices_m.max(axis=0)
    widths = upper - lower
    inside = np.all(lower > grid.origin_m + 0.25 * grid.spacing_m) and np.all(
        upper < grid.upper_m - 0.25 * grid.spacing_m
    )
    bounded = [True] * 3 if inside else (confined_widths_m(views) <= CONFINED * widths).tolist()
    seen = observability(views)
    grades = [seen.grade(axis) for axis in np.eye(3)]
    x, y, z = (
        Extent(
            name=name,
            value_m=float(widths[axis]),
            direction=np.eye(3)[axis],
            observability=grades[axis],
            is_bounded=bounded[axis] and grades[axis] != "unobserved",
        )
        for axis, name in enumerate(("x along-track", "y cross-track", "z nadir"))
    )
    return x, y, z
