"""Where exactly a hull's boundary crosses a grid edge.

A grid edge from inside to outside loses its votes where its image crosses the outlines of the
views that miss its outer end. The first place at which fewer votes than the threshold are left
is the hull's boundary.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.hull.edge_cells import EdgeCells
from core.hull.outline import Outline
from core.hull.threads import Compiled

MOST_EVENTS = 64
"""Outline crossings of one grid edge that are looked at; more would need a crossing per 1/64."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class CrossingTables:
    """Outlines of all views, one after another, as the search for crossings needs them.

    Attributes:
        to_image: (views, 3, 4) from homogeneous voxel indices to the homogeneous image.
        points: (points, 2) of all outlines as (row, column).
        origins: (views, 3) as in `EdgeCells`.
        shapes: (views, 2) as in `EdgeCells`.
        bases: (views, 3) where each view's points, starts and edges begin.
        starts: of all views' cells.
        edges: of all views' cells.
    """

    to_image: Floats
    points: Floats
    origins: Floats
    shapes: NDArray[np.int64]
    bases: NDArray[np.int64]
    starts: NDArray[np.int32]
    edges: NDArray[np.int32]

    @classmethod
    def of(
        cls, maps: Sequence[Floats], outlines: Sequence[Outline], cells: Sequence[EdgeCells]
    ) -> "CrossingTables":
        """Return the tables of views, given each one's map to the image, outline and cells."""
        sizes = [
            (len(o.points), len(c.starts), len(c.edges))
            for o, c in zip(outlines, cells, strict=True)
        ]
        ends = np.cumsum(np.array(sizes, dtype=np.int64), axis=0)
        return cls(
            to_image=np.array(maps),
            points=np.concatenate([outline.points for outline in outlines]),
            origins=np.array([cell.origin for cell in cells]),
            shapes=np.array([cell.shape for cell in cells]),
            bases=np.concatenate([np.zeros((1, 3), dtype=np.int64), ends[:-1]]),
            starts=np.concatenate([cell.starts for cell in cells]),
            edges=np.concatenate([cell.edges for cell in cells]),
        )


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def cross_grid_edges(
    crossed: NDArray[np.int32],
    votes: NDArray[Any],
    threshold: int,
    to_image: Floats,
    points: Floats,
    origins: Floats,
    shapes: NDArray[np.int64],
    bases: NDArray[np.int64],
    starts: NDArray[np.int32],
    edges: NDArray[np.int32],
) -> tuple[Floats, NDArray[np.int32]]:  # pragma: no cover - compiled
    """Return where each crossed grid edge leaves the hull, and the outline edge that ends it there.

    Args:
        crossed: (edges, 4) as `mesh_slab` returns them.
        votes: (nx, ny, nz).
        threshold: votes from which a voxel is inside.
        to_image: as in `CrossingTables`, like all that follow.
        points: see there.
        origins: see there.
        shapes: see there.
        bases: see there.
        starts: see there.
        edges: see there.

    Returns:
        vertices: (edges, 3) in voxel indices.
        causes: (edges, 2) view and point at which the outline edge starts; −1 at the grid's end.
    """
    vertices, causes = np.empty((len(crossed), 3)), np.full((len(crossed), 2), -1, dtype=np.int32)
    order = np.arange(len(to_image))
    inner, outer = np.empty(3), np.empty(3)
    event_at, event_step = np.empty(MOST_EVENTS), np.empty(MOST_EVENTS, dtype=np.int64)
    event_cause = np.empty((MOST_EVENTS, 2), dtype=np.int32)
    for i in range(len(crossed)):
        inside, missing = _ends(crossed[i], votes, inner, outer)
        part = 0.5
        if missing >= 0:
            strict = threshold == len(to_image)
            count = _collect(
                inner,
                outer,
                missing if strict else -1,
                order,
                to_image,
                points,
                origins,
                shapes,
                bases,
                starts,
                edges,
                event_at,
                event_step,
                event_cause,
            )
            chosen = _first_below(count, inside, threshold, event_at, event_step)
            if chosen >= 0:
                part = min(max(event_at[chosen], 0.0), 1.0)
                causes[i] = event_cause[chosen]
        for axis in range(3):
            vertices[i, axis] = inner[axis] + part * (outer[axis] - inner[axis])
    return vertices, causes


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def _ends(
    crossed: NDArray[np.int32], votes: NDArray[Any], inner: Floats, outer: Floats
) -> tuple[int, int]:  # pragma: no cover - compiled
    """Write a grid edge's ends, the inside one first; return their votes, −1 outside the grid."""
    axis, lower_inside = crossed[3] & 3, crossed[3] >> 2
    for i in range(3):
        lower, upper = crossed[i], crossed[i] + (i == axis)
        inner[i], outer[i] = (lower, upper) if lower_inside else (upper, lower)
    inside = votes[int(inner[0]), int(inner[1]), int(inner[2])]
    for i in range(3):
        if outer[i] < 0 or outer[i] >= votes.shape[i]:
            return inside, -1
    return inside, votes[int(outer[0]), int(outer[1]), int(outer[2])]


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
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


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def _collect(
    inner: Floats,
    outer: Floats,
    votes_outside: int,
    order: NDArray[np.int64],
    to_image: Floats,
    points: Floats,
    origins: Floats,
    shapes: NDArray[np.int64],
    bases: NDArray[np.int64],
    starts: NDArray[np.int32],
    edges: NDArray[np.int32],
    event_at: Floats,
    event_step: NDArray[np.int64],
    event_cause: NDArray[np.int32],
) -> int:  # pragma: no cover - compiled
    """Write where views are lost and won on the way out, sorted, and return how many.

    With `votes_outside` ≥ 0 all views vote inside, and only those count that miss the outer end:
    as soon as all of them are found the search is over. Views found move to the front of `order`,
    for the next grid edge is most often ended by the same ones; the result does not depend on it.
    """
    count, found = 0, 0
    views = len(order)
    x, y, z = 0.5 * (inner[0] + outer[0]), 0.5 * (inner[1] + outer[1]), 0.5 * (inner[2] + outer[2])
    for rank in range(views):
        view = order[rank]
        before = count
        row, column, depth = _project(to_image, view, x, y, z)
        if depth != 1.0:
            row, column = row / depth, column / depth
        row = (row - origins[view, 0]) * origins[view, 2]
        column = (column - origins[view, 1]) * origins[view, 2]
        if row < 0 or column < 0 or row >= shapes[view, 0] or column >= shapes[view, 1]:
            continue
        cell = bases[view, 1] + int(row) * shapes[view, 1] + int(column)
        if starts[cell] == starts[cell + 1]:
            continue
        pr, pc, pw = _project(to_image, view, inner[0], inner[1], inner[2])
        qr, qc, qw = _project(to_image, view, outer[0], outer[1], outer[2])
        pr, pc, qr, qc = pr / pw, pc / pw, qr / qw, qc / qw
        net = 0
        for k in range(starts[cell], starts[cell + 1]):
            edge = edges[bases[view, 2] + k]
            at = bases[view, 0] + edge
            part, step = _cross_edge(points, at, pr, pc, pw, qr, qc, qw)
            if step != 0 and count < MOST_EVENTS:
                _insert(event_at, event_step, event_cause, count, part, step, view, edge)
                count += 1
                net += step
        if votes_outside < 0 or count == before:
            continue
        if net >= 0:
            count = _without(event_at, event_step, event_cause, count, view)
            continue
        found += 1
        order[rank] = order[found - 1]
        order[found - 1] = view
        if found == views - votes_outside:
            break
    return count


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def _project(
    to_image: Floats, view: int, x: float, y: float, z: float
) -> tuple[float, float, float]:  # pragma: no cover - compiled
    """Return a voxel index's homogeneous image."""
    return (
        _applied(to_image, view, 0, x, y, z),
        _applied(to_image, view, 1, x, y, z),
        _applied(to_image, view, 2, x, y, z),
    )


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def _applied(
    to_image: Floats, view: int, row: int, x: float, y: float, z: float
) -> float:  # pragma: no cover - compiled
    near = to_image[view, row, 0] * x + to_image[view, row, 1] * y
    return near + to_image[view, row, 2] * z + to_image[view, row, 3]


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
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


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
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


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
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
            event_cause[left] = event_cause[i]
            left += 1
    return left
