"""Blocks of voxels decided at once by summed-area tables of the masks, mixed ones by lookup."""

from typing import Any

import cv2
import numba
import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.benchmarks.workload import Task
from core.hull.threads import Compiled, in_parallel

SIDE = 8


def votes(task: Task, _planes: NDArray[np.int64]) -> NDArray[Any]:
    """Return the votes of all planes."""
    counted = np.zeros(task.grid.shape, dtype=task.dtype)
    sums = np.array([cv2.integral(mask) for mask in task.masks])

    def work(first: int) -> None:
        _count(counted, first, task.masks, sums, task.to_image)

    in_parallel(work, range(0, task.grid.shape[0], SIDE))
    return counted


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def _count(
    votes: NDArray[Any],
    x: int,
    masks: NDArray[np.uint8],
    sums: NDArray[np.int32],
    to_image: Floats,
) -> None:  # pragma: no cover - compiled
    nx, ny, nz = votes.shape
    for y in range(0, ny, SIDE):
        for z in range(0, nz, SIDE):
            block = votes[x : min(x + SIDE, nx), y : min(y + SIDE, ny), z : min(z + SIDE, nz)]
            whole = 0
            for view in range(len(masks)):
                m = to_image[view]
                seen = _rectangle_sum(m, x, y, z, block.shape, sums[view])
                if seen == 1:
                    whole += 1
                elif seen == -1:
                    _look_up(block, m, x, y, z, masks[view])
            if whole > 0:
                for i in range(block.shape[0]):
                    for j in range(block.shape[1]):
                        for k in range(block.shape[2]):
                            block[i, j, k] += whole


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def _rectangle_sum(
    m: Floats, x: int, y: int, z: int, shape: tuple[int, int, int], sums: NDArray[np.int32]
) -> int:  # pragma: no cover - compiled
    """Return 1 if a block is seen inside the mask, 0 if outside, −1 if it may be either."""
    low, high = np.empty(2), np.empty(2)
    for i in range(2):
        at = m[i, 0] * x + m[i, 1] * y + m[i, 2] * z + m[i, 3]
        a, b, c = m[i, 0] * (shape[0] - 1), m[i, 1] * (shape[1] - 1), m[i, 2] * (shape[2] - 1)
        low[i] = np.floor(at + min(a, 0.0) + min(b, 0.0) + min(c, 0.0))
        high[i] = np.ceil(at + max(a, 0.0) + max(b, 0.0) + max(c, 0.0))
    rows, columns = sums.shape[0] - 1, sums.shape[1] - 1
    top, bottom = int(max(low[0], 0.0)), int(min(high[0] + 1, float(rows)))
    left, right = int(max(low[1], 0.0)), int(min(high[1] + 1, float(columns)))
    if top >= bottom or left >= right:
        return 0
    total = sums[bottom, right] - sums[top, right] - sums[bottom, left] + sums[top, left]
    if total == 0:
        return 0
    if total == (high[0] - low[0] + 1) * (high[1] - low[1] + 1):
        return 1
    return -1


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def _look_up(
    block: NDArray[Any], m: Floats, x: int, y: int, z: int, mask: NDArray[np.uint8]
) -> None:  # pragma: no cover - compiled
    for i in range(block.shape[0]):
        for j in range(block.shape[1]):
            row_start = m[0, 0] * (x + i) + m[0, 1] * (y + j) + m[0, 2] * z + m[0, 3] + 1.5
            column_start = m[1, 0] * (x + i) + m[1, 1] * (y + j) + m[1, 2] * z + m[1, 3] + 1.5
            for k in range(block.shape[2]):
                row = np.int32(row_start + m[0, 2] * k) - 1
                column = np.int32(column_start + m[1, 2] * k) - 1
                if 0 <= row < mask.shape[0] and 0 <= column < mask.shape[1]:
                    block[i, j, k] += mask[row, column]
