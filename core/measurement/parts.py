"""Connected parts of a surface, and the moments that give each its axes."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats, frozen
from core.hull.closed_mesh import Surface
from core.measurement.lines import body_covariance_m5
from core.measurement.moments import join_vertices

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
    of_faces = np.empty(len(surface.faces), dtype=np.int32)
    join_vertices(surface.faces, np.arange(len(surface.vertices_m), dtype=np.int32), of_faces)
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
    is_used = np.zeros(len(surface.vertices_m), dtype=np.bool_)
    is_used[surface.faces[faces]] = True
    numbers = np.cumsum(is_used, dtype=np.int32) - 1
    return Surface(
        vertices_m=surface.vertices_m[is_used],
        faces=numbers[surface.faces[faces]].astype(np.int32, copy=False),
    )


def body_of(surface: Surface, faces: Faces) -> Surface:
    """Return the body that faces enclose, all of a surface or one connected part of it."""
    return surface if len(faces) == len(surface.faces) else part_at(surface, int(faces[0]))


def part_at(surface: Surface, face: int) -> Surface:
    """Return the connected part that a face belongs to as a surface of its own.

    The same object for the same surface, so that what is known of the part stays known.
    """
    return _part(surface, int(part_labels(surface)[face]))


@lru_cache(maxsize=8)
def _part(surface: Surface, label: int) -> Surface:
    return surface_of_faces(surface, np.flatnonzero(part_labels(surface) == label))


@lru_cache(maxsize=8)
def body_axes(surface: Surface) -> BodyAxes:
    """Return centroid, principal axes and extents of a closed surface's body.

    Raises:
        ValueError: the surface is empty or encloses nothing.
    """
    if surface.is_empty:
        raise ValueError("The surface is empty, so it has no axes.")
    centroid, covariance = body_covariance_m5(surface)
    _, vectors = np.linalg.eigh(covariance)
    along = vectors.T @ surface.vertices_m.T  # one axis after another: twice as fast to look over
    shift = vectors.T @ centroid
    lower, upper = along.min(axis=1) - shift, along.max(axis=1) - shift
    order = np.argsort(lower - upper, kind="stable")
    axes, lower, upper = vectors[:, order].T, lower[order], upper[order]
    if np.linalg.det(axes) < 0:
        axes[2], lower[2], upper[2] = -axes[2], -upper[2], -lower[2]
    return BodyAxes(centroid_m=centroid, axes=axes, lower_m=lower, upper_m=upper)
