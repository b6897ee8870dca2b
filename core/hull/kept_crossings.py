"""Crossings that an edit left where they were, so that only the others are searched again.

Where a grid edge leaves the hull depends on the votes at its two ends and on the outline edges
near its image. Where neither changed, the crossing stays, number by number.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.hull.edge_cells import EdgeCells
from core.hull.threads import InnerLoop

OFF_GRID = np.iinfo(np.uint16).max
"""Stands for the misses of an end outside the grid."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ChangedEdges:
    """Outline edges of one view that came or went, sorted into cells of its image.

    Attributes:
        to_cell: (3, 4) from homogeneous voxel indices to the homogeneous row and column of a cell.
        shape: (2,) cells along rows and columns.
        starts: (cells + 1,) where each cell's edges start; a cell with none has nothing near.
    """

    to_cell: Floats
    shape: NDArray[np.int64]
    starts: NDArray[np.int32]

    @classmethod
    def of(cls, cells: EdgeCells, to_image: Floats) -> "ChangedEdges":
        """Return the edges of `cells`, seen through `to_image` (3 × 4)."""
        return cls(to_cell=cells.to_cell(to_image), shape=cells.shape, starts=cells.starts)


def end_misses(crossed: NDArray[np.int32], votes: NDArray[Any], views: int) -> NDArray[np.uint16]:
    """Return how many views miss the lower and the upper end of grid edges, (edges, 2).

    Misses and not votes, for a view that sees both ends adds a vote to each and moves nothing.

    Args:
        crossed: (edges, 4) as `mesh_slab` returns them.
        votes: (nx, ny, nz).
        views: that voted.
    """
    ends = np.full((len(crossed), 2), OFF_GRID, dtype=np.uint16)
    _read_misses(crossed, votes, views, ends)
    return ends


def kept_crossings(
    crossed: NDArray[np.int32],
    ends: NDArray[np.uint16],
    old_crossed: NDArray[np.int32],
    old_ends: NDArray[np.uint16],
    changes: Sequence[ChangedEdges],
) -> NDArray[np.int64]:
    """Return which old crossing each grid edge keeps, (edges,), −1 where it must be searched.

    Args:
        crossed: (edges, 4) as `mesh_slab` returns them, in its order.
        ends: (edges, 2) of `end_misses`.
        old_crossed: (old edges, 4) the same slab's before.
        old_ends: (old edges, 2) of `end_misses` before.
        changes: of all outlines since.
    """
    kept = np.full(len(crossed), -1, dtype=np.int64)
    _match(crossed, ends, old_crossed, old_ends, kept)
    for change in changes:
        _drop_near(crossed, change.to_cell, change.shape, change.starts, kept)
    return kept


def any_near(crossed: NDArray[np.int32], changes: Sequence[ChangedEdges]) -> bool:
    """Return whether any of the grid edges (edges, 4) could cross a changed outline edge."""
    each = np.zeros(len(crossed), dtype=np.int64)
    for change in changes:
        _drop_near(crossed, change.to_cell, change.shape, change.starts, each)
    return bool(each.any())


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _read_misses(
    crossed: NDArray[np.int32], votes: NDArray[Any], views: int, ends: NDArray[np.uint16]
) -> None:  # pragma: no cover - compiled
    nx, ny, nz = votes.shape
    for i in range(len(crossed)):
        for end in range(2):
            axis = crossed[i, 3] & 3
            x = crossed[i, 0] + (end if axis == 0 else 0)
            y = crossed[i, 1] + (end if axis == 1 else 0)
            z = crossed[i, 2] + (end if axis == 2 else 0)
            if 0 <= x < nx and 0 <= y < ny and 0 <= z < nz:
                ends[i, end] = views - votes[x, y, z]


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _match(
    crossed: NDArray[np.int32],
    ends: NDArray[np.uint16],
    old_crossed: NDArray[np.int32],
    old_ends: NDArray[np.uint16],
    kept: NDArray[np.int64],
) -> None:  # pragma: no cover - compiled
    """Walk both lists, which have the same order, and keep what is in both with equal votes."""
    old = 0
    for i in range(len(crossed)):
        while old < len(old_crossed) and _comes_before(old_crossed, old, crossed, i):
            old += 1
        if old == len(old_crossed):
            return
        same = ends[i, 0] == old_ends[old, 0] and ends[i, 1] == old_ends[old, 1]
        for j in range(4):
            same &= crossed[i, j] == old_crossed[old, j]
        if same:
            kept[i] = old


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _comes_before(
    one: NDArray[np.int32], i: int, other: NDArray[np.int32], j: int
) -> Any:  # pragma: no cover - compiled
    """Return whether grid edge i is numbered before j: by plane, edges within it first."""
    if one[i, 0] != other[j, 0]:
        return one[i, 0] < other[j, 0]
    axis, other_axis = one[i, 3] & 3, other[j, 3] & 3
    if (axis == 0) != (other_axis == 0):
        return other_axis == 0
    if one[i, 1] != other[j, 1]:
        return one[i, 1] < other[j, 1]
    if one[i, 2] != other[j, 2]:
        return one[i, 2] < other[j, 2]
    return axis < other_axis


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _drop_near(
    crossed: NDArray[np.int32],
    to_cell: Floats,
    shape: NDArray[np.int64],
    starts: NDArray[np.int32],
    kept: NDArray[np.int64],
) -> None:  # pragma: no cover - compiled
    """Keep no grid edge whose middle is seen in a cell with edges."""
    rows, columns = shape[0] - 1.0, shape[1] - 1.0
    for i in range(len(crossed)):
        axis = crossed[i, 3] & 3
        x = crossed[i, 0] + (0.5 if axis == 0 else 0.0)
        y = crossed[i, 1] + (0.5 if axis == 1 else 0.0)
        z = crossed[i, 2] + (0.5 if axis == 2 else 0.0)
        depth = to_cell[2, 0] * x + to_cell[2, 1] * y + to_cell[2, 2] * z + to_cell[2, 3]
        row = to_cell[0, 0] * x + to_cell[0, 1] * y + to_cell[0, 2] * z + to_cell[0, 3]
        column = to_cell[1, 0] * x + to_cell[1, 1] * y + to_cell[1, 2] * z + to_cell[1, 3]
        # A rim cell, without edges, stands for all beyond.
        row, column = min(max(row / depth, 0.0), rows), min(max(column / depth, 0.0), columns)
        cell = int(row) * shape[1] + int(column)
        if starts[cell] != starts[cell + 1]:
            kept[i] = -1
