"""Where a plane's voxel centres fall in an image."""

import numpy as np

from core.arrays import Floats
from core.benchmarks.workload import Task


def image_points(task: Task, view: int, plane: int) -> tuple[Floats, Floats]:
    """Return rows and columns, each (ny, nz), of one plane's voxel centres in one view."""
    _, ny, nz = task.grid.shape
    y, z = np.arange(ny)[:, None], np.arange(nz)[None, :]
    row, column = (m[0] * plane + m[1] * y + m[2] * z + m[3] for m in task.to_image[view])
    return row, column
