"""Open3D's carve_silhouette on a dense grid; it knows pinhole cameras only, so one stands far off.

It carves voxels as cells: one stays while any of its corners is seen inside the mask.
"""

from typing import Any

import numpy as np
import open3d
from numpy.typing import NDArray

from core.arrays import Floats
from core.benchmarks.workload import Task

DISTANCE = 1e6
"""From camera to grid in voxels, so far that perspective moves nothing by a pixel's hundredth."""


def votes(task: Task, _planes: NDArray[np.int64]) -> NDArray[Any]:
    """Return all votes where a voxel of the hull stands, and none elsewhere."""
    grid = open3d.geometry.VoxelGrid.create_dense(
        np.full(3, -0.5), np.zeros(3), 1.0, *map(float, task.grid.shape)
    )
    for mask, to_image in zip(task.masks, task.to_image, strict=True):
        image = open3d.geometry.Image(mask.astype(np.float32))
        grid.carve_silhouette(image, _camera(to_image, mask.shape), False)
    counted = np.zeros(task.grid.shape, dtype=task.dtype)
    kept = np.array([voxel.grid_index for voxel in grid.get_voxels()]).reshape(-1, 3)
    counted[tuple(kept.T)] = len(task.views)
    return counted


def _camera(to_image: Floats, shape: tuple[int, ...]) -> Any:
    """Return a pinhole camera that sees voxel indices as the affine map does."""
    row, column = to_image[0, :3], to_image[1, :3]
    scale = float(np.linalg.norm(row))
    right, down = column / scale, row / scale
    extrinsic = np.eye(4)
    extrinsic[:3, :3] = np.stack([right, down, np.cross(right, down)])
    extrinsic[2, 3] = DISTANCE
    camera = open3d.camera.PinholeCameraParameters()
    camera.extrinsic = extrinsic
    # The constructor refuses a principal point far off the centre; setting the matrix does not.
    intrinsic = open3d.camera.PinholeCameraIntrinsic()
    intrinsic.width, intrinsic.height = shape[1], shape[0]
    focal = scale * DISTANCE
    intrinsic.intrinsic_matrix = [
        [focal, 0, to_image[1, 3]],
        [0, focal, to_image[0, 3]],
        [0, 0, 1],
    ]
    camera.intrinsic = intrinsic
    return camera
