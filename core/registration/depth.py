"""How deep the lines of sight of one image run inside the hull of all other views.

No grid takes part, so a panel thinner than a voxel counts: at every step along a line the hull's
depth is the least of the distances to the other outlines, and the line's depth is the greatest.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numba
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt

from core.arrays import Floats
from core.hull.threads import InnerLoop
from core.hull.view import View

MARGIN_PX = 32
"""How far around an outline its distances are kept; what lies further counts as this far."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class DistanceMaps:
    """Signed distances to the outlines that carve, positive inside, one map after another.

    Attributes:
        distances_px: (all pixels,) float32.
        start: (views,) where each map begins.
        shape: (views, 2) rows and columns of each.
        corner: (views, 2) pixel of the image on which each begins.
    """

    distances_px: NDArray[np.float32]
    start: NDArray[np.int64]
    shape: NDArray[np.int64]
    corner: NDArray[np.int64]

    @classmethod
    def of(cls, views: Sequence[View]) -> "DistanceMaps":
        """Return the maps of outlines as the shadow rule fills them."""
        made = [_distance_map(view) for view in views]
        sizes = [image.size for image, _ in made]
        return cls(
            distances_px=np.concatenate([image.ravel() for image, _ in made]),
            start=np.cumsum([0, *sizes[:-1]]),
            shape=np.array([image.shape for image, _ in made], dtype=np.int64),
            corner=np.array([corner for _, corner in made], dtype=np.int64),
        )

    def image(self, view: int) -> NDArray[np.float32]:
        """Return the map of one view."""
        rows, columns = self.shape[view]
        start = self.start[view]
        return self.distances_px[start : start + rows * columns].reshape(rows, columns)


def _distance_map(view: View) -> tuple[NDArray[np.float32], Floats]:
    filled = view.silhouette.mask()
    if view.silhouette.claim == "lit side":
        filled = np.logical_or.accumulate(filled, axis=0)  # the shadow rule, pixel by pixel
    points = np.concatenate(view.silhouette.rings)
    rows, columns = filled.shape
    top, left = np.floor(points.min(axis=0)).astype(int) - MARGIN_PX
    bottom, right = np.ceil(points.max(axis=0)).astype(int) + MARGIN_PX
    # Past the image's edge its last pixels go on: a filled shadow has no end there.
    row, column = np.arange(top, bottom + 1), np.arange(left, right + 1)
    inside = filled[np.clip(row, 0, rows - 1)[:, None], np.clip(column, 0, columns - 1)]
    signed = np.where(
        inside, distance_transform_edt(inside) - 0.5, 0.5 - distance_transform_edt(~inside)
    )
    return signed.astype(np.float32), np.array([top, left])


def depths_px(
    lines_m: Floats,
    step_m: Floats,
    matrices: Floats,
    carving: NDArray[np.int64],
    maps: DistanceMaps,
) -> Floats:
    """Return the depth (lines,) of each line in the hull, in pixels, negative where it misses.

    Args:
        lines_m: (lines, 3) where each begins, target frame.
        step_m: (steps, 3) from there to the places looked at.
        matrices: (views, 2, 4) projections.
        carving: the views whose hull it is.
        maps: of all views.
    """
    deepest = np.empty(len(lines_m))
    _depths(
        np.ascontiguousarray(lines_m),
        np.ascontiguousarray(step_m),
        np.ascontiguousarray(matrices),
        carving,
        maps.distances_px,
        maps.start,
        maps.shape,
        maps.corner,
        deepest,
    )
    return deepest


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _depths(
    lines: Floats,
    steps: Floats,
    matrices: Floats,
    carving: NDArray[np.int64],
    distances: NDArray[np.float32],
    start: NDArray[np.int64],
    shape: NDArray[np.int64],
    corner: NDArray[np.int64],
    deepest: Floats,
) -> None:  # pragma: no cover - compiled
    """Take the greatest along each line of the least bilinear distance over the views."""
    for line in range(len(lines)):
        best = -np.inf
        for step in range(len(steps)):
            x = lines[line, 0] + steps[step, 0]
            y = lines[line, 1] + steps[step, 1]
            z = lines[line, 2] + steps[step, 2]
            least = np.inf
            for each in range(len(carving)):
                v = carving[each]
                m = matrices[v]
                rows, columns = shape[v, 0], shape[v, 1]
                row = m[0, 0] * x + m[0, 1] * y + m[0, 2] * z + m[0, 3] - corner[v, 0]
                column = m[1, 0] * x + m[1, 1] * y + m[1, 2] * z + m[1, 3] - corner[v, 1]
                row = min(max(row, 0.0), rows - 1.001)
                column = min(max(column, 0.0), columns - 1.001)
                r, c = int(row), int(column)
                down, right = row - r, column - c
                at = start[v] + r * columns + c
                near = distances[at] * (1 - right) + distances[at + 1] * right
                far = distances[at + columns] * (1 - right) + distances[at + columns + 1] * right
                least = min(least, near * (1 - down) + far * down)
                if least <= best:
                    break
            best = max(best, least)
        deepest[line] = best
