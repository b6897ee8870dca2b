import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.experiments.voting_rules import extent_along_m, least_votes
from core.geometry.grid import VoxelGrid


@given(st.floats(0.01, 1.0), st.integers(1, 300))
def test_least_votes_are_the_first_that_reach_the_share(share, views):
    wanted = least_votes(share, views)
    assert 1 <= wanted <= views
    assert wanted >= share * views - 1e-6
    assert wanted == 1 or wanted - 1 < share * views


def test_voxels_reach_from_outer_face_to_outer_face():
    grid = VoxelGrid.cube(side_m=4.0, spacing_m=0.5)
    inside = np.zeros(grid.shape, dtype=bool)
    assert extent_along_m(inside, grid, np.array([1.0, 0, 0])) == 0
    inside[1:5, 2, 3] = True
    assert extent_along_m(inside, grid, np.array([1.0, 0, 0])) == pytest.approx(2.0)
    assert extent_along_m(inside, grid, np.array([0, 1.0, 0])) == pytest.approx(0.5)
