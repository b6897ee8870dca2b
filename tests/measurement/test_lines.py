import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from core.geometry.grid import VoxelGrid
from core.hull.surface import mask_surface
from core.measurement.lines import angle_between_lines_rad, principal_lines
from core.targets import tiangong_like

NAMES = ("span", "length", "diameter")


def test_principal_lines_of_the_true_body_are_its_features():
    target = tiangong_like()
    grid = VoxelGrid.cube(side_m=20.0, spacing_m=0.1)
    surface = mask_surface(target.voxels(grid), grid)
    for line, feature in zip(principal_lines(surface, NAMES), target.features, strict=True):
        assert line.name == feature.name
        assert line.length_m == pytest.approx(feature.length_m, abs=0.15)
        angle = angle_between_lines_rad(line.direction, feature.direction)
        assert np.rad2deg(angle) < 1.5


def test_lines_turn_with_the_body():
    grid = VoxelGrid.cube(side_m=8.0, spacing_m=0.1)
    turn = Rotation.from_rotvec([0.3, -0.5, 0.4])
    local = turn.inv().apply(grid.centres_m().reshape(-1, 3)).reshape(*grid.shape, 3)
    surface = mask_surface(np.all(np.abs(local) < [3.0, 1.5, 0.8], axis=-1), grid)
    for axis, line in enumerate(principal_lines(surface, ("a", "b", "c"))):
        true_direction = turn.as_matrix()[:, axis]
        assert np.rad2deg(angle_between_lines_rad(line.direction, true_direction)) < 1
        assert line.length_m == pytest.approx([6.0, 3.0, 1.6][axis], abs=0.2)


def test_angles_between_lines_have_no_sign():
    x = np.array([1.0, 0, 0])
    assert angle_between_lines_rad(x, -x) == 0
    assert angle_between_lines_rad(x, np.array([0, 2.0, 0])) == pytest.approx(np.pi / 2)
