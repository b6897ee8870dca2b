"""Outlines pulled back into the grid: what every vertex and edge sweeps along the grid's lines.

All grid lines along one axis are seen along one direction of an image (in perspective, through
one point). Seen so, a vertex sweeps a plane that splits the lines into those that pass it on the
left and on the right, and an edge sweeps a plane that each line between its two vertices crosses
once. Both planes are linear in the voxel indices, for affine and for perspective views alike; for
an affine view the first one only translates from plane to plane.
"""

from dataclasses import dataclass
from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.geometry.grid import VoxelGrid
from core.geometry.projection import Projection
from core.hull.threads import Compiled

PARALLEL_PX = 1e-9
"""An edge that spans less than this across the lines' direction is crossed nowhere."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PulledBack:
    """Polylines of one or more views as the sweep along one axis needs them.

    Lines stand at (plane, place): plane counts along the axis that is neither the lines' nor z,
    place along z.

    Attributes:
        place: (2, points) place = place[0] + place[1] plane, where lines change side.
        crossing: (3, points) coordinate along the line where it crosses the edge that starts at
            this point: crossing[0] + crossing[1] plane + crossing[2] place.
        flips: (points,) 0 where lines at smaller places pass the point on its right, else 1.
        offsets: (polylines + 1,) where each polyline starts among the points.
        weights: (polylines,) what entering adds to a vote.
    """

    place: Floats
    crossing: Floats
    flips: NDArray[np.uint8]
    offsets: NDArray[np.int64]
    weights: NDArray[np.int64]


def line_axis(projection: Projection) -> int:
    """Return the axis (1 or 0) whose grid lines the view sees, and does not look along.

    A view whose viewing direction is nearest y is swept along x, every other one along y. No view
    looks along both, so z need not be one of them: it is contiguous, and a running sum along
    another axis adds whole rows along z at once.
    """
    if not projection.is_affine:
        return 0 if int(np.argmax(np.abs(projection.matrix[2, :3]))) == 1 else 1
    (a, b, c, _), (d, e, f, _) = projection.matrix.tolist()
    along = abs(b * f - c * e), abs(c * d - a * f), abs(a * e - b * d)
    return 0 if along[1] > max(along[0], along[2]) else 1


def pulled_back(
    points: Floats,
    offsets: NDArray[np.int64],
    weights: NDArray[np.int64],
    to_image: Floats,
    axis: int,
) -> PulledBack:
    """Return polylines of one view pulled back for a sweep of lines along `axis` (1 or 0).

    Args:
        points: (points, 2) as (row, column).
        offsets: (polylines + 1,) where each polyline starts.
        weights: (polylines,) what entering adds to a vote.
        to_image: 3 × 4 from homogeneous voxel indices to the homogeneous image.
        axis: the lines' axis.
    """
    ordered = np.ascontiguousarray(to_image[:, [axis, 1 - axis, 2, 3]])
    place, crossing, flips = _planes(points, ordered)
    return PulledBack(place=place, crossing=crossing, flips=flips, offsets=offsets, weights=weights)


def joined(parts: list[PulledBack]) -> PulledBack:
    """Return the polylines of several views of the same line axis as one."""
    starts = np.cumsum([0] + [part.place.shape[1] for part in parts])
    offsets = [part.offsets[:-1] + start for part, start in zip(parts, starts[:-1], strict=True)]
    return PulledBack(
        place=np.concatenate([part.place for part in parts], axis=1),
        crossing=np.concatenate([part.crossing for part in parts], axis=1),
        flips=np.concatenate([part.flips for part in parts]),
        offsets=np.append(np.concatenate(offsets), starts[-1]),
        weights=np.concatenate([part.weights for part in parts]),
    )


def index_to_image(projection: Projection, grid: VoxelGrid) -> Floats:
    """Return the 3 × 4 map from homogeneous voxel indices to the homogeneous image.

    Raises:
        ValueError: a perspective camera does not have the whole grid in front of it.
    """
    to_image = np.zeros((3, 4))
    to_image[2, 3] = 1.0
    rows = len(projection.matrix)
    to_image[:rows] = projection.matrix @ grid.index_to_target()
    if projection.is_affine:
        return to_image
    corners = np.array(np.meshgrid(*[(0, count - 1) for count in grid.shape])).reshape(3, -1)
    if float((to_image[2, :3] @ corners + to_image[2, 3]).min()) <= 0:
        raise ValueError(
            "The camera of a perspective view must have the whole grid in front of it; "
            "make the grid smaller or check the camera matrix's sign."
        )
    return to_image


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def _planes(
    points: Floats, to_image: Floats
) -> tuple[Floats, Floats, NDArray[np.uint8]]:  # pragma: no cover - compiled
    """Return place, crossing and flips; `to_image` has the line's axis first, then plane, place."""
    count = len(points)
    place, crossing = np.empty((2, count)), np.zeros((3, count))
    flips = np.zeros(count, dtype=np.uint8)
    x, y, w = to_image[0, 0], to_image[1, 0], to_image[2, 0]
    for i in range(count):
        row, column = points[i, 0], points[i, 1]
        # The image line through the point along the grid's lines, positive on its right.
        a, b = y - w * column, w * row - x
        scale = 1 / np.sqrt(a * a + b * b)
        a, b = a * scale, b * scale
        c = -(a * row + b * column)
        slope = _seen(a, b, c, to_image, 2)
        flips[i] = slope < 0
        if abs(slope) < 1e-12:
            slope = -1e-12 if slope < 0 else 1e-12
        place[0, i] = -_seen(a, b, c, to_image, 3) / slope
        place[1, i] = -_seen(a, b, c, to_image, 1) / slope
    for i in range(count - 1):
        a, b, c = _edge_line(points, i, x, y, w)
        speed = _seen(a, b, c, to_image, 0)
        crossing[0, i] = -_seen(a, b, c, to_image, 3) / speed
        crossing[1, i] = -_seen(a, b, c, to_image, 1) / speed
        crossing[2, i] = -_seen(a, b, c, to_image, 2) / speed
    return place, crossing, flips


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def _edge_line(
    points: Floats, i: int, x: float, y: float, w: float
) -> tuple[float, float, float]:  # pragma: no cover - compiled
    """Return the image line a row + b column + c = 0 through edge i.

    One that runs along the grid's lines, seen toward (x, y, w), is crossed by none of them; the
    line across its first point stands for it, so that no division is by zero.
    """
    row, column = points[i, 0], points[i, 1]
    a, b = column - points[i + 1, 1], points[i + 1, 0] - row
    along_row, along_column = x - row * w, y - column * w
    reach = np.sqrt(along_row * along_row + along_column * along_column)
    if abs(a * along_row + b * along_column) <= PARALLEL_PX * reach:
        a, b = along_row, along_column
    return a, b, -(a * row + b * column)


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def _seen(
    a: float, b: float, c: float, to_image: Floats, column: int
) -> Any:  # pragma: no cover - compiled
    """Return an image line applied to one column of the map to the image."""
    return a * to_image[0, column] + b * to_image[1, column] + c * to_image[2, column]
