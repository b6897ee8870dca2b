"""Where on planes x a hull can lie at all, from how far each outline reaches there."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.geometry.grid import VoxelGrid
from core.hull.plane_votes import Window
from core.hull.votes import Voter

GRAZING = 1e-9
"""Sine of the least angle between plane and viewing ray at which an outline counts as bounded."""

ROUNDING_VOXELS = 0.01
"""Far above rounding and the outlines' outset, far below the window's rim."""


def regions_of_interest(
    voters: Sequence[Voter], grid: VoxelGrid, threshold: int, planes: NDArray[np.int64]
) -> list[Window | None]:
    """Return for each slab of planes x the window that the hull may occupy, None where it cannot.

    At least `threshold` outlines hold a voxel of the hull, so it lies within the bounds that at
    least as many of them leave: on each side the (views − threshold + 1)-th tightest. A rim of one
    voxel, which no voxel of the hull is in, goes around it as far as the grid reaches.

    Args:
        voters: the views, made ready for `grid`.
        grid: whose voxels they are.
        threshold: votes that a voxel of the hull has at least.
        planes: (slabs + 1,) increasing; a slab reaches from one plane to the next, both included.
    """
    reach = np.array([reach_on_planes(voter, planes) for voter in voters])
    # Outline points move evenly from plane to plane, so their extremes are those of its ends.
    least = np.minimum(reach[:, :-1, 0], reach[:, 1:, 0])
    greatest = np.maximum(reach[:, :-1, 1], reach[:, 1:, 1])
    least = np.partition(least, threshold - 1, axis=0)[threshold - 1]
    greatest = np.partition(greatest, len(voters) - threshold, axis=0)[len(voters) - threshold]
    ends = np.array(grid.shape[1:])
    first = np.ceil(np.clip(least - ROUNDING_VOXELS, 0, ends)).astype(np.int64)
    last = np.floor(np.clip(greatest + ROUNDING_VOXELS, -1, ends - 1)).astype(np.int64)
    low, end = np.maximum(first - 1, 0), np.minimum(last + 2, ends)
    return [
        _window(planes[i : i + 2], low[i], end[i]) if np.all(first[i] <= last[i]) else None
        for i in range(len(first))
    ]


def _window(planes: NDArray[np.int64], low: NDArray[np.int64], end: NDArray[np.int64]) -> Window:
    sides = end - low
    return Window(
        low=np.array([planes[0], *low]),
        shape=(int(planes[1] - planes[0]) + 1, int(sides[0]), int(sides[1])),
    )


def reach_on_planes(voter: Voter, planes: NDArray[np.int64]) -> Floats:
    """Return (planes, 2, 2) least, then greatest y and z that a view's outline has on planes x.

    In voxel indices; infinite where a plane is seen edge-on, and least above greatest where the
    outline is empty.
    """
    reach = np.empty((len(planes), 2, 2))
    reach[:, 0], reach[:, 1] = np.inf, -np.inf
    if len(voter.outline.points) == 0:
        return reach
    # Every outline point's viewing ray, as two planes through it and as y and z linear in x.
    row, column = voter.outline.points.T[:, :, None]
    a, b = (
        voter.to_image[0] - row * voter.to_image[2],
        voter.to_image[1] - column * voter.to_image[2],
    )
    across = a[:, 1] * b[:, 2] - a[:, 2] * b[:, 1]
    size = np.linalg.norm(a[:, :3], axis=1) * np.linalg.norm(b[:, :3], axis=1)
    if np.any(np.abs(across) <= GRAZING * size):
        return -reach
    per_x = np.stack([a[:, 2] * b[:, 0] - b[:, 2] * a[:, 0], b[:, 1] * a[:, 0] - a[:, 1] * b[:, 0]])
    at_0 = np.stack([a[:, 2] * b[:, 3] - b[:, 2] * a[:, 3], b[:, 1] * a[:, 3] - a[:, 1] * b[:, 3]])
    places = at_0[:, :, None] / across[:, None] + per_x[:, :, None] / across[:, None] * planes
    reach[:, 0], reach[:, 1] = places.min(axis=1).T, places.max(axis=1).T
    depth = np.tensordot(voter.to_image[2, 1:3], places, axes=1)
    depth += voter.to_image[2, 0] * planes + voter.to_image[2, 3]
    behind = depth.min(axis=0) <= 0
    reach[behind, 0], reach[behind, 1] = -np.inf, np.inf
    return reach
