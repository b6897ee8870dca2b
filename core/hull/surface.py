"""The surface of a hull as a triangle mesh in true metres."""

import numpy as np
from numpy.typing import NDArray
from skimage.measure import marching_cubes

from core.geometry.grid import VoxelGrid
from core.hull.closed_mesh import Surface
from core.hull.mesher import meshed
from core.hull.votes import VoteCounts

__all__ = ["Surface", "hull_surface", "mask_surface"]


EMPTY_SURFACE = Surface(vertices_m=np.empty((0, 3)), faces=np.empty((0, 3), dtype=np.int32))


def hull_surface(volume: VoteCounts, threshold: int | None = None) -> Surface:
    """Return the exact surface of the hull with at least `threshold` votes.

    Between the voxels inside and outside it stands where the outlines put it; a hull that reaches
    the grid's end is closed half a voxel outside. Where two of its sheets share a voxel an edge
    may have four faces.

    Args:
        volume: the views and their votes.
        threshold: votes that a voxel has at least; by default the volume's own.

    Raises:
        ValueError: no views, or a threshold outside 1 … number of views.
    """
    return meshed(volume, threshold)


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
