"""Checks of an outline's rings, and the step outward that makes "on" mean "inside"."""

from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.hull.threads import InnerLoop

NEAREST_PX = 1e-6
"""Edges that come nearer to each other than this are taken to touch."""

Indices = NDArray[np.int64]


def prepared(points: Floats, offsets: Indices) -> bool:
    """Turn rings in place, outer ones clockwise, or return False if they cross, touch or repeat.

    Args:
        points: (points, 2) of closed rings after one another, first points repeated.
        offsets: (rings + 1,) where each starts.
    """
    if _any_too_short(points, offsets) or _edges_meet(points, offsets):
        return False
    _turn(points, offsets)
    return True


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _any_too_short(points: Floats, offsets: Indices) -> bool:  # pragma: no cover - compiled
    for ring in range(len(offsets) - 1):
        for i in range(offsets[ring], offsets[ring + 1] - 1):
            r, c = points[i + 1, 0] - points[i, 0], points[i + 1, 1] - points[i, 1]
            if r * r + c * c <= NEAREST_PX**2:
                return True
    return False


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _turn(points: Floats, offsets: Indices) -> None:  # pragma: no cover - compiled
    """Run each ring clockwise, or the other way if an odd number of others surround it."""
    for ring in range(len(offsets) - 1):
        first, last = offsets[ring], offsets[ring + 1]
        inward = False
        for other in range(len(offsets) - 1):
            if other != ring and _holds(points, offsets[other], offsets[other + 1], first):
                inward = not inward
        if (_area(points, first, last) < 0) != inward:
            _reverse(points, first, last - 1)


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _reverse(points: Floats, first: int, last: int) -> None:  # pragma: no cover - compiled
    while first < last:
        for axis in range(2):
            kept = points[first, axis]
            points[first, axis] = points[last, axis]
            points[last, axis] = kept
        first, last = first + 1, last - 1


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _area(points: Floats, first: int, last: int) -> float:  # pragma: no cover - compiled
    """Return twice the area of a closed ring, positive if clockwise (rows down, columns right)."""
    area = 0.0
    for i in range(first, last - 1):
        # Seen from the ring's first point, so that a far place in the image costs no digits.
        r1, c1 = points[i, 0] - points[first, 0], points[i, 1] - points[first, 1]
        r2, c2 = points[i + 1, 0] - points[first, 0], points[i + 1, 1] - points[first, 1]
        area += c1 * r2 - r1 * c2
    return area


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _holds(points: Floats, first: int, last: int, at: int) -> bool:  # pragma: no cover - compiled
    """Return whether a closed ring surrounds a point that is not on it."""
    inside = False
    row, column = points[at, 0], points[at, 1]
    for i in range(first, last - 1):
        tail, head = points[i, 0], points[i + 1, 0]
        if (tail > row) != (head > row):
            part = (row - tail) / (head - tail)
            inside ^= points[i, 1] + part * (points[i + 1, 1] - points[i, 1]) > column
    return inside


