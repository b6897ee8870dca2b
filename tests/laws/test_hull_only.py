"""A hull carved without stored votes is the hull of the stored ones, number by number."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from core.geometry.grid import VoxelGrid
from core.hull.hull_only import carved_surface
from core.hull.surface import hull_surface
from core.hull.volume import VoteVolume
from tests.hull.test_votes import random_view
from tests.laws.cameras import camera_like
from tests.laws.outlines import LATTICE, lattice_views

GRID = VoxelGrid.over(
    lower_m=np.array([-5.0, -4.0, -3.0]), upper_m=np.array([5.0, 4.5, 4.0]), spacing_m=0.25
)


def assert_same_surface(views, grid, below):
    threshold = max(1, len(views) - below)
    volume = VoteVolume(grid)
    volume.add_many(views)
    wanted, found = hull_surface(volume, threshold), carved_surface(views, grid, threshold)
    assert np.array_equal(found.vertices_m, wanted.vertices_m)
    assert np.array_equal(found.faces, wanted.faces)


@settings(max_examples=60, deadline=None)
@given(views=st.lists(lattice_views(), min_size=1, max_size=5), below=st.integers(0, 4))
def test_in_every_corner(views, below):
    assert_same_surface(views, LATTICE, below)


@settings(max_examples=30, deadline=None)
@given(
    seed=st.integers(0, 2**31),
    kinds=st.lists(st.booleans(), min_size=2, max_size=6),
    below=st.integers(0, 3),
)
def test_affine_and_perspective_views_from_anywhere(seed, kinds, below):
    views = [random_view(seed + number) for number in range(len(kinds))]
    mixed = [
        camera_like(view, 14.0) if is_perspective else view
        for view, is_perspective in zip(views, kinds, strict=True)
    ]
    assert_same_surface(mixed, GRID, below)
