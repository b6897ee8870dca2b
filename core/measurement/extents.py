"""Extents of a hull along the target's axes, and the directions that no view constrains."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.arrays import Floats, frozen
from core.geometry.grid import VoxelGrid
from core.geometry.projection import Projection
from core.hull.surface import Surface

UNOBSERVED_RMS_SINE = 0.2
"""Views whose directions of blindness lie within about 12° (rms) of a line leave it unobserved."""


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


def axis_extents(surface: Surface, grid: VoxelGrid) -> tuple[Extent, Extent, Extent]:
    """Return the extents along x, y and z of the target frame.

    An extent whose hull touches the first or last layer of the grid is not bounded by the views.

    Raises:
        ValueError: the surface is empty.
    """
    if surface.is_empty:
        raise ValueError("The hull is empty, so it has no extents; lower the vote threshold.")
    lower, upper = surface.vertices_m.min(axis=0), surface.vertices_m.max(axis=0)
    touches = (lower < grid.origin_m + 0.25 * grid.spacing_m) | (
        upper > grid.upper_m - 0.25 * grid.spacing_m
    )
    x, y, z = (
        Extent(
            name=name,
            value_m=float(upper[axis] - lower[axis]),
            direction=np.eye(3)[axis],
            is_bounded=not bool(touches[axis]),
        )
        for axis, name in enumerate(("x along-track", "y cross-track", "z nadir"))
    )
    return x, y, z


def unobserved_direction(projections: Sequence[Projection]) -> Floats | None:
    """Return the (3,) unit direction that no image plane contains well, or None if all are seen.

    Every affine image is blind along its viewing direction; if all views are blind along nearly
    the same line (the image planes of one pass nearly coincide), the hull is unbounded along it.
    """
    blind = np.array([projection.viewing_direction() for projection in projections])
    concentration = blind.T @ blind / len(blind)
    values, vectors = np.linalg.eigh(concentration)
    rms_sine = float(np.sqrt(max(0.0, 1.0 - values[2])))
    direction: Floats = vectors[:, 2]
    return direction if rms_sine < UNOBSERVED_RMS_SINE else None
