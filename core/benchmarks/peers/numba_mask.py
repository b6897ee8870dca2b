"""A compiled loop that looks every voxel up in every mask, on all threads."""

from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.benchmarks.workload import Task
from core.hull.threads import Compiled, in_parallel


def votes(task: Task, planes: NDArray[np.int64]) -> NDArray[Any]:
    """Return the votes of some planes."""
    counted = np.zeros((len(planes), *task.grid.shape[1:]), dtype=task.dtype)

    def work(number: int) -> None:
        _look_up(counted[number], float(planes[number]), task.masks, task.to_image)

    in_parallel(work, range(len(planes)))
    return counted


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def _look_up(
    votes: NDArray[Any], x: float, masks: NDArray[np.uint8], to_image: Floats
) -> None:  # pragma: no cover - compiled
    views, rows, columns = masks.shape
    for view in range(views):
        m, mask = to_image[view], masks[view]
        for y in range(votes.shape[0]):
            # A half added, truncation rounds; a pixel more keeps what is outside from 0.
            row_start = m[0, 0] * x + m[0, 1] * y + m[0, 3] + 1.5
            column_start = m[1, 0] * x + m[1, 1] * y + m[1, 3] + 1.5
            for z in range(votes.shape[1]):
                row = np.int32(row_start + m[0, 2] * z) - 1
                column = np.int32(column_start + m[1, 2] * z) - 1
                if 0 <= row < rows and 0 <= column < columns:
                    votes[y, z] += mask[row, column]
