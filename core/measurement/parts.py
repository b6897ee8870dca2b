"""Connected parts of a surface, and the moments that give each its axes."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from core.arrays import Floats, frozen
from core.hull.closed_mesh import Surface
from core.measurement.lines import body_covariance_m5

Faces = NDArray[np.int64]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class BodyAxes:
    """Centroid, principal axes and extents of a closed body.

    Attributes:
        centroid_m: (3,) of the enclosed volume, target frame.
        axes: (3, 3) rows are unit principal axes of inertia, the longest extent first; their
            signs mean nothing, except that the three are right-handed.
        lower_m, upper_m: (3,) how far the body reaches from the centroid along each axis.
    """

    centroid_m: Floats
    axes: Floats
    lower_m: Floats
    upper_m: Floats

    def __post_init__(self) -> None:
        for name, shape in (("centroid_m", (3,)), ("axes", (3, 3))):
            object.__setattr__(self, name, frozen(getattr(self, name), np.float64, shape, name))
        for name in ("lower_m", "upper_m"):
            object.__setattr__(self, name, frozen(getattr(self, name), np.float64, (3,), name))

    @property
    def extents_m(self) -> Floats:
        """(3,) distances between the supporting planes across each axis."""
        return self.upper_m - self.lower_m


def part_labels(surface: Surface) -> NDArray[np.int32]:
    """Return the number of the connected part that each face belongs to, (faces,)."""
    return _labels(surface)


@lru_cache(maxsize=4)
def _labels(surface: Surface) -> NDArray[np.int32]:
    count = len(surface.vertices_m)
    a, b, c = surface.faces.T
    rows, columns = np.concatenate([a, b]), np.concatenate([b, c])
    joined = coo_array((np.ones(len(rows), dtype=np.bool_), (rows, columns)), shape=(count, count))
    _, labels = connected_components(joined, directed=False)
    of_faces: NDArray[np.int32] = labels[a]
    of_faces.flags.writeable = False
    return of_faces


def part_of_face(surface: Surface, face: int) -> Faces:
    """Return the numbers of all faces connected with one."""
    labels = part_labels(surface)
    return np.flatnonzero(labels == labels[face])


def surface_of_faces(surface: Surface, faces: Faces) -> Surface:
    """Return some faces of a surface with only the vertices that they use."""
    if len(faces) == len(surface.faces):
        return surface
    used, renumbered = np.unique(surface.faces[faces], return_inverse=True)
    return Surface(
        vertices_m=surface.vertices_m[used], faces=renumbered.reshape(-1, 3).astype(np.int32)
    )


def body_axes(surface: Surface) -> BodyAxes:
    """Return centroid, principal axes and extents of a closed surface's body.

    Raises:
        ValueError: the surface is empty or encloses nothing.
    """
    if surface.is_empty:
        raise ValueError("The surface is empty, so it has no axes.")
    centroid, covariance = body_covariance_m5(surface)
    _, vectors = np.linalg.eigh(covariance)
    reach = (surface.vertices_m - centroid) @ vectors
    order = np.argsort(-np.ptp(reach, axis=0), kind="stable")
    axes, reach = vectors[:, order].T, reach[:, order]
    if np.linalg.det(axes) < 0:
        axes[2], reach[:, 2] = -axes[2], -reach[:, 2]
    return BodyAxes(
        centroid_m=centroid, axes=axes, lower_m=reach.min(axis=0), upper_m=reach.max(axis=0)
    )
