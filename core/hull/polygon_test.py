"""The paper's polygon test, written plainly: the reference that every fast path must equal.

It walks around an outline and adds up by how many quadrants each vertex lies ahead of the last
as seen from the point. Two rounds of a simple ring give ±4 around a point inside and 0 outside.
"""

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats


def votes_of(points: Floats, rings: tuple[Floats, ...], on_px: float = 0.0) -> NDArray[np.bool_]:
    """Return which points lie inside or on an outline: a vote each (eqs. 20 and 24).

    Args:
        points: (points, 2) as (row, column).
        rings: each (vertices, 2); holes run the other way than the rings around them.
        on_px: how far from an edge a point still counts as on it; 0 is the paper's test, more
            forgives the rounding of points that were projected.

    Source: section III.E of the paper, steps 1 to 8.
    """
    turns = np.zeros(len(points), dtype=np.int64)
    on = np.zeros(len(points), dtype=bool)
    for ring in rings:
        for tail, head in zip(ring, np.roll(ring, -1, axis=0), strict=True):
            # Steps 1 and 2: the outline as seen from the point.
            start, end = tail - points, head - points
            on |= _is_on_edge(start, end, on_px)
            turns += _quadrant_steps(start, end)
    # Steps 7 and 8: a hole's −4 takes its ring's +4 back.
    votes: NDArray[np.bool_] = on | (turns != 0)
    return votes


def _is_on_edge(start: Floats, end: Floats, on_px: float) -> NDArray[np.bool_]:
    """Return where the origin lies between start and end, both (points, 2), on their line.

    Source: eq. 23 with r_j r_{j+1} + d_j d_{j+1} ≤ 0 as its inner product (a minus is printed,
    with which a point on a level edge's extension would count as on it).
    """
    edge = end - start
    length = np.hypot(edge[:, 0], edge[:, 1])
    between = np.sum(start * end, axis=1) <= on_px * length
    on: NDArray[np.bool_] = between & (np.abs(_cross(start, end)) <= on_px * length)
    return on


def _quadrant_steps(start: Floats, end: Floats) -> NDArray[np.int64]:
    """Return by how many quadrants each edge turns around the origin.

    Source: eqs. 21 and 22. The paper's cases are read as what they must mean: a step of 3 is one
    step back (−1), a step of −3 one forward (+1), and a step of ±2 goes around that side of the
    origin on which the edge passes, which the cross product tells.
    """
    step = _quadrant(end) - _quadrant(start)
    around = 2 * np.sign(_cross(start, end)).astype(np.int64)
    opposite = np.where(np.abs(step) == 2, around, step)
    return np.where(step == 3, -1, np.where(step == -3, 1, opposite))


def _quadrant(vector: Floats) -> NDArray[np.int64]:
    """Return the quadrant 0 to 3 of each (points, 2), counted from the first axis to the second."""
    first, second = vector[:, 0] >= 0, vector[:, 1] >= 0
    return np.where(second, np.where(first, 0, 1), np.where(first, 3, 2))


def _cross(start: Floats, end: Floats) -> Floats:
    product: Floats = start[:, 0] * end[:, 1] - start[:, 1] * end[:, 0]
    return product
