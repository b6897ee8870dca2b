"""Compiled checks of an outline's rings, and the step outward that makes "on" mean "inside"."""

from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.hull.threads import Compiled

NEAREST_PX = 1e-6
"""Edges that come nearer to each other than this are taken to touch."""


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def prepared(points: Floats, offsets: NDArray[np.int64]) -> bool:  # pragma: no cover - compiled
    """Turn rings in place, outer ones clockwise, or return False if they cross, touch or repeat.

    Args:
        points: (points, 2) of closed rings after one another, first points repeated.
        offsets: (rings + 1,) where each starts.
    """
    if _too_short(points, offsets) or _edges_meet(points, offsets):
        return False
    for ring in range(len(offsets) - 1):
        first, last = offsets[ring], offsets[ring + 1]
        surrounding = 0
        for other in range(len(offsets) - 1):
            if other != ring and _holds(points[offsets[other] : offsets[other + 1]], points[first]):
                surrounding += 1
        if (_area(points[first:last]) < 0) != (surrounding % 2 == 1):
            points[first:last] = points[first:last][::-1].copy()
    return True


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def _too_short(points: Floats, offsets: NDArray[np.int64]) -> bool:  # pragma: no cover - compiled
    for ring in range(len(offsets) - 1):
        for i in range(offsets[ring], offsets[ring + 1] - 1):
            row, column = points[i + 1, 0] - points[i, 0], points[i + 1, 1] - points[i, 1]
            if row * row + column * column <= NEAREST_PX * NEAREST_PX:
                return True
    return False


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def _area(ring: Floats) -> float:  # pragma: no cover - compiled
    """Return twice the area of a closed ring, positive if clockwise (rows down, columns right)."""
    total = 0.0
    for i in range(len(ring) - 1):
        row, column = ring[i, 0] - ring[0, 0], ring[i, 1] - ring[0, 1]
        total += column * (ring[i + 1, 0] - ring[0, 0]) - row * (ring[i + 1, 1] - ring[0, 1])
    return total


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def _holds(ring: Floats, point: Floats) -> bool:  # pragma: no cover - compiled
    """Return whether a closed ring surrounds a point that is not on it."""
    inside = False
    for i in range(len(ring) - 1):
        if (ring[i, 0] > point[0]) != (ring[i + 1, 0] > point[0]):
            part = (point[0] - ring[i, 0]) / (ring[i + 1, 0] - ring[i, 0])
            if ring[i, 1] + part * (ring[i + 1, 1] - ring[i, 1]) > point[1]:
                inside = not inside
    return inside


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def _edges_meet(points: Floats, offsets: NDArray[np.int64]) -> bool:  # pragma: no cover - compiled
    """Return whether any two edges cross or touch, neighbours at their common vertex excepted."""
    count = len(points) - 1
    nexts = np.empty(count, dtype=np.int64)
    low = np.full(count, np.inf)
    for ring in range(len(offsets) - 1):
        last = offsets[ring + 1] - 2
        for i in range(offsets[ring], last + 1):
            nexts[i] = i + 1 if i < last else offsets[ring]
            low[i] = min(points[i, 0], points[i + 1, 0]) - NEAREST_PX
    order = np.argsort(low)
    for rank in range(count):
        i = order[rank]
        if low[i] == np.inf:
            break
        if _folds_back(points, i, nexts[i]):
            return True
        high = max(points[i, 0], points[i + 1, 0])
        for later in range(rank + 1, count):
            j = order[later]
            if low[j] > high:
                break
            if nexts[i] != j and nexts[j] != i and _meet(points, i, j):
                return True
    return False


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def _folds_back(points: Floats, i: int, j: int) -> Any:  # pragma: no cover - compiled
    """Return whether edge j, which follows edge i, runs back along it."""
    ar, ac = points[i + 1, 0] - points[i, 0], points[i + 1, 1] - points[i, 1]
    br, bc = points[j + 1, 0] - points[j, 0], points[j + 1, 1] - points[j, 1]
    size = np.sqrt((ar * ar + ac * ac) * (br * br + bc * bc))
    return ar * br + ac * bc < 0 and abs(ar * bc - ac * br) <= NEAREST_PX * size


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def _meet(points: Floats, i: int, j: int) -> bool:  # pragma: no cover - compiled
    """Return whether two edges cross, touch, or all but touch."""
    a, b, c, d = points[i, 1], points[i + 1, 1], points[j, 1], points[j + 1, 1]
    if max(a, b) + NEAREST_PX < min(c, d) or max(c, d) + NEAREST_PX < min(a, b):
        return False
    return not (_apart(points, i, j) or _apart(points, j, i))


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def _apart(points: Floats, i: int, j: int) -> Any:  # pragma: no cover - compiled
    """Return whether edge j lies wholly on one side of the line through edge i."""
    r, c = points[i + 1, 0] - points[i, 0], points[i + 1, 1] - points[i, 1]
    limit = NEAREST_PX * np.sqrt(r * r + c * c)
    one = r * (points[j, 1] - points[i, 1]) - c * (points[j, 0] - points[i, 0])
    two = r * (points[j + 1, 1] - points[i, 1]) - c * (points[j + 1, 0] - points[i, 0])
    return (one > limit and two > limit) or (one < -limit and two < -limit)


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def outset(
    points: Floats, offsets: NDArray[np.int64], distance: float
) -> tuple[Floats, NDArray[np.int64]]:  # pragma: no cover - compiled
    """Return closed, rightly turned rings with every edge moved outward, mitred at its vertices.

    Sharp tips are cut square instead, where a mitre would reach far beyond them.
    """
    moved, starts = np.empty((2 * len(points), 2)), np.zeros_like(offsets)
    filled = 0
    for ring in range(len(offsets) - 1):
        first, last = offsets[ring], offsets[ring + 1] - 1
        for i in range(first, last):
            before = points[i - 1] if i > first else points[last - 1]
            filled += _move_vertex(before, points[i], points[i + 1], distance, moved[filled:])
        moved[filled] = moved[starts[ring]]
        filled += 1
        starts[ring + 1] = filled
    return moved[:filled].copy(), starts


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def _move_vertex(
    before: Floats, vertex: Floats, after: Floats, distance: float, moved: Floats
) -> int:  # pragma: no cover - compiled
    """Write the one or two points that a vertex becomes, and return how many."""
    r1, c1, length1 = _direction(before, vertex)
    r2, c2, length2 = _direction(vertex, after)
    if r1 * c2 - c1 * r2 < 0 and r1 * r2 + c1 * c2 < -0.5:
        moved[0, 0] = vertex[0] + distance * (r1 - c1)
        moved[0, 1] = vertex[1] + distance * (c1 + r1)
        moved[1, 0] = vertex[0] - distance * (r2 + c2)
        moved[1, 1] = vertex[1] + distance * (r2 - c2)
        return 2
    nr, nc = -(c1 + c2), r1 + r2
    size = np.sqrt(nr * nr + nc * nc)
    reach = min(2 * distance / size, 0.5 * min(length1, length2)) / size
    moved[0, 0] = vertex[0] + reach * nr
    moved[0, 1] = vertex[1] + reach * nc
    return 1


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def _direction(
    tail: Floats, head: Floats
) -> tuple[float, float, float]:  # pragma: no cover - compiled
    r, c = head[0] - tail[0], head[1] - tail[1]
    length = np.sqrt(r * r + c * c)
    return r / length, c / length, length
