"""matplotlib's Path.contains_points, ring by ring: a compound path would fill its holes."""

from typing import Any

import numpy as np
from matplotlib.path import Path
from numpy.typing import NDArray

from core.benchmarks.peers.points import image_points
from core.benchmarks.workload import Task


def votes(task: Task, planes: NDArray[np.int64]) -> NDArray[Any]:
    """Return the votes of some planes."""
    counted = np.zeros((len(planes), *task.grid.shape[1:]), dtype=task.dtype)
    outlines = [[Path(ring, closed=False) for ring in v.silhouette.rings] for v in task.views]
    for target, plane in zip(counted, planes, strict=True):
        for view, paths in enumerate(outlines):
            row, column = image_points(task, view, int(plane))
            points = np.column_stack([row.ravel(), column.ravel()])
            inside = np.zeros(len(points), dtype=bool)
            for path in paths:
                inside ^= path.contains_points(points)
            np.add(target, inside.reshape(target.shape), out=target)
    return counted
