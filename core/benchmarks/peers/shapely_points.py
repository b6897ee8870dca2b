"""Shapely's vectorised predicate on prepared polygons; it counts what lies on the outline."""

from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from core.benchmarks.peers.points import image_points
from core.benchmarks.workload import Task
from core.silhouettes.silhouette import Silhouette


def votes(task: Task, planes: NDArray[np.int64]) -> NDArray[Any]:
    """Return the votes of some planes."""
    counted = np.zeros((len(planes), *task.grid.shape[1:]), dtype=task.dtype)
    areas = [area_of(view.silhouette) for view in task.views]
    shapely.prepare(areas)
    for target, plane in zip(counted, planes, strict=True):
        for view, area in enumerate(areas):
            inside = shapely.intersects_xy(area, *image_points(task, view, int(plane)))
            np.add(target, inside, out=target)
    return counted


def area_of(silhouette: Silhouette) -> shapely.Geometry:
    """Return what a silhouette encloses: the exclusive or of its rings."""
    area = shapely.Polygon()
    for ring in silhouette.rings:
        area = shapely.symmetric_difference(area, shapely.Polygon(ring))
    return area
