"""The space beyond a hull that only few views have carved away."""

import numpy as np
from scipy.ndimage import binary_dilation

from core.geometry.grid import VoxelGrid
from core.hull.closed_mesh import Surface
from core.hull.surface import EMPTY_SURFACE, mask_surface
from core.hull.votes import VoteCounts

MOST_VOXELS = 96
"""Along each axis of the grid that it is shown on: it is a region to look at, not an edge."""

FEW_VIEWS = 0.1
"""Share of the voting views that count as few."""


def few(voting: int) -> int:
    """Return how many of the voting views are few, at least one."""
    return max(1, round(FEW_VIEWS * voting))


def uncarved_surface(volume: VoteCounts, misses: int | None = None) -> Surface:
    """Return what the hull would gain if it tolerated more misses, as one closed surface.

    The region begins a voxel outside the hull: the skin that edges of outlines always leave would
    hide it. Votes are read under their lock and meshed without.

    Args:
        volume: that has voted.
        misses: more of them, by default few of its views.
    """
    with volume.reading():
        voting = sum(voter.votes for voter in volume.voters.values())
        if voting == 0:
            return EMPTY_SURFACE
        shape = volume.grid.shape
        step = min(-(-max(shape) // MOST_VOXELS), min(shape) // 2)
        votes = volume.votes[::step, ::step, ::step].copy()
        threshold = volume.checked_threshold(volume.threshold)
    grid = VoxelGrid(
        origin_m=volume.grid.origin_m, spacing_m=step * volume.grid.spacing_m, shape=votes.shape
    )
    least = max(1, threshold - (few(voting) if misses is None else misses))
    hull = binary_dilation(votes >= threshold, np.ones((3, 3, 3), dtype=np.bool_))
    return mask_surface((votes >= least) & ~hull, grid)
