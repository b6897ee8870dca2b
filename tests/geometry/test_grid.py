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
        (1000.0, 0.1, "one byte each would need 932 GiB"),
        (1e6, 0.2, "would need .* GiB; at most 68,719,476,736 can be"),  # wraps in 64 bits
        (1e300, 1.0, "one byte each would need .* GiB"),
        (1e300, 1e-300, "more voxels than any memory"),
    ],
)
def test_impossible_grids_are_refused(side_m, spacing_m, message):
    with pytest.raises(ValueError, match=message):
        VoxelGrid.cube(side_m=side_m, spacing_m=spacing_m)


@pytest.mark.parametrize(
    ("lower_m", "upper_m", "spacing_m", "message"),
    [
        ([0, 0, 0], [1, 1, 1], 0.0, "positive length in metres, got 0.0"),
        ([0, 0, 0], [1, 1, 1], -1.0, "positive length in metres, got -1.0"),
        ([0, 0, np.nan], [1, 1, 1], 0.1, "lower corner: 1 of 3 values are NaN"),
        ([0, 0, 0], [1, np.inf, 1], 0.1, "upper corner: 1 of 3 values are NaN or infinite"),
        ([0, 0, 0], [1, 1, -1], 0.1, "must not lie below"),
        ([0, 0, 0], [1e4, 1e4, 1e4], 1e-3, "one byte each would need .* GiB"),
        ([0, 0, 0], [1, 1, 1e300], 1e-300, "more voxels than any memory"),
    ],
)
def test_impossible_boxes_are_refused(lower_m, upper_m, spacing_m, message):
    with pytest.raises(ValueError, match=message):
        VoxelGrid.over(
            lower_m=np.array(lower_m, float), upper_m=np.array(upper_m, float), spacing_m=spacing_m
        )


@pytest.mark.parametrize("shape", [(0, 4, 4), (4, 1, 4), (4, 4, -2), (4, 4)])
def test_a_grid_without_voxels_is_refused(shape):
    with pytest.raises(ValueError, match="at least 2 voxels along each of 3 axes, got"):
        VoxelGrid(origin_m=np.zeros(3), spacing_m=1.0, shape=shape)
