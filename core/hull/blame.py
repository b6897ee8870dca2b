"""Which view carves what alone: the volume that only one view says is outside the target."""

from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

from core.hull.casting import UNWATCHED, Cancelled, Watch, cast
from core.hull.threads import Compiled, chunks
from core.hull.votes import VoteCounts, Voter


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


def gained_without_m3(volume: VoteCounts, watch: Watch = UNWATCHED) -> dict[int, float]:
    """Return for each voting view by how much, in m³, the hull would grow if it did not vote.

    Where all votes are needed that is what the view alone removes. Where misses are tolerated, as
    many are tolerated without it, and it is what would then come back; nothing where a single vote
    is enough. Nobody who changes the volume waits longer than for a look at a part of its votes.

    Args:
        volume: that votes.
        watch: is told the views done, and may cancel.

    Raises:
        Cancelled: `watch` said so, or the volume changed meanwhile.
    """
    with volume.reading():
        if volume.view_count == 0:
            return {}
        voters = {number: voter for number, voter in volume.voters.items() if voter.votes}
        wanted, revision = volume.checked_threshold(volume.threshold) - 1, volume.revision
    if wanted == 0:
        return dict.fromkeys(voters, 0.0)
    lacking = _with_votes(volume, wanted, revision)
    own = np.zeros(volume.grid.shape, dtype=np.uint8)
    gained = {}
    for done, (number, voter) in enumerate(voters.items()):
        if watch.cancel():
            raise Cancelled(f"Cancelled after {done} of {len(voters)} views.")
        missed = _missed_count(own, voter, lacking, watch)
        gained[number] = missed * volume.grid.spacing_m**3
        watch.progress(done + 1, len(voters))
    return gained


def _with_votes(volume: VoteCounts, wanted: int, revision: int) -> NDArray[np.int64]:
    """Return the flat places of the voxels with just so many votes, looking at a part at a time."""
    found = []
    layer = int(np.prod(volume.grid.shape[1:]))
    for first, last in chunks(volume.grid.shape[0], per_thread=32):
        with volume.reading():
            if volume.revision != revision:
                raise Cancelled("The volume changed while it was read.")
            places = np.flatnonzero(volume.votes[first:last] == wanted)
        found.append(places + first * layer)
    return np.concatenate(found)


def _missed_count(
    own: NDArray[np.uint8], voter: Voter, places: NDArray[np.int64], watch: Watch
) -> int:
    """Count the voxels that a view misses, on a grid of zeros that it leaves as it was."""
    cast(own, [voter.pulled_back(1)], [voter.axis], watch=watch)
    missed = len(places) - int(np.count_nonzero(own.ravel().take(places)))
    own.fill(0)
    return missed


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
