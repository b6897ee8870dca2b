"""Which view carves what alone: the volume that only one view says is outside the target."""

from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

from core.hull.casting import cast
from core.hull.threads import Compiled
from core.hull.votes import VoteCounts


def removed_alone_m3(volume: VoteCounts) -> dict[int, float]:
    """Return for each voting view the volume, in m³, of the voxels that it alone removes.

    Every view but that one votes for such a voxel. The sweep adds up the voting views' positions
    instead of ones; where a single vote lacks, what lacks of the sum is that view's position.
    """
    with volume.reading():
        voters = [(n, voter) for n, voter in volume.voters.items() if voter.votes]
        positions = np.zeros(volume.grid.shape, dtype=np.uint32)
        parts = [voter.pulled_back(place) for place, (_, voter) in enumerate(voters, start=1)]
        cast(positions, parts, [voter.axis for _, voter in voters])
        counts = _count_alone(volume.votes, positions, len(voters))
    voxel_m3 = volume.grid.spacing_m**3
    return {
        number: float(count) * voxel_m3
        for (number, _), count in zip(voters, counts[1:], strict=True)
    }


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def _count_alone(
    votes: NDArray[Any], positions: NDArray[np.uint32], views: int
) -> NDArray[np.int64]:  # pragma: no cover - compiled
    """Return (views + 1,) how many voxels lack only the vote of the view at each position."""
    counts = np.zeros(views + 1, dtype=np.int64)
    total = views * (views + 1) // 2
    for x in range(votes.shape[0]):
        for y in range(votes.shape[1]):
            for z in range(votes.shape[2]):
                if votes[x, y, z] == views - 1:
                    counts[total - positions[x, y, z]] += 1
    return counts
