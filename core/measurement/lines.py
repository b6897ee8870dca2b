"""Line features of a hull: lengths along its own principal axes, with their attitude."""

from dataclasses import dataclass

import numpy as np
import trimesh

from core.arrays import Floats, frozen
from core.hull.surface import Surface


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LineMeasurement:
    """A measured length with its attitude.

    Attributes:
        name: what a person calls it.
        length_m: between the supporting planes across `direction`.
        direction: (3,) unit attitude vector, target frame; its sign means nothing.
    """

    name: str
    length_m: float
    direction: Floats

    def __post_init__(self) -> None:
        direction = frozen(self.direction, np.float64, (3,), f"Direction of {self.name}")
        object.__setattr__(self, "direction", direction)


def principal_lines(surface: Surface, names: tuple[str, str, str]) -> tuple[LineMeasurement, ...]:
    """Measure the hull along its principal axes of inertia, the longest extent first.

    Nothing of the true target goes in: the axes are the measured attitude vectors.

    Args:
        surface: a closed hull.
        names: of the longest, the middle and the shortest extent.

    Raises:
        ValueError: the surface is empty.

    Source: volume integrals over a closed mesh, Eberly, "Polyhedral mass properties", 2002, as
    in trimesh. A smallest enclosing box would turn by 45° on a cross of body and panels.
    """
    if surface.is_empty:
        raise ValueError("The hull is empty, so nothing can be measured; lower the threshold.")
    mesh = trimesh.Trimesh(surface.vertices_m, surface.faces, process=False)
    axes = mesh.principal_inertia_vectors
    extents = np.ptp(surface.vertices_m @ axes.T, axis=0)
    order = np.argsort(extents)[::-1]
    return tuple(
        LineMeasurement(name=name, length_m=float(extents[axis]), direction=axes[axis])
        for name, axis in zip(names, order, strict=True)
    )


def angle_between_lines_rad(first: Floats, second: Floats) -> float:
    """Return the angle in 0 … π/2 between two undirected lines, each a vector (3,)."""
    cross = float(np.linalg.norm(np.cross(first, second)))
    return float(np.arctan2(cross, abs(float(np.dot(first, second)))))
