import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.camera import FAR_FIELD_OF_VIEW_RAD, HOME_DIRECTION, VIEWS, Camera
from tests.app.synthetic import frames

FRAME = next(frames(1))
SIDE_M = 24.0
FAR = [name for name in VIEWS if name != "home"]
FULL = {"position_m": np.zeros(3), "look_at_m": np.ones(3), "up": np.eye(3)[0]}


def seen(camera: Camera, points_m: np.ndarray, aspect: float = 1.0) -> np.ndarray:
    """Where points lie in the picture: right and down, ±1 at its upper and lower edge."""
    forward = (camera.look_at_m - camera.position_m) / camera.distance_m
    right = np.cross(forward, camera.up)
    right /= np.linalg.norm(right)
    away = points_m - camera.position_m
    depth = away @ forward * np.tan(0.5 * camera.field_of_view_rad)
    down = np.cross(forward, right)
    return np.stack([away @ right / depth / aspect, away @ down / depth], axis=-1)


@pytest.mark.parametrize("name", FAR)
@given(aspect=st.floats(0.3, 3.0))
def test_far_views_hold_the_window_with_hardly_any_perspective(name: str, aspect: float) -> None:
    camera = VIEWS[name].camera(SIDE_M, aspect, FRAME)
    half = 0.5 * SIDE_M
    points = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * half
    if name[0] in "+-":
        assert np.abs(seen(camera, points, aspect)).max() < 1
    assert SIDE_M / camera.distance_m < 0.0121
    assert camera.field_of_view_rad == FAR_FIELD_OF_VIEW_RAD
    assert camera.near_m < camera.distance_m - SIDE_M < camera.distance_m + SIDE_M < camera.far_m


@pytest.mark.parametrize(
    ("name", "right", "up"),
    [
        ("+x", [0, -1, 0], [0, 0, -1]),
        ("-x", [0, 1, 0], [0, 0, -1]),
        ("+y", [1, 0, 0], [0, 0, -1]),
        ("-y", [-1, 0, 0], [0, 0, -1]),
        ("+z", [0, -1, 0], [1, 0, 0]),
        ("-z", [0, 1, 0], [1, 0, 0]),
    ],
)
def test_axis_views_are_upright(name: str, right: list[int], up: list[int]) -> None:
    camera = VIEWS[name].camera(SIDE_M, 1.0, None)
    assert camera.position_m @ np.eye(3)["xyz".index(name[1])] * float(f"{name[0]}1") > 0
    places = seen(camera, np.array([right, up], dtype=float))
    assert places[0][0] > 0
    assert abs(places[0][1]) < 1e-3 * places[0][0]
    assert places[1][1] < 0
    assert abs(places[1][0]) < 1e-3 * -places[1][1]


@pytest.mark.parametrize("frame", list(frames(6)))
def test_onto_the_plane_the_target_is_seen_as_the_frame_is_drawn(frame) -> None:
    camera = VIEWS["plane"].camera(SIDE_M, 1.0, frame)
    points = np.random.default_rng(3).uniform(-8, 8, (40, 3))
    row, column = frame.projection.image_points(points).T
    right, down = seen(camera, points).T
    assert np.corrcoef(right, column)[0, 1] > 0.9999
    assert np.corrcoef(down, row)[0, 1] > 0.9999


def test_along_the_sight_range_is_depth_and_columns_go_right() -> None:
    camera = VIEWS["sight"].camera(SIDE_M, 1.0, FRAME)
    forward = (camera.look_at_m - camera.position_m) / camera.distance_m
    np.testing.assert_allclose(forward, FRAME.line_of_sight, atol=1e-12)
    points = np.random.default_rng(3).uniform(-8, 8, (40, 3))
    column = FRAME.projection.image_points(points)[:, 1]
    assert np.corrcoef(seen(camera, points)[:, 0], column)[0, 1] > 0.9999


def test_home_is_where_a_page_begins() -> None:
    camera = VIEWS["home"].camera(SIDE_M, 0.5, None)
    np.testing.assert_allclose(np.cross(camera.position_m, HOME_DIRECTION), 0, atol=1e-9)
    assert np.degrees(camera.field_of_view_rad) == pytest.approx(36)


@pytest.mark.parametrize("name", ["sight", "plane"])
def test_before_the_first_frame_there_is_nothing_to_look_along(name: str) -> None:
    with pytest.raises(ValueError, match="No frame has arrived yet"):
        VIEWS[name].camera(SIDE_M, 1.0, None)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"field_of_view_rad": 3.2}, "between 0.1° and 150°; got 183"),
        ({"up": np.ones(3)}, "not along its up direction"),
        ({"look_at_m": np.zeros(3)}, "must look somewhere"),
        ({"position_m": np.full(3, 1e8)}, "stands within 1e.07 m"),
        ({"up": np.full(3, np.nan)}, "camera's up"),
    ],
)
def test_cameras_that_see_nothing_are_refused(changes: dict, sentence: str) -> None:
    with pytest.raises(ValueError, match=sentence):
        Camera(**{**FULL, "field_of_view_rad": 0.5, **changes})
