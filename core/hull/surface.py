"""The surface of a hull as a triangle mesh in true metres."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from skimage.measure import marching_cubes

from core.arrays import Floats, frozen
from core.geometry.grid import VoxelGrid
from core.hull.votes import VoteVolume


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Surface:
    """A closed triangle mesh.

    Attributes:
        vertices_m: (vertices, 3), target frame.
        faces: (faces, 3) vertex indices, counter-clockwise as seen from outside.
    """

    vertices_m: Floats
    faces: NDArray[np.int32]

    def __post_init__(self) -> None:
        vertices = frozen(self.vertices_m, np.float64, (None, 3), "Surface vertices")
        object.__setattr__(self, "vertices_m", vertices)
        object.__setattr__(self, "faces", frozen(self.faces, np.int32, (None, 3), "Surface faces"))

    @property
    def is_empty(self) -> bool:
        """Whether there is no surface at all."""
        return len(self.faces) == 0

    def volume_m3(self) -> float:
        """Return the enclosed volume in cubic metres."""
        a, b, c = (self.vertices_m[self.faces[:, corner]] for corner in range(3))
        return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)


EMPTY_SURFACE = Surface(vertices_m=np.empty((0, 3)), faces=np.empty((0, 3), dtype=np.int32))


def hull_surface(volume: VoteVolume, threshold: int | None = None) -> Surface:
    """Return the surface of the voxels with at least `threshold` votes (default: all views').

    Raises:
        ValueError: no views, or a threshold outside 1 … number of views.
    """
    return mask_surface(volume.hull(threshold), volume.grid)


def mask_surface(inside: NDArray[np.bool_], grid: VoxelGrid) -> Surface:
    """Return the surface halfway between the voxels inside and outside of a mask.

    The mask ends at the grid: a hull that reaches the boundary is closed half a voxel outside.

    Args:
        inside: (nx, ny, nz) voxels of the body.
        grid: where they stand.

    Source: Lorensen and Cline, "Marching cubes", 1987, as in scikit-image.
    """
    if not inside.any():
        return EMPTY_SURFACE
    occupied = [
        np.flatnonzero(inside.any(axis=tuple(other for other in range(3) if other != axis)))
        for axis in range(3)
    ]
    lower = np.array([indices[0] for indices in occupied])
    box = inside[tuple(slice(indices[0], indices[-1] + 1) for indices in occupied)]
    padded = np.pad(box, 1).astype(np.float32)
    # With "ascent" scikit-image winds the faces counter-clockwise as seen from outside.
    vertices, faces, _, _ = marching_cubes(padded, 0.5, gradient_direction="ascent")
    vertices_m = grid.origin_m + grid.spacing_m * (vertices.astype(np.float64) + lower - 1)
    return Surface(vertices_m=vertices_m, faces=faces)
