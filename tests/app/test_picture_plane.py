from dataclasses import dataclass, replace

import numpy as np
import pytest
from viser.transforms import SO3

from app.camera import HOME_DIRECTION
from app.picture_plane import picture_plane
from core.frame import Frame
from core.geometry.grid import VoxelGrid
from core.geometry.projection import Projection
from core.hull.surface import Surface, mask_surface
from core.silhouettes.extraction import extract_silhouette
from core.silhouettes.silhouette import Silhouette
from tests.app.synthetic import SPACING_M, frames


@dataclass(frozen=True)
class Drawn:
    frame: Frame
    silhouette: Silhouette


@pytest.fixture
def drawn() -> Drawn:
    frame = next(frames(1))
    return Drawn(frame, extract_silhouette(frame))


def plane_of(drawn, side_m, hull):
    return picture_plane(
        drawn.frame, drawn.silhouette, side_m, hull, camera_direction=HOME_DIRECTION
    )


def ball(radius_m: float) -> Surface:
    grid = VoxelGrid.cube(side_m=24.0, spacing_m=0.5)
    return mask_surface(np.linalg.norm(grid.centres_m(), axis=-1) < radius_m, grid)


def test_picture_lies_in_the_imaging_plane_with_its_pixels_where_they_image(drawn) -> None:
    plane = plane_of(drawn, 20.0, None)
    image_points = drawn.frame.projection.image_points
    at_centre = image_points(plane.centre_m)
    middle = [0.5 * (cut.start + cut.stop - 1) for cut in (plane.rows, plane.columns)]
    np.testing.assert_allclose(at_centre, middle, atol=1e-9)
    right = image_points(plane.centre_m + plane.right * SPACING_M)
    down = image_points(plane.centre_m + plane.down * SPACING_M)
    np.testing.assert_allclose(right - at_centre, [0, 1], atol=1e-9)
    np.testing.assert_allclose(down - at_centre, [1, 0], atol=1e-9)
    np.testing.assert_allclose(plane.down, drawn.frame.line_of_sight, atol=1e-9)


def test_picture_holds_the_silhouette_and_a_margin(drawn) -> None:
    plane = plane_of(drawn, 20.0, None)
    seen = np.concatenate(drawn.silhouette.rings)
    for cut, places in zip((plane.rows, plane.columns), seen.T, strict=True):
        assert places.min() - cut.start == pytest.approx(1.5 / SPACING_M, abs=1)
        assert cut.stop - 1 - places.max() == pytest.approx(1.5 / SPACING_M, abs=1)


def test_picture_without_a_silhouette_is_cut_to_the_window(drawn) -> None:
    nothing = replace(drawn, silhouette=replace(drawn.silhouette, rings=()))
    plane = plane_of(nothing, 20.0, None)
    assert plane.width_m == pytest.approx(20.0, abs=2 * SPACING_M)
    assert plane.height_m == pytest.approx(20.0, abs=2 * SPACING_M)
    whole = plane_of(nothing, 100.0, None)
    assert (whole.rows, whole.columns) == (slice(0, 160), slice(0, 160))


def test_rotation_carries_right_and_down_and_mirrors_nothing(drawn) -> None:
    plane = plane_of(drawn, 20.0, None)
    matrix = SO3(plane.quaternion_wxyz()).as_matrix()
    np.testing.assert_allclose(matrix[:, 0], plane.right, atol=1e-9)
    np.testing.assert_allclose(matrix[:, 1], plane.down, atol=1e-9)
    assert np.linalg.det(matrix) == pytest.approx(1)


def test_picture_stands_behind_a_bounded_hull_and_before_an_open_one(drawn) -> None:
    behind = plane_of(drawn, 24.0, ball(4.0)).aside_m
    assert behind @ HOME_DIRECTION < 0
    assert 4.0 < np.linalg.norm(behind) < 6.0
    before = plane_of(drawn, 24.0, ball(30.0)).aside_m
    assert before @ HOME_DIRECTION > 0


def test_a_perspective_image_has_no_plane(drawn) -> None:
    camera = Projection(matrix=np.eye(3, 4) + np.array([[0], [0], [1]]) * [0, 0, 0, 50])
    seen_so = replace(drawn, frame=replace(drawn.frame, projection=camera))
    assert plane_of(seen_so, 24.0, None) is None
