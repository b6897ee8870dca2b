"""Extents of a hull along the target's axes, and the directions that no view constrains."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.arrays import Floats, frozen
from core.geometry.grid import VoxelGrid
from core.geometry.projection import Projection
from core.hull.bounds import confined_widths_m
from core.hull.surface import Surface
from core.hull.view import View

UNOBSERVED_SINE = 0.2
"""A direction is unobserved while every view is blind within about 12° of it."""

CONFINED = 1.1
"""How much wider than measured the views may let a hull be that the grid cuts."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Extent:
    """How far a hull reaches along one direction.

    Attributes:
        name: what a person calls it.
        value_m: distance between the two supporting planes.
        direction: (3,) unit vector, target frame; its sign means nothing.
        is_bounded: whether the views limit it; if not, `value_m` is the grid's and no measurement.
    """

    name: str
    value_m: float
    direction: Floats
    is_bounded: bool

    def __post_init__(self) -> None:
        object.__setattr__(self, "direction", frozen(self.direction, np.float64, (3,), "Direction"))


def axis_extents(
    surface: Surface, grid: VoxelGrid, views: Sequence[View]
) -> tuple[Extent, Extent, Extent]:
    """Return the extents along x, y and z of the target frame.

    A hull that touches no side of the grid is bounded by its views alone. Of one that does, an
    extent counts as bounded only along an axis where the views without the grid confine the hull
    to within a tenth of it: a slanted hull that the grid cuts has the grid's extents on every
    axis that its open direction leans to.

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
    x, y, z = (
        Extent(
            name=name,
            value_m=float(widths[axis]),
            direction=np.eye(3)[axis],
            is_bounded=bounded[axis],
        )
        for axis, name in enumerate(("x along-track", "y cross-track", "z nadir"))
    )
    return x, y, z


def unobserved_direction(projections: Sequence[Projection]) -> Floats | None:
    """Return the (3,) unit direction that no image plane contains well, or None if all are seen.

    Every affine image is blind along its viewing direction; if all views are blind along nearly
    the same line (the image planes of one pass nearly coincide), the hull is open along it.
    """
    blind = np.array([projection.viewing_direction() for projection in projections])
    _, vectors = np.linalg.eigh(blind.T @ blind)
    direction: Floats = vectors[:, 2]
    sine = np.linalg.norm(np.cross(blind, direction), axis=1)
    return direction if float(sine.max()) < UNOBSERVED_SINE else None
