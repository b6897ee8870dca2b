"""OpenCV's warpAffine: every mask warped onto every plane, planes on all threads."""

from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from core.benchmarks.workload import Task
from core.hull.threads import in_parallel

HOW = cv2.INTER_NEAREST | cv2.WARP_INVERSE_MAP


def votes(task: Task, planes: NDArray[np.int64]) -> NDArray[Any]:
    """Return the votes of some planes."""
    _, ny, nz = task.grid.shape
    counted = np.zeros((len(planes), ny, nz), dtype=task.dtype)
    # OpenCV's (x, y) is (z, y) in the plane and (column, row) in the image.
    ordered = task.to_image[:, ::-1, [2, 1, 3]]
    moved = task.to_image[:, ::-1, 0]

    def work(number: int) -> None:
        target = counted[number]
        warped = np.empty((ny, nz), dtype=np.uint8)
        for mask, to_image, shift in zip(task.masks, ordered, moved, strict=True):
            matrix = to_image.copy()
            matrix[:, 2] += shift * planes[number]
            cv2.warpAffine(mask, matrix, (nz, ny), dst=warped, flags=HOW)
            np.add(target, warped, out=target)

    in_parallel(work, range(len(planes)))
    return counted
