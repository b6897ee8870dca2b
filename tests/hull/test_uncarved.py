from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.geometry.grid import VoxelGrid
from core.hull.surface import mask_surface
from core.hull.uncarved import MOST_VOXELS, few, uncarved_surface
from core.hull.volume import VoteVolume
from tests.hull.test_mesher import box_view
from tests.hull.test_votes import random_view

GRID = VoxelGrid.cube(side_m=12.0, spacing_m=0.5)


def obvious_region(volume, misses):
    """Voxel by voxel: votes enough for more misses, and no voxel of the hull beside it."""
    threshold = volume.checked_threshold(volume.threshold)
    least = max(1, threshold - misses)
    region = np.zeros(volume.grid.shape, dtype=bool)
    for place in product(*map(range, region.shape)):
        if volume.votes[place] < least:
            continue
        around = tuple(slice(max(0, index - 1), index + 2) for index in place)
        region[place] = volume.votes[around].max() < threshold
    return region


@settings(max_examples=8)
@given(seeds=st.lists(st.integers(0, 2**32 - 1), min_size=2, max_size=5), data=st.data())
def test_it_is_what_more_misses_would_add_a_voxel_away_from_the_hull(seeds, data):
    volume = VoteVolume(GRID)
    volume.add_many([random_view(seed) for seed in seeds])
    volume.threshold = data.draw(st.integers(1, len(seeds)))
    misses = data.draw(st.integers(0, len(seeds)))
    surface = uncarved_surface(volume, misses)
    expected = mask_surface(obvious_region(volume, misses), GRID)
    np.testing.assert_array_equal(surface.vertices_m, expected.vertices_m)
    np.testing.assert_array_equal(surface.faces, expected.faces)


def test_nothing_is_uncarved_without_views_or_where_all_of_them_agree():
    volume = VoteVolume(GRID)
    assert uncarved_surface(volume).is_empty
    volume.add(box_view(0))
    assert uncarved_surface(volume).is_empty


@pytest.mark.parametrize(("voting", "count"), [(1, 1), (9, 1), (20, 2), (60, 6)])
def test_few_are_a_tenth_but_at_least_one(voting, count):
    assert few(voting) == count


def test_a_fine_grid_is_looked_at_coarsely_and_in_the_same_place():
    surfaces = []
    for count in (MOST_VOXELS, 2 * MOST_VOXELS):
        volume = VoteVolume(VoxelGrid.cube(side_m=12.0, spacing_m=12.0 / count))
        volume.add_many([random_view(seed) for seed in range(3)])
        surfaces.append(uncarved_surface(volume))
    coarse, fine = (surface.vertices_m for surface in surfaces)
    np.testing.assert_allclose(coarse.min(axis=0), fine.min(axis=0), atol=0.2)
    np.testing.assert_allclose(coarse.max(axis=0), fine.max(axis=0), atol=0.2)
    assert 0 < len(fine) < 2 * len(coarse)
