import threading

import numpy as np
import pytest

from core.hull.casting import Cancelled, Watch
from core.hull.surface import hull_surface
from core.hull.volume import VoteVolume
from tests.hull.test_mesher import GRID, HALF_M, box_view, box_volume


def test_the_surface_follows_every_change():
    volume, numbers = box_volume()
    for change in (
        lambda: None,
        lambda: volume.replace(numbers[1], box_view(1, [1.2, 1.41, 0.77])),
        lambda: volume.exclude(numbers[2]),
        lambda: volume.include(numbers[2]),
        lambda: setattr(volume, "threshold", 2),
        lambda: volume.remove(numbers[0]),
    ):
        change()
        expected = hull_surface(volume)
        assert np.array_equal(volume.surface().vertices_m, expected.vertices_m)
        assert np.array_equal(volume.surface().faces, expected.faces)


def test_a_hull_reprojects_into_its_silhouette():
    volume, numbers = box_volume()
    mask = volume.reprojection(numbers[1])
    drawn = box_view(1).silhouette.mask()
    assert not np.any(mask & ~drawn)
    assert mask.sum() > 0.95 * drawn.sum()


def test_blame_is_the_volume_that_one_view_alone_removes():
    volume, numbers = box_volume()
    volume.replace(numbers[2], box_view(2, [1.0, *HALF_M[1:]]))
    kept = VoteVolume(GRID)
    kept.add_many([box_view(0), box_view(1)])
    removed_m3 = (kept.hull().sum() - volume.hull().sum()) * GRID.spacing_m**3
    assert volume.blame()[numbers[2]] == pytest.approx(removed_m3)


def test_an_unknown_view_is_named():
    volume, _ = box_volume()
    with pytest.raises(ValueError, match="no view number 7 in this volume; it has 0, 1, 2"):
        volume.reprojection(7)


def test_readers_see_whole_changes_while_one_writes():
    """Views 0 and 1 are replaced in turn; every surface belongs to a state between two changes."""
    volume, numbers = box_volume()
    halves = [HALF_M, np.array([1.2, 1.41, 0.77])]
    seen, stop = [], threading.Event()

    def read():
        while not stop.is_set():
            seen.append(float(volume.surface().vertices_m[:, 0].max()))

    readers = [threading.Thread(target=read) for _ in range(2)]
    for reader in readers:
        reader.start()
    for turn in range(40):
        volume.replace(numbers[1], box_view(1, halves[turn % 2]))
    stop.set()
    for reader in readers:
        reader.join()
    assert len(seen) > 2
    allowed = np.array([half[0] for half in halves])
    assert np.abs(np.array(seen)[:, None] - allowed).min(axis=1).max() < 1e-6


def test_a_cancelled_vote_leaves_the_volume_as_it_was():
    volume, _ = box_volume()
    votes, surface, revision = volume.votes.copy(), volume.surface(), volume.revision
    asked = iter([False, False, True])
    with pytest.raises(Cancelled, match="taken back"):
        volume.add_many([box_view(0, HALF_M / 2)], Watch(cancel=lambda: next(asked, True)))
    assert np.array_equal(volume.votes, votes)
    assert volume.revision == revision
    assert np.array_equal(volume.surface().vertices_m, surface.vertices_m)


def test_a_vote_tells_its_progress():
    told = []
    volume = VoteVolume(GRID)
    volume.add_many(
        [box_view(axis) for axis in range(3)], Watch(progress=lambda *d: told.append(d))
    )
    assert told[-1][0] == told[-1][1] > 0
