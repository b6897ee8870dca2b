import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from core.geometry.grid import VoxelGrid
from core.geometry.projection import Projection
from core.hull.polygon_test import votes_of
from core.hull.view import View
from core.hull.volume import VoteVolume
from tests.laws.outlines import LATTICE, lattice_views, silhouette


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


@settings(max_examples=40, deadline=None)
@given(views=st.lists(lattice_views(), min_size=1, max_size=3))
def test_a_view_of_everything_changes_nothing(views):
    volume = VoteVolume(LATTICE)
    volume.add_many(views)
    before = volume.hull()
    everything = 100.0 * np.array([[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]])
    volume.add(View(silhouette=silhouette([everything]), projection=views[0].projection))
    assert np.array_equal(volume.hull(), before)


@settings(max_examples=60, deadline=None)
@given(view=lattice_views(), axes=st.permutations(range(3)), mirrored=st.booleans())
def test_turned_and_mirrored_grids_agree(view, axes, mirrored):
    """The same scene with its axes exchanged, and x turned around, has the same votes so."""
    sign = np.array([-1.0 if mirrored else 1.0, 1.0, 1.0])
    matrix = view.projection.matrix.copy()
    matrix[:, :3] = (matrix[:, :3] * sign)[:, axes]
    upper = LATTICE.upper_m
    origin = np.array([-upper[0], *LATTICE.origin_m[1:]]) if mirrored else LATTICE.origin_m
    turned = VoxelGrid(
        origin_m=origin[list(axes)],
        spacing_m=LATTICE.spacing_m,
        shape=tuple(LATTICE.shape[axis] for axis in axes),
    )
    plain, other = VoteVolume(LATTICE), VoteVolume(turned)
    plain.add(view)
    other.add(View(silhouette=view.silhouette, projection=Projection(matrix=matrix)))
    expected = plain.votes[::-1] if mirrored else plain.votes
    assert np.array_equal(other.votes, expected.transpose(axes))
