"""Which views emptied a hull."""

import numpy as np
from numpy.typing import NDArray

from core.hull.votes import VoteCounts, cast

MOST_PLACES = 4096
"""Voxels that are looked at where it takes several views to empty a hull."""


def emptied_by(volume: VoteCounts) -> tuple[int, ...]:
    """Return the numbers of the views that emptied the hull at the volume's threshold.

    Where excluding one view would leave a hull, all such views. Else the views that miss the
    voxels with the most votes: without all of them there would be a hull. None where the hull is
    not empty, where nothing votes or where no voxel has a vote.
    """
    with volume.reading():
        most = int(volume.votes.max())
        if volume.view_count == 0 or most == 0:
            return ()
        lacking = volume.checked_threshold(volume.threshold) - most
        if lacking <= 0:
            return ()
        places = np.flatnonzero(volume.votes.ravel() == most)
        if lacking > 1:
            places = places[:: -(-len(places) // MOST_PLACES)]
        missed = _missed(volume, places, each=lacking > 1)
    if lacking == 1:
        return tuple(number for number, misses in missed.items() if misses.any())
    sets, counts = np.unique(np.array(list(missed.values())), axis=1, return_counts=True)
    together = sets[:, np.argmax(counts)]
    return tuple(number for number, misses in zip(missed, together, strict=True) if misses)


def _missed(
    volume: VoteCounts, places: NDArray[np.int64], *, each: bool
) -> dict[int, NDArray[np.bool_]]:
    """Return for each voting view which of the voxels it misses, or just whether it misses any."""
    own = np.zeros(volume.grid.shape, dtype=np.uint8)
    missed = {}
    for number, voter in volume.voters.items():
        if not voter.votes:
            continue
        cast(own, [voter.pulled_back(1)], [voter.axis])
        misses = own.ravel()[places] == 0
        missed[number] = misses if each else misses.any(keepdims=True)
        cast(own, [voter.pulled_back(-1)], [voter.axis])
    return missed
