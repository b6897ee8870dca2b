"""Hulls of views that no matrix projects: the zero set of the least distance to the outlines.

Close to the radar range is curved, and a view is an outline with a function from metres to pixels.
A voxel's distance into the hull is the least of its distances into the outlines, so that the
surface falls between voxels.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray
from skimage.measure import marching_cubes

from core.arrays import Floats
from core.geometry.grid import VoxelGrid
from core.hull.surface import EMPTY_SURFACE, Surface
from core.silhouettes.silhouette import Silhouette

FINER = 3
"""Samples per pixel of the distance to an outline."""

SHIFT = 6
"""Bits of a sample that OpenCV keeps of a ring's vertices."""

BAND_PX = 8.0
"""Distances beyond are cut off: they only say in or out."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class CurvedView:
    """An outline, as it votes, and where points appear in its image.

    Attributes:
        silhouette: what may hold the body.
        image_points: from target metres (…, 3) to (…, 2) as (row, column).
    """

    silhouette: Silhouette
    image_points: Callable[[Floats], Floats]


def inward_px(silhouette: Silhouette) -> NDArray[np.float32]:
    """Return the distance into an outline in pixels, at `FINER` samples per pixel, ± BAND_PX."""
    rows, columns = silhouette.image_shape
    raster = np.zeros((rows * FINER, columns * FINER), dtype=np.uint8)
    if silhouette.rings:
        # Sample i is pixel (i + ½) / FINER − ½; OpenCV wants (column, row).
        fixed = [
            np.round(((ring[:, ::-1] + 0.5) * FINER - 0.5) * 2**SHIFT).astype(np.int32)
            for ring in silhouette.rings
        ]
        cv2.fillPoly(raster, fixed, 1, shift=SHIFT)
    if raster.all() or not raster.any():  # an edge nowhere has no distance
        return np.full(raster.shape, BAND_PX if raster.all() else -BAND_PX, dtype=np.float32)
    inside, outside = (
        cv2.distanceTransform(each, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
        for each in (raster, 1 - raster)
    )
    # Samples stand half a sample from the edge, on either side.
    signed = np.where(raster, inside - 0.5, 0.5 - outside) / FINER
    distance: NDArray[np.float32] = np.clip(signed, -BAND_PX, BAND_PX).astype(np.float32)
    return distance


def hull_distance_px(
    views: Sequence[CurvedView], grid: VoxelGrid, *, may_miss: int = 0
) -> NDArray[np.float32]:
    """Return how far inside the hull every voxel lies, (nx, ny, nz) in pixels, at most BAND_PX.

    Args:
        views: as they vote.
        grid: where.
        may_miss: so many views may have a voxel outside; the hull is then that of the others.

    Raises:
        ValueError: no more views than may miss.
    """
    if not 0 <= may_miss < len(views):
        raise ValueError(
            f"A hull that {may_miss} views may miss needs more views than that, got {len(views)}."
        )
    points = grid.centres_m().reshape(-1, 3)
    if may_miss > 0:
        every = np.stack([_sampled(view, points) for view in views])
        decides: NDArray[np.float32] = np.partition(every, may_miss, axis=0)[may_miss]
        return decides.reshape(grid.shape)
    least = np.full(len(points), BAND_PX, dtype=np.float32)
    alive = np.arange(len(points))
    for view in _spread(views):
        least[alive] = np.minimum(least[alive], _sampled(view, points[alive]))
        # What is a band outside for good changes no surface.
        alive = alive[least[alive] > -BAND_PX]
    return least.reshape(grid.shape)


def distance_surface(inside_px: NDArray[np.float32], grid: VoxelGrid) -> Surface:
    """Return the zero surface of distances into a body (nx, ny, nz), closed at the grid's end.

    Source: Lorensen and Cline, "Marching cubes", 1987, as in scikit-image.
    """
    if not (inside_px > 0).any():
        return EMPTY_SURFACE
    padded = np.pad(inside_px, 1, constant_values=-1.0)
    vertices, faces, _, _ = marching_cubes(padded, 0.0, gradient_direction="ascent")
    vertices_m = grid.origin_m + grid.spacing_m * (vertices.astype(np.float64) - 1)
    return Surface(vertices_m=vertices_m, faces=faces)


def _spread(views: Sequence[CurvedView]) -> list[CurvedView]:
    """Return views of a sequence that goes round so that each is far from those before it.

    The sooner all sides have been seen, the fewer voxels are left to look at.
    """
    order = np.argsort(np.arange(len(views)) * 0.5 * (np.sqrt(5) - 1) % 1)
    return [views[index] for index in order]


def _sampled(view: CurvedView, points_m: Floats) -> NDArray[np.float32]:
    image = view.image_points(points_m)
    place = ((image + 0.5) * FINER - 0.5).astype(np.float32)
    # OpenCV maps images of at most 32 767 pixels a side, so the points go in rows.
    width = 1024
    padded = np.zeros((-(-len(place) // width) * width, 2), dtype=np.float32)
    padded[: len(place)] = place
    row, column = (padded[:, axis].reshape(-1, width) for axis in (0, 1))
    sampled: NDArray[np.float32] = cv2.remap(
        inward_px(view.silhouette), column, row, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE
    ).reshape(-1)[: len(place)]
    return sampled