def _edges_meet(points: Floats, offsets: Indices) -> bool:
    """Return whether any two edges cross or touch, neighbours at their common vertex excepted."""
    count = len(points) - 1
    nexts = np.arange(1, count + 1)
    nexts[offsets[1:] - 2] = offsets[:-1]
    # Between one ring's last point and the next one's first there is no edge.
    edges = np.delete(np.arange(count), offsets[1:-1] - 1)
    low = np.minimum(points[:-1, 0], points[1:, 0]) - NEAREST_PX
    order = edges[np.argsort(low[edges])]
    return bool(_any_meet(points, nexts, low, order))


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _any_meet(
    points: Floats, nexts: Indices, low: Floats, order: Indices
) -> bool:  # pragma: no cover - compiled
    """Search edges in the order of their least rows, each against those that begin within it."""
    for rank in range(len(order)):
        i = order[rank]
        if _folds_back(points, i, nexts[i]):
            return True
        high = max(points[i, 0], points[i + 1, 0])
        for later in range(rank + 1, len(order)):
            j = order[later]
            if low[j] > high:
                break
            if nexts[i] != j and nexts[j] != i and _meet(points, i, j):
                return True
    return False


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _folds_back(points: Floats, i: int, j: int) -> Any:  # pragma: no cover - compiled
    """Return whether edge j, which follows edge i, runs back along it."""
    ar, ac = points[i + 1, 0] - points[i, 0], points[i + 1, 1] - points[i, 1]
    br, bc = points[j + 1, 0] - points[j, 0], points[j + 1, 1] - points[j, 1]
    size = np.sqrt((ar * ar + ac * ac) * (br * br + bc * bc))
    return ar * br + ac * bc < 0 and abs(ar * bc - ac * br) <= NEAREST_PX * size


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _meet(points: Floats, i: int, j: int) -> bool:  # pragma: no cover - compiled
    """Return whether two edges cross, touch, or all but touch."""
    a, b, c, d = points[i, 1], points[i + 1, 1], points[j, 1], points[j + 1, 1]
    if max(a, b) + NEAREST_PX < min(c, d) or max(c, d) + NEAREST_PX < min(a, b):
        return False
    return not (_apart(points, i, j) or _apart(points, j, i))


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _apart(points: Floats, i: int, j: int) -> Any:  # pragma: no cover - compiled
    """Return whether edge j lies wholly on one side of the line through edge i."""
    r, c = points[i + 1, 0] - points[i, 0], points[i + 1, 1] - points[i, 1]
    limit = NEAREST_PX * np.sqrt(r * r + c * c)
    one = r * (points[j, 1] - points[i, 1]) - c * (points[j, 0] - points[i, 0])
    two = r * (points[j + 1, 1] - points[i, 1]) - c * (points[j + 1, 0] - points[i, 0])
    return (one > limit and two > limit) or (one < -limit and two < -limit)


def outset(points: Floats, offsets: Indices, distance: float) -> tuple[Floats, Indices]:
    """Return closed, rightly turned rings with every edge moved outward, mitred at its vertices.

    Sharp tips are cut square instead, where a mitre would reach far beyond them.

    Args:
        points: (points, 2) of closed rings after one another, first points repeated.
        offsets: (rings + 1,) where each starts.
        distance: how far, in pixels.

    Returns:
        The same form: points and offsets.
    """
    moved, starts = np.empty((2 * len(points), 2)), np.zeros_like(offsets)
    _outset_rings(points, offsets, distance, moved, starts)
    return moved[: starts[-1]].copy(), starts


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _outset_rings(
    points: Floats, offsets: Indices, distance: float, moved: Floats, starts: Indices
) -> None:  # pragma: no cover - compiled
    """Write the moved points and where each ring of them starts."""
    count = 0
    for ring in range(len(offsets) - 1):
        first, last, own = offsets[ring], offsets[ring + 1] - 1, count
        for i in range(first, last):
            before = i - 1 if i > first else last - 1
            count = _outset_vertex(points, before, i, distance, moved, count)
        moved[count, 0], moved[count, 1] = moved[own, 0], moved[own, 1]
        count += 1
        starts[ring + 1] = count


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _outset_vertex(
    points: Floats, before: int, i: int, distance: float, moved: Floats, count: int
) -> int:  # pragma: no cover - compiled
    """Write one vertex moved outward, a sharp tip as two; return how many there are by now."""
    r1, c1 = points[i, 0] - points[before, 0], points[i, 1] - points[before, 1]
    r2, c2 = points[i + 1, 0] - points[i, 0], points[i + 1, 1] - points[i, 1]
    one, two = np.sqrt(r1 * r1 + c1 * c1), np.sqrt(r2 * r2 + c2 * c2)
    r1, c1, r2, c2 = r1 / one, c1 / one, r2 / two, c2 / two
    if r1 * c2 - c1 * r2 < 0 and r1 * r2 + c1 * c2 < -0.5:
        moved[count, 0] = points[i, 0] + distance * (r1 - c1)
        moved[count, 1] = points[i, 1] + distance * (c1 + r1)
        moved[count + 1, 0] = points[i, 0] - distance * (r2 + c2)
        moved[count + 1, 1] = points[i, 1] + distance * (r2 - c2)
        return count + 2
    normal_r, normal_c = -(c1 + c2), r1 + r2
    size = np.sqrt(normal_r * normal_r + normal_c * normal_c)
    reach = min(2 * distance / size, 0.5 * min(one, two)) / size
    moved[count, 0] = points[i, 0] + reach * normal_r
    moved[count, 1] = points[i, 1] + reach * normal_c
    return count + 1
