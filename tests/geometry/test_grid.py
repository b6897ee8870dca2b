import numpy as np
import pytest

from core.geometry.grid import VoxelGrid


def test_a_cube_is_centred_on_the_origin():
    grid = VoxelGrid.cube(side_m=4.0, spacing_m=0.5)
    assert grid.shape == (8, 8, 8)
    assert grid.origin_m + grid.upper_m == pytest.approx(np.zeros(3))
    assert grid.centres_m()[1, 2, 3] == pytest.approx(grid.origin_m + 0.5 * np.array([1, 2, 3]))


def test_a_grid_over_a_box_reaches_both_ends():
    grid = VoxelGrid.over(
        lower_m=np.array([-1.0, 0.0, 2.0]), upper_m=np.array([1.0, 0.35, 4.0]), spacing_m=0.1
    )
    assert np.all(grid.upper_m >= np.array([1.0, 0.35, 4.0]) - 1e-9)
    assert grid.shape == (21, 5, 21)


def test_indices_map_to_metres():
    grid = VoxelGrid.cube(side_m=4.0, spacing_m=0.5)
    place = grid.index_to_target() @ np.array([1, 2, 3, 1.0])
    assert place[:3] == pytest.approx(grid.centres_m()[1, 2, 3])


@pytest.mark.parametrize(
    ("side_m", "spacing_m", "message"),
    [
        (0.0, 0.1, "must be positive metres"),
        (1.0, float("nan"), "must be positive metres"),
        (1000.0, 0.1, "one byte each would need 931 GiB"),
    ],
)
def test_impossible_grids_are_refused(side_m, spacing_m, message):
    with pytest.raises(ValueError, match=message):
        VoxelGrid.cube(side_m=side_m, spacing_m=spacing_m)
