import numpy as np
import pytest

from core.benchmarks.peers import PEERS, Peer
from core.benchmarks.reference import reference_votes
from core.benchmarks.workload import satellite_task

# How many of the voxels may differ on this coarse grid: masks and fixed points round outlines.
MOST_WRONG_VOTES = {
    "Octave inpolygon": 1e-9,
    "matplotlib Path": 1e-9,
    "shapely": 1e-9,
    "OpenCV fillPoly": 0.35,
}
MASK_BOUND = 0.03


@pytest.mark.parametrize("peer", PEERS, ids=[peer.name for peer in PEERS])
def test_a_peers_votes_are_within_its_bound(peer: Peer) -> None:
    if peer.version is None:
        pytest.skip(f"{peer.name} is not installed")
    task = satellite_task(40, 12, masks=True)
    planes = task.all_planes()[:: 1 if peer.whole_only else 8]
    found = peer.function()(task, planes)
    reference = reference_votes(task, planes)
    assert found.shape == reference.shape
    if peer.hull_only:
        # It keeps a cell while any corner is seen, so it keeps the hull and more.
        hull = reference == len(task.views)
        assert np.count_nonzero(hull & (found == 0)) <= 0.02 * np.count_nonzero(hull)
        return
    assert np.mean(found != reference) <= MOST_WRONG_VOTES.get(peer.name, MASK_BOUND)
