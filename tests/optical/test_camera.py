import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.geometry.projection import range_doppler_projection
from core.optical.camera import (
    affine_camera,
    camera_axes,
    perpendicular_partner,
    perspective_camera,
)

seeds = st.integers(0, 2**32 - 1)
rolls = st.floats(-7, 7)


def directions(seed):
    """Return a line of sight and a cross-range across it."""
    random = np.random.default_rng(seed)
    ahead, across = np.linalg.qr(random.normal(size=(3, 2)))[0].T
    return ahead, across


@given(seed=seeds, roll=rolls)
def test_axes_are_a_rotation_that_looks_ahead(seed, roll):
    ahead, across = directions(seed)
    axes = camera_axes(ahead, across, roll_rad=roll)
    assert axes @ axes.T == pytest.approx(np.eye(3), abs=1e-12)
    assert np.linalg.det(axes) == pytest.approx(1)
    assert axes[2] == pytest.approx(ahead)
    assert axes[0] @ across == pytest.approx(np.cos(roll), abs=1e-12)


@given(seed=seeds)
def test_the_partners_axes_are_the_papers(seed):
    """Columns are the radar's own; rows are the direction that the radar image cannot see."""
    ahead, across = directions(seed)
    radar = range_doppler_projection(
        line_of_sight=ahead,
        line_of_sight_rate_per_s=0.01 * across,
        row_spacing_m=0.06,
        column_spacing_m=0.05,
        shape=(64, 48),
    )
    partner = perpendicular_partner(
        line_of_sight=ahead, cross_range=across, pixel_m=0.05, shape=(64, 48)
    )
    assert partner.matrix[1] == pytest.approx(radar.matrix[1])
    assert partner.matrix[0, :3] == pytest.approx(np.cross(ahead, across) / 0.05)
    assert abs(radar.viewing_direction() @ partner.matrix[0, :3]) == pytest.approx(1 / 0.05)


@given(seed=seeds, roll=rolls)
def test_a_roll_turns_the_picture_and_moves_no_point_along_the_line_of_sight(seed, roll):
    ahead, across = directions(seed)
    size = {"pixel_m": 0.1, "shape": (100, 100)}
    level, rolled = (
        perpendicular_partner(line_of_sight=ahead, cross_range=across, roll_rad=angle, **size)
        for angle in (0.0, roll)
    )
    points = np.random.default_rng(seed).normal(size=(5, 3))
    row, column = (level.image_points(points) - 50).T
    cosine, sine = np.cos(roll), np.sin(roll)
    turned = np.stack([cosine * row - sine * column, cosine * column + sine * row], axis=1)
    assert rolled.image_points(points) - 50 == pytest.approx(turned, abs=1e-9)
    assert rolled.image_points(points + 3 * ahead) == pytest.approx(rolled.image_points(points))


@pytest.mark.parametrize("range_m", [None, 400e3])
def test_the_picture_is_not_mirrored(range_m):
    """An observer south of a target, looking north with east to the right, has up above."""
    north, east, up = np.eye(3)[[1, 0, 2]]
    camera = perpendicular_partner(
        line_of_sight=north, cross_range=east, pixel_m=0.1, shape=(200, 200), range_m=range_m
    )
    letter = np.array([[0.0, 0, 2], [0, 0, -2], [1, 0, -2]])  # an L: stem from top, foot to east
    top, corner, foot = camera.image_points(letter)
    assert top == pytest.approx([80, 100], abs=1e-3)
    assert corner == pytest.approx([120, 100], abs=1e-3)
    assert foot == pytest.approx([120, 110], abs=1e-3)
    assert up @ camera.matrix[0, :3] < 0


@given(seed=seeds, roll=rolls)
def test_far_away_perspective_becomes_parallel(seed, roll):
    ahead, across = directions(seed)
    axes = camera_axes(ahead, across, roll_rad=roll)
    points = np.random.default_rng(seed).uniform(-10, 10, (8, 3))
    parallel = affine_camera(axes, pixel_m=0.05, shape=(512, 512))
    near, far = (
        perspective_camera(axes, range_m=range_m, pixel_m=0.05, shape=(512, 512))
        for range_m in (1e3, 1e6)
    )
    error_px = [
        np.abs(camera.image_points(points) - parallel.image_points(points)).max()
        for camera in (near, far)
    ]
    # A point 17 m off moves by 17 m / range of its distance from the centre.
    assert error_px[1] < 0.01
    assert error_px[0] < 10


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"cross_range": np.array([2.0, 0, 0])}, "lies along the line of sight"),
        ({"pixel_m": 0.0}, "pixel_m must be positive metres, got 0"),
        ({"range_m": -1.0}, "range_m must be positive metres"),
    ],
)
def test_an_impossible_partner_is_refused(change, says):
    wanted = {
        "line_of_sight": np.array([1.0, 0, 0]),
        "cross_range": np.array([0.0, 1, 0]),
        "pixel_m": 0.1,
        "shape": (64, 64),
    }
    with pytest.raises(ValueError, match=says):
        perpendicular_partner(**{**wanted, **change})


def test_a_mirror_is_no_camera():
    with pytest.raises(ValueError, match="det R is -1"):
        affine_camera(np.diag([1.0, 1, -1]), pixel_m=0.1, shape=(64, 64))
