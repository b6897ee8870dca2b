"""Checks of an outline's rings, and the step outward that makes "on" mean "inside".

Only the search for edges that meet is compiled: it is the one part whose work grows faster than
the outline, and every compiled line costs time at the very first start.
"""

import itertools
from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.hull.threads import Compiled

NEAREST_PX = 1e-6
"""Edges that come nearer to each other than this are taken to touch."""

Indices = NDArray[np.int64]


def prepared(points: Floats, offsets: Indices) -> bool:
    """Turn rings in place, outer ones clockwise, or return False if they cross, touch or repeat.

    Args:
        points: (points, 2) of closed rings after one another, first points repeated.
        offsets: (rings + 1,) where each starts.
    """
    rings = [points[a:b] for a, b in itertools.pairwise(offsets)]
    if any(_is_too_short(ring) for ring in rings) or _edges_meet(points, offsets):
        return False
    for ring in rings:
        surrounding = sum(_holds(other, ring[0]) for other in rings if other is not ring)
        if (_area(ring) < 0) != (surrounding % 2 == 1):
            ring[:] = ring[::-1].copy()
    return True


def _is_too_short(ring: Floats) -> bool:
    return bool(np.any(np.sum(np.diff(ring, axis=0) ** 2, axis=1) <= NEAREST_PX**2))


def _area(ring: Floats) -> float:
    """Return twice the area of a closed ring, positive if clockwise (rows down, columns right)."""
    row, column = (ring - ring[0]).T
    return float(np.sum(column[:-1] * row[1:] - row[:-1] * column[1:]))


def _holds(ring: Floats, point: Floats) -> bool:
    """Return whether a closed ring surrounds a point that is not on it."""
    tail, head = ring[:-1], ring[1:]
    crosses = (tail[:, 0] > point[0]) != (head[:, 0] > point[0])
    tail, head = tail[crosses], head[crosses]
    part = (point[0] - tail[:, 0]) / (head[:, 0] - tail[:, 0])
    return int(np.sum(tail[:, 1] + part * (head[:, 1] - tail[:, 1]) > point[1])) % 2 == 1


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


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
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
    moved = [_outset_ring(points[a : b - 1], distance) for a, b in itertools.pairwise(offsets)]
    starts = np.zeros_like(offsets)
    starts[1:] = np.cumsum([len(ring) for ring in moved])
    return np.concatenate(moved), starts


def _outset_ring(ring: Floats, distance: float) -> Floats:
    """Return one ring (vertices, 2) moved outward and closed by its first point."""
    after = np.roll(ring, -1, axis=0) - ring
    length = np.sqrt(after[:, 0] * after[:, 0] + after[:, 1] * after[:, 1])
    r2, c2 = (after / length[:, None]).T
    r1, c1 = np.roll(r2, 1), np.roll(c2, 1)
    is_tip = (r1 * c2 - c1 * r2 < 0) & (r1 * r2 + c1 * c2 < -0.5)
    normal = np.column_stack([-(c1 + c2), r1 + r2])
    size = np.where(is_tip, 1.0, np.sqrt(normal[:, 0] * normal[:, 0] + normal[:, 1] * normal[:, 1]))
    shortest = 0.5 * np.minimum(np.roll(length, 1), length)
    reach = np.minimum(2 * distance / size, shortest) / size
    first = ring + reach[:, None] * normal
    first[is_tip] = (ring + distance * np.column_stack([r1 - c1, c1 + r1]))[is_tip]
    second = ring + distance * np.column_stack([-(r2 + c2), r2 - c2])
    both = np.stack([first, second], axis=1).reshape(-1, 2)
    kept = np.column_stack([np.ones(len(ring), dtype=bool), is_tip]).ravel()
    closed: Floats = both[kept]
    return np.concatenate([closed, closed[:1]])
