"""Where exactly a hull's boundary crosses a grid edge.

A grid edge from inside to outside loses its votes where its image crosses the outlines of the
views that miss its outer end. The first place at which fewer votes than the threshold are left
is the hull's boundary.
"""

from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.hull.threads import Compiled, InnerLoop

ORDER_VOXELS = 32
"""Voxels along z for which one order of the views is kept: neighbours end at the same views."""

EVENTS_PER_VIEW = 4
LEAST_EVENTS = 64
"""Outline crossings of one grid edge that are looked at: room for four of each view, and for 64
in all. Beyond a far end hundreds of views may each cross the same edge."""


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def cross_grid_edges(
    crossed: NDArray[np.int32],
    votes: NDArray[Any],
    low: NDArray[np.int64],
    threshold: int,
    to_image: Floats,
    points: Floats,
    cell_maps: Floats,
    starts: NDArray[np.int32],
    edges: NDArray[np.int32],
    lines: Floats,
) -> tuple[Floats, NDArray[np.int32]]:  # pragma: no cover - compiled
    """Return where each crossed grid edge leaves the hull, and the outline edge that ends it there.

    Args:
        crossed: (edges, 4) as `mesh_slab` returns them, counted in the window.
        votes: (nx, ny, nz) of a window of the grid.
        low: (3,) index of the window's first voxel.
        threshold: votes from which a voxel is inside.
        to_image: as in `CrossingTables`, like all that follow.
        points: see there.
        cell_maps: see there.
        starts: see there.
        edges: see there.
        lines: see there.

    Returns:
        vertices: (edges, 3) in the grid's voxel indices.
        causes: (edges, 2) view and point in `points` where the outline edge starts, −1 at the
            grid's end.
    """
    vertices, causes = np.empty((len(crossed), 3)), np.full((len(crossed), 2), -1, dtype=np.int32)
    room = max(LEAST_EVENTS, EVENTS_PER_VIEW * len(to_image))
    _cross_all(
        crossed,
        votes,
        low,
        threshold,
        to_image,
        points,
        cell_maps,
        starts,
        edges,
        lines,
        vertices,
        causes,
        _orders(votes.shape[2] // ORDER_VOXELS + 2, len(to_image)),
        np.empty((2, 3)),
        np.empty(room),
        np.empty(room, dtype=np.int64),
        np.empty((room, 2), dtype=np.int32),
    )
    return vertices, causes


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def _orders(count: int, views: int) -> NDArray[np.int32]:  # pragma: no cover - compiled
    """Return the orders (count, views) with which a search begins."""
    orders = np.empty((count, views), dtype=np.int32)
    for i in range(count):
        orders[i] = np.arange(views)
    return orders


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _cross_all(
    crossed: NDArray[np.int32],
    votes: NDArray[Any],
    low: NDArray[np.int64],
    threshold: int,
    to_image: Floats,
    points: Floats,
    cell_maps: Floats,
    starts: NDArray[np.int32],
    edges: NDArray[np.int32],
    lines: Floats,
    vertices: Floats,
    causes: NDArray[np.int32],
    orders: NDArray[np.int32],
    ends: Floats,
    event_at: Floats,
    event_step: NDArray[np.int64],
    event_cause: NDArray[np.int32],
) -> None:  # pragma: no cover - compiled
    """Write vertices and causes; what comes after them is room to work in."""
    inner, outer = ends[0], ends[1]
    for i in range(len(crossed)):
        inside, missing = _ends(crossed[i], votes, low, inner, outer)
        part = 0.5
        if missing >= 0:
            strict = threshold == len(to_image)
            count = _collect(
                inner,
                outer,
                missing if strict else -1,
                orders[(crossed[i, 2] + 1) // ORDER_VOXELS],
                to_image,
                points,
                cell_maps,
                starts,
                edges,
                lines,
                event_at,
                event_step,
                event_cause,
            )
            chosen = _first_below(count, inside, threshold, event_at, event_step)
            if chosen >= 0:
                part = min(max(event_at[chosen], 0.0), 1.0)
                causes[i, 0], causes[i, 1] = event_cause[chosen, 0], event_cause[chosen, 1]
        for axis in range(3):
            vertices[i, axis] = inner[axis] + part * (outer[axis] - inner[axis])


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _ends(
    crossed: NDArray[np.int32],
    votes: NDArray[Any],
    low: NDArray[np.int64],
    inner: Floats,
    outer: Floats,
) -> tuple[int, int]:  # pragma: no cover - compiled
    """Write a grid edge's ends, the inside one first; return their votes, −1 outside the window."""
    axis, lower_inside = crossed[3] & 3, crossed[3] >> 2
    for i in range(3):
        lower = low[i] + crossed[i]
        upper = lower + (i == axis)
        inner[i], outer[i] = (lower, upper) if lower_inside else (upper, lower)
    x, y, z = int(inner[0]) - low[0], int(inner[1]) - low[1], int(inner[2]) - low[2]
    inside = votes[x, y, z]
    x, y, z = int(outer[0]) - low[0], int(outer[1]) - low[1], int(outer[2]) - low[2]
    if min(x, y, z) < 0 or x >= votes.shape[0] or y >= votes.shape[1] or z >= votes.shape[2]:
        return inside, -1
    return inside, votes[x, y, z]


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _first_below(
    count: int, inside: int, threshold: int, event_at: Floats, event_step: NDArray[np.int64]
) -> int:  # pragma: no cover - compiled
    """Return which of the sorted events first leaves fewer votes than the threshold, or −1."""
    left = inside
    for event in range(count):
        left += event_step[event]
        if left < threshold:
            return event
    return -1


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _seen_in_cells(
    cell_maps: Floats, view: int, x: float, y: float, z: float
) -> tuple[float, float]:  # pragma: no cover - compiled
    """Return where a view sees a point, as row and column in cells."""
    m = cell_maps
    row = m[view, 0] * x + m[view, 1] * y + m[view, 2] * z + m[view, 3]
    column = m[view, 4] * x + m[view, 5] * y + m[view, 6] * z + m[view, 7]
    depth = m[view, 8] * x + m[view, 9] * y + m[view, 10] * z + m[view, 11]
    if depth == 1.0:
        return row, column
    return row / depth, column / depth


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _collect(
    inner: Floats,
    outer: Floats,
    votes_outside: int,
    order: NDArray[np.int32],
    to_image: Floats,
    points: Floats,
    cell_maps: Floats,
    starts: NDArray[np.int32],
    edges: NDArray[np.int32],
    lines: Floats,
    event_at: Floats,
    event_step: NDArray[np.int64],
    event_cause: NDArray[np.int32],
) -> int:  # pragma: no cover - compiled
    """Write where views are lost and won on the way out, sorted, and return how many.

    With `votes_outside` ≥ 0 all views vote inside, and only those count that miss the outer end:
    as soon as all of them are found the search is over. They move to the front of `order`, for
    the same views most often end the next grid edge too; what is found does not depend on it.
    """
    count, found = 0, 0
    views = len(order)
    x, y, z = 0.5 * (inner[0] + outer[0]), 0.5 * (inner[1] + outer[1]), 0.5 * (inner[2] + outer[2])
    for rank in range(views):
        view = order[rank]
        row, column = _seen_in_cells(cell_maps, view, x, y, z)
        rows, columns = cell_maps[view, 12], cell_maps[view, 13]
        # A rim cell stands for all beyond.
        cell = int(min(max(row, 0.0), rows - 1)) * int(columns)
        cell += int(min(max(column, 0.0), columns - 1)) + int(cell_maps[view, 14])
        before, net, projected = count, 0, False
        pr, pc, pw, qr, qc, qw = 0.0, 0.0, 1.0, 0.0, 0.0, 1.0
        first_edge, first_point = int(cell_maps[view, 15]), int(cell_maps[view, 16])
        for k in range(first_edge + starts[cell], first_edge + starts[cell + 1]):
            edge = first_point + edges[k]
            if abs(lines[edge, 0] * row + lines[edge, 1] * column + lines[edge, 2]) > 1.0:
                continue
            if not projected:
                projected = True
                pr, pc, pw = _project(to_image, view, inner[0], inner[1], inner[2])
                qr, qc, qw = _project(to_image, view, outer[0], outer[1], outer[2])
                pr, pc, qr, qc = pr / pw, pc / pw, qr / qw, qc / qw
            part, step = _cross_edge(points, edge, pr, pc, pw, qr, qc, qw)
            if step != 0 and count < len(event_at):
                _insert(event_at, event_step, event_cause, count, part, step, view, edge)
                count += 1
                net += step
        if votes_outside < 0 or count == before:
            continue
        if net >= 0:
            count = _without(event_at, event_step, event_cause, count, view)
            continue
        for later in range(rank, 0, -1):
            order[later] = order[later - 1]
        order[0] = view
        found += 1
        if found == views - votes_outside:
            break
    return count


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _project(
    to_image: Floats, view: int, x: float, y: float, z: float
) -> tuple[float, float, float]:  # pragma: no cover - compiled
    """Return a voxel index's homogeneous image."""
    return (
        _applied(to_image, view, 0, x, y, z),
        _applied(to_image, view, 1, x, y, z),
        _applied(to_image, view, 2, x, y, z),
    )


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _applied(
    to_image: Floats, view: int, row: int, x: float, y: float, z: float
) -> Any:  # pragma: no cover - compiled
    near = to_image[view, row, 0] * x + to_image[view, row, 1] * y
    return near + to_image[view, row, 2] * z + to_image[view, row, 3]


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _cross_edge(
    points: Floats, at: int, pr: float, pc: float, pw: float, qr: float, qc: float, qw: float
) -> tuple[float, int]:  # pragma: no cover - compiled
    """Return how far on the way from p to q an edge is crossed, and −1 out, +1 in, 0 not."""
    ar, ac, br, bc = points[at, 0], points[at, 1], points[at + 1, 0], points[at + 1, 1]
    dr, dc = qr - pr, qc - pc
    tail = dr * (ac - pc) - dc * (ar - pr) >= 0
    head = dr * (bc - pc) - dc * (br - pr) >= 0
    if tail == head:
        return 0.0, 0
    er, ec = br - ar, bc - ac
    from_p = er * (pc - ac) - ec * (pr - ar)
    from_q = er * (qc - ac) - ec * (qr - ar)
    if (from_p >= 0) == (from_q >= 0):
        return 0.0, 0
    # Depths make the image's ratio that in space.
    return from_p * pw / (from_p * pw - from_q * qw), -1 if from_p < 0 else 1


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _insert(
    event_at: Floats,
    event_step: NDArray[np.int64],
    event_cause: NDArray[np.int32],
    count: int,
    part: float,
    step: int,
    view: int,
    edge: int,
) -> None:  # pragma: no cover - compiled
    """Insert an event among `count` sorted ones."""
    i = count
    while i > 0 and (
        event_at[i - 1] > part or (event_at[i - 1] == part and event_cause[i - 1, 0] > view)
    ):
        event_at[i], event_step[i] = event_at[i - 1], event_step[i - 1]
        event_cause[i, 0], event_cause[i, 1] = event_cause[i - 1, 0], event_cause[i - 1, 1]
        i -= 1
    event_at[i], event_step[i] = part, step
    event_cause[i, 0], event_cause[i, 1] = view, edge


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _without(
    event_at: Floats,
    event_step: NDArray[np.int64],
    event_cause: NDArray[np.int32],
    count: int,
    view: int,
) -> int:  # pragma: no cover - compiled
    """Drop one view's events and return how many are left."""
    left = 0
    for i in range(count):
        if event_cause[i, 0] != view:
            event_at[left], event_step[left] = event_at[i], event_step[i]
            event_cause[left, 0], event_cause[left, 1] = event_cause[i, 0], event_cause[i, 1]
            left += 1
    return left
