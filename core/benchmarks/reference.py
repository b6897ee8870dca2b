"""The exact votes, voxel by voxel: which outlines is its centre inside or on?

It shares nothing with the engine's sweep: a ray along the row from every voxel's projection, in
every view, counts the edges that it crosses. Edges are found by the pixel row that they reach
into, and voxels outside an outline's rectangle are spared. `core.hull.polygon_test`, the paper's
own test, gives the same, and a test holds them equal.
"""

from dataclasses import dataclass

import numba
import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.benchmarks.workload import Task
from core.hull.outline import OUTSET_PX
from core.hull.threads import Compiled, in_parallel
from core.hull.view import View

TESTS_AT_MOST = 2**31
"""Voxels × views past which only every n-th plane is compared."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Edges:
    """A view's edges by pixel row.

    Attributes:
        ends: (edges, 4) as (row, column, row, column).
        first_row: pixel row of the first bucket.
        starts: (rows + 1,) where each row's bucket starts in `members`.
        members: numbers of the edges that reach into each row.
    """

    ends: Floats
    first_row: int
    starts: NDArray[np.int64]
    members: NDArray[np.int64]

    @classmethod
    def of(cls, view: View) -> "Edges":
        """Return the edges of a view's silhouette."""
        rings = view.silhouette.rings
        ends = np.concatenate([np.hstack([ring, np.roll(ring, -1, axis=0)]) for ring in rings])
        # A pixel's thousandth more than any tolerance.
        low = np.floor(np.minimum(ends[:, 0], ends[:, 2]) - 1e-3).astype(np.int64)
        high = np.floor(np.maximum(ends[:, 0], ends[:, 2]) + 1e-3).astype(np.int64)
        rows = np.arange(low.min(), high.max() + 1)
        buckets = [np.flatnonzero((low <= row) & (high >= row)) for row in rows]
        return cls(
            ends=ends,
            first_row=int(rows[0]),
            starts=np.cumsum([0] + [len(bucket) for bucket in buckets]),
            members=np.concatenate(buckets),
        )


def reference_stride(task: Task) -> int:
    """Return n if every n-th plane is to be compared, a power of two."""
    tests = int(np.prod(task.grid.shape)) * len(task.views)
    return 1 << max(0, int(np.ceil(np.log2(tests / TESTS_AT_MOST))))


def every_nth_plane(count: int, stride: int) -> NDArray[np.int64]:
    """Return every n-th of `count` planes; those of 2 n are among those of n.

    They start a third into the grid, so that the few planes of a large n still cut the body.
    """
    return np.arange(count // 3 % stride, count, stride)


def reference_votes(
    task: Task, planes: NDArray[np.int64], on_px: float = OUTSET_PX
) -> NDArray[np.uint16]:
    """Return the exact votes (planes, ny, nz) of some planes along x.

    Args:
        task: views with outlines, and grid.
        planes: their numbers.
        on_px: how far from an edge a point still counts as on it, for the rounding of projections.
    """
    votes = np.zeros((len(planes), *task.grid.shape[1:]), dtype=np.uint16)
    outlines = [Edges.of(view) for view in task.views]

    def work(number: int) -> None:
        for edges, to_image in zip(outlines, task.to_image, strict=True):
            _add_votes(
                votes[number],
                float(planes[number]),
                to_image,
                edges.ends,
                edges.first_row,
                edges.starts,
                edges.members,
                on_px,
            )

    in_parallel(work, range(len(planes)))
    return votes


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def _add_votes(
    votes: NDArray[np.uint16],
    x: float,
    m: Floats,
    ends: Floats,
    first_row: int,
    starts: NDArray[np.int64],
    members: NDArray[np.int64],
    on_px: float,
) -> None:  # pragma: no cover - compiled
    leftmost = min(ends[:, 1].min(), ends[:, 3].min()) - on_px
    rightmost = max(ends[:, 1].max(), ends[:, 3].max()) + on_px
    for y in range(votes.shape[0]):
        for z in range(votes.shape[1]):
            row = m[0, 0] * x + m[0, 1] * y + m[0, 2] * z + m[0, 3]
            column = m[1, 0] * x + m[1, 1] * y + m[1, 2] * z + m[1, 3]
            bucket = int(np.floor(row)) - first_row
            if bucket < 0 or bucket > len(starts) - 2 or column < leftmost or column > rightmost:
                continue
            near = members[starts[bucket] : starts[bucket + 1]]
            votes[y, z] += _vote(row, column, ends, near, on_px)


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def _vote(
    row: float, column: float, ends: Floats, near: NDArray[np.int64], on_px: float
) -> bool:  # pragma: no cover - compiled
    """Return whether a point lies inside or on an outline whose edges near its row are given."""
    inside = False
    for edge in near:
        r, c = ends[edge, 0] - row, ends[edge, 1] - column
        end_r, end_c = ends[edge, 2] - row, ends[edge, 3] - column
        cross = r * end_c - c * end_r
        along_r, along_c = end_r - r, end_c - c
        squared = along_r * along_r + along_c * along_c
        # Squared, not to take a root of every edge for every voxel.
        if cross * cross <= on_px * on_px * squared and (
            r * end_r + c * end_c <= on_px * np.sqrt(squared)
        ):
            return True
        if (r > 0) != (end_r > 0) and (cross > 0) == (along_r < 0):
            inside = not inside
    return inside
