import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from core.geometry.grid import VoxelGrid
from core.hull.emptying import emptied_by
from core.hull.view import View
from core.hull.volume import VoteVolume
from core.silhouettes.silhouette import Silhouette
from tests.hull.test_votes import random_view

GRID = VoxelGrid.cube(side_m=9.0, spacing_m=0.6)


def aside(view, columns):
    """Move an outline far along the columns of its image."""
    rings = tuple(ring + np.array([0.0, columns]) for ring in view.silhouette.rings)
    silhouette = Silhouette(rings=rings, image_shape=(512, 512), claim="complete")
    return View(silhouette=silhouette, projection=view.projection)


def volume_of(seed, count, spoilt, misses):
    views = [random_view(seed + i) for i in range(count)]
    for number in spoilt:
        views[number] = aside(views[number], 300.0)
    volume = VoteVolume(GRID)
    volume.add_many(views)
    volume.threshold = max(1, count - misses)
    return volume


def leaves_a_hull_without(volume, numbers, misses):
    fresh = VoteVolume(GRID)
    rest = [v.view for n, v in volume.voters.items() if v.votes and n not in numbers]
    fresh.add_many(rest)
    return bool(fresh.hull(max(1, len(rest) - misses)).any())


@settings(max_examples=40, deadline=None)
@given(
    seed=st.integers(0, 2**31),
    spoilt=st.sets(st.integers(0, 5), max_size=3),
    misses=st.integers(0, 1),
)
def test_the_views_named_are_those_without_which_there_is_a_hull(seed, spoilt, misses):
    volume = volume_of(seed, 6, spoilt, misses)
    named = emptied_by(volume)
    if volume.hull().any():
        assert named == ()
        return
    alone = tuple(n for n in range(6) if leaves_a_hull_without(volume, {n}, misses))
    if alone:
        assert named == alone
    else:
        assert leaves_a_hull_without(volume, set(named), misses)


def test_nothing_emptied_a_hull_of_no_views():
    volume = VoteVolume(GRID)
    assert emptied_by(volume) == ()
    volume.add(random_view(1))
    volume.exclude(0)
    assert emptied_by(volume) == ()
    assert not np.any(volume.votes)
