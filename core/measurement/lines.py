"""Line features of a hull: lengths along its own principal axes, with their attitude."""

from dataclasses import dataclass

import numpy as np

from core.arrays import Floats, frozen
from core.hull.surface import Surface
from core.measurement.moments import add_moments


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

    Source: volume integrals over a closed mesh, summed over the tetrahedra between its faces and
    one point, Tonon, "Explicit exact formulas for the 3-D tetrahedron inertia tensor", 2005. A
    smallest enclosing box would turn by 45° on a cross of body and panels.
    """
    if surface.is_empty:
        raise ValueError("The hull is empty, so nothing can be measured; lower the threshold.")
    _, axes = np.linalg.eigh(body_covariance_m5(surface)[1])
    extents = np.ptp(axes.T @ surface.vertices_m.T, axis=1)
    order = np.argsort(extents)[::-1]
    return tuple(
        LineMeasurement(name=name, length_m=float(extents[axis]), direction=axes[:, axis])
        for name, axis in zip(names, order, strict=True)
    )


def body_covariance_m5(surface: Surface) -> tuple[Floats, Floats]:
    """Return a closed body's centroid (3,) in metres and its second moments about it, (3, 3) in m⁵.

    The eigenvectors of the moments are the principal axes of inertia.

    Raises:
        ValueError: the surface encloses nothing.
    """
    middle = surface.vertices_m.mean(axis=0)
    sums = np.zeros(10)
    add_moments(surface.vertices_m, surface.faces, *map(float, middle), sums)
    volume, moment = float(sums[0]) / 6, sums[1:4] / 24
    about_mean = sums[[4, 5, 6, 5, 7, 8, 6, 8, 9]].reshape(3, 3) / 120
    if not volume > 0:
        raise ValueError(
            f"The surface encloses {volume:.3g} m³, so it has no centroid; it must be closed and "
            "its faces run counter-clockwise as seen from outside."
        )
    covariance: Floats = about_mean - np.outer(moment, moment) / volume
    return middle + moment / volume, covariance


def angle_between_lines_rad(first: Floats, second: Floats) -> float:
    """Return the angle in 0 … π/2 between two undirected lines, each a vector (3,)."""
    cross = float(np.linalg.norm(np.cross(first, second)))
    return float(np.arctan2(cross, abs(float(np.dot(first, second)))))
