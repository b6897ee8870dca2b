"""NumPy's fancy indexing into masks, at the nearest pixel."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from core.benchmarks.peers.points import image_points
from core.benchmarks.workload import Task


def votes(task: Task, planes: NDArray[np.int64]) -> NDArray[Any]:
    """Return the votes of some planes."""
    counted = np.zeros((len(planes), *task.grid.shape[1:]), dtype=task.dtype)
    _, rows, columns = task.masks.shape
    for target, plane in zip(counted, planes, strict=True):
        for view, mask in enumerate(task.masks):
            row, column = (np.rint(at).astype(np.int64) for at in image_points(task, view, plane))
            seen = (row >= 0) & (row < rows) & (column >= 0) & (column < columns)
            target[seen] += mask[row[seen], column[seen]]
    return counted
