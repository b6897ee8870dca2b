import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from core.hull.polygon_test import votes_of
from core.hull.votes import VoteVolume
from tests.laws.outlines import LATTICE, lattice_views


def reference(view, grid):
    points = view.projection.image_points(grid.centres_m())
    # Holes cut from triangles leave vertices at thirds, which only rounding takes off a line.
    flat = votes_of(points.reshape(-1, 2), view.silhouette.rings, on_px=1e-9)
    return flat.reshape(grid.shape)


@settings(max_examples=300, deadline=None)
@given(view=lattice_views())
def test_votes_equal_the_papers_test_in_every_corner(view):
    volume = VoteVolume(LATTICE)
    volume.add(view)
    assert np.array_equal(volume.votes, reference(view, LATTICE))


@settings(max_examples=60, deadline=None)
@given(views=st.lists(lattice_views(), min_size=2, max_size=5))
def test_many_views_at_once_vote_like_each_alone(views):
    together = VoteVolume(LATTICE)
    together.add_many(views)
    assert np.array_equal(together.votes, sum(reference(v, LATTICE).astype(int) for v in views))
