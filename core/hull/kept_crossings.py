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
from core.hull.threads import InnerLoop


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ChangedOutlines:
    """Where in which images outline edges came or went.

    Attributes:
        to_image: (views, 3, 4) from homogeneous voxel indices to the homogeneous image.
        lower: (views, 2) row and column from which a voxel's image is near a change.
        upper: (views, 2) row and column up to which it is.
    """

    to_image: Floats
    lower: Floats
    upper: Floats

    @classmethod
    def of(cls, changes: Sequence[tuple[Floats, Floats, Floats]]) -> "ChangedOutlines":
        """Return changes given as (to_image, lower, upper) one by one."""
        return cls(
            to_image=np.array([to_image for to_image, _, _ in changes]).reshape(-1, 3, 4),
            lower=np.array([lower for _, lower, _ in changes]).reshape(-1, 2),
            upper=np.array([upper for _, _, upper in changes]).reshape(-1, 2),
        )


def end_votes(crossed: NDArray[np.int32], votes: NDArray[Any]) -> NDArray[np.uint16]:
    """Return the votes at the lower and the upper end of grid edges, (edges, 2), 0 off the grid.

    Args:
        crossed: (edges, 4) as `mesh_slab` returns them.
        votes: (nx, ny, nz).
    """
    ends = np.zeros((len(crossed), 2), dtype=np.uint16)
    _read_ends(crossed, votes, ends)
    return ends


def kept_crossings(
    crossed: NDArray[np.int32],
    ends: NDArray[np.uint16],
    old_crossed: NDArray[np.int32],
    old_ends: NDArray[np.uint16],
    changes: ChangedOutlines,
) -> NDArray[np.int64]:
    """Return which old crossing each grid edge keeps, (edges,), −1 where it must be searched.

    Args:
        crossed: (edges, 4) as `mesh_slab` returns them, in its order.
        ends: (edges, 2) of `end_votes`.
        old_crossed: (old edges, 4) the same slab's before.
        old_ends: (old edges, 2) of `end_votes` before.
        changes: of all outlines since.
    """
    kept = np.full(len(crossed), -1, dtype=np.int64)
    _match(crossed, ends, old_crossed, old_ends, kept)
    for to_image, lower, upper in zip(changes.to_image, changes.lower, changes.upper, strict=True):
        _drop_near(crossed, to_image, lower, upper, kept)
    return kept


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _read_ends(
    crossed: NDArray[np.int32], votes: NDArray[Any], ends: NDArray[np.uint16]
) -> None:  # pragma: no cover - compiled
    nx, ny, nz = votes.shape
    for i in range(len(crossed)):
        for end in range(2):
            axis = crossed[i, 3] & 3
            x = crossed[i, 0] + (end if axis == 0 else 0)
            y = crossed[i, 1] + (end if axis == 1 else 0)
            z = crossed[i, 2] + (end if axis == 2 else 0)
            if 0 <= x < nx and 0 <= y < ny and 0 <= z < nz:
                ends[i, end] = votes[x, y, z]


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
    to_image: Floats,
    lower: Floats,
    upper: Floats,
    kept: NDArray[np.int64],
) -> None:  # pragma: no cover - compiled
    """Keep nothing that one image shows between two corners."""
    for i in range(len(crossed)):
        x, y, z = float(crossed[i, 0]), float(crossed[i, 1]), float(crossed[i, 2])
        depth = to_image[2, 0] * x + to_image[2, 1] * y + to_image[2, 2] * z + to_image[2, 3]
        row = to_image[0, 0] * x + to_image[0, 1] * y + to_image[0, 2] * z + to_image[0, 3]
        column = to_image[1, 0] * x + to_image[1, 1] * y + to_image[1, 2] * z + to_image[1, 3]
        if (
            lower[0] * depth <= row <= upper[0] * depth
            and lower[1] * depth <= column <= upper[1] * depth
        ):
            kept[i] = -1
