import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from core.optical.camera import affine_camera, camera_projection
from core.optical.epipolar import (
    common_direction,
    cross_matrix,
    epipolar_matrix,
    epipolar_segment,
    essential_matrix,
    relative_pose,
)

seeds = st.integers(0, 2**32 - 1)
INTRINSICS = np.array([[2000.0, 0, 320], [0, 2000, 240], [0, 0, 1]])


def two_poses(seed):
    """Return two cameras' (R, t) some 30 m before the target, and points on it."""
    random = np.random.default_rng(seed)
    rotations = Rotation.random(2, rng=random).as_matrix()
    translations = np.array([0, 0, 30]) + random.uniform(-2, 2, (2, 3))
    return list(zip(rotations, translations, strict=True)), random.uniform(-5, 5, (20, 3))


def rays(pose, points):
    rotation, translation = pose
    seen = points @ rotation.T + translation
    return seen / seen[:, 2:]


@given(seed=seeds)
def test_every_point_meets_the_essential_relation(seed):
    (first, second), points = two_poses(seed)
    rotation, translation = relative_pose(first, second)
    essential = essential_matrix(rotation, translation)
    residual = np.einsum("ni,ij,nj->n", rays(second, points), essential, rays(first, points))
    assert np.abs(residual).max() < 1e-12 * np.abs(essential).max()
    seen_first = points @ first[0].T + first[1]
    assert seen_first @ rotation.T + translation == pytest.approx(points @ second[0].T + second[1])


@given(seed=seeds)
def test_another_point_misses_the_essential_relation(seed):
    (first, second), points = two_poses(seed)
    essential = essential_matrix(*relative_pose(first, second))
    wrong = np.einsum(
        "ni,ij,nj->n", rays(second, points), essential, rays(first, np.roll(points, 1, axis=0))
    )
    assert np.abs(wrong).max() > 1e-6 * np.abs(essential).max()


@given(seed=seeds)
def test_an_essential_matrix_has_two_equal_singular_values_and_a_zero(seed):
    (first, second), _ = two_poses(seed)
    rotation, translation = relative_pose(first, second)
    singular = np.linalg.svd(essential_matrix(rotation, translation), compute_uv=False)
    assert singular == pytest.approx(np.linalg.norm(translation) * np.array([1, 1, 0]))


@given(seed=seeds)
def test_opencv_finds_the_same_pose_in_the_matrix(seed):
    (first, second), _ = two_poses(seed)
    rotation, translation = relative_pose(first, second)
    one, other, direction = cv2.decomposeEssentialMat(essential_matrix(rotation, translation))
    assert min(np.abs(found - rotation).max() for found in (one, other)) < 1e-6
    unit = translation / np.linalg.norm(translation)
    assert abs(float(direction[:, 0] @ unit)) == pytest.approx(1)


@given(seed=seeds, is_affine=st.booleans())
def test_pixels_of_two_views_meet_the_epipolar_relation(seed, is_affine):
    poses, points = two_poses(seed)
    first, second = (
        affine_camera(rotation, pixel_m=0.05, shape=(480, 640))
        if is_affine
        else camera_projection(INTRINSICS, rotation, translation)
        for rotation, translation in poses
    )
    matrix = epipolar_matrix(first, second)
    assert np.linalg.norm(matrix) == pytest.approx(1)
    pixels = [
        np.column_stack([view.image_points(points), np.ones(len(points))])
        for view in (first, second)
    ]
    line = pixels[0] @ matrix.T
    distance_px = np.sum(line * pixels[1], axis=1) / np.linalg.norm(line[:, :2], axis=1)
    assert np.abs(distance_px).max() < 1e-6
    if is_affine:
        assert np.all(matrix[:2, :2] == 0)


@given(seed=seeds)
def test_two_parallel_views_agree_on_the_extent_along_their_common_direction(seed):
    """Each view alone gives u·X of every point, up to a constant of its own."""
    poses, points = two_poses(seed)
    views = [affine_camera(rotation, pixel_m=0.05, shape=(480, 640)) for rotation, _ in poses]
    along = common_direction(*views)
    for view in views:
        assert along @ view.viewing_direction() == pytest.approx(0, abs=1e-9)
        shown = view.plane_points(view.image_points(points)) @ along
        assert shown == pytest.approx(points @ along, abs=1e-9)


def test_views_that_do_not_constrain_each_other_are_refused():
    rotation, translation = np.eye(3), np.array([0.0, 0, 30])
    parallel = affine_camera(rotation, pixel_m=0.1, shape=(64, 64))
    perspective = camera_projection(INTRINSICS, rotation, translation)
    with pytest.raises(ValueError, match="look along the same line"):
        epipolar_matrix(parallel, parallel)
    with pytest.raises(ValueError, match="same place do not constrain"):
        epipolar_matrix(perspective, perspective)
    with pytest.raises(ValueError, match="not one of each"):
        epipolar_matrix(parallel, perspective)
    with pytest.raises(ValueError, match="same place have no essential matrix"):
        essential_matrix(rotation, np.zeros(3))
    with pytest.raises(ValueError, match="Only parallel views"):
        common_direction(parallel, perspective)


@given(seed=seeds)
def test_the_cross_matrix_is_the_cross_product(seed):
    one, other = np.random.default_rng(seed).normal(size=(2, 3))
    assert cross_matrix(one) @ other == pytest.approx(np.cross(one, other))


@given(seed=seeds, is_first_parallel=st.booleans(), is_second_parallel=st.booleans())
def test_the_second_view_sees_a_point_on_its_segment(seed, is_first_parallel, is_second_parallel):
    poses, points = two_poses(seed)
    first, second = (
        affine_camera(rotation, pixel_m=0.05, shape=(480, 640))
        if is_parallel
        else camera_projection(INTRINSICS, rotation, translation)
        for (rotation, translation), is_parallel in zip(
            poses, (is_first_parallel, is_second_parallel), strict=True
        )
    )
    for point in points:
        seen = first.image_points(point)
        start, end = epipolar_segment(first, second, seen, reach_m=12.0)
        step, off = end - start, second.image_points(point) - start
        across = (off[0] * step[1] - off[1] * step[0]) / np.linalg.norm(step)
        assert across == pytest.approx(0.0, abs=1e-5)
        assert 0 <= off @ step <= step @ step
        if is_first_parallel == is_second_parallel:
            line = epipolar_matrix(first, second) @ [*seen, 1.0]
            assert np.array([[*start, 1.0], [*end, 1.0]]) @ line == pytest.approx(0.0, abs=1e-6)


@given(seed=seeds)
def test_a_segment_ends_where_the_target_may_end(seed):
    poses, points = two_poses(seed)
    views = [affine_camera(rotation, pixel_m=0.05, shape=(480, 640)) for rotation, _ in poses]
    seen = views[0].image_points(points[0])
    ends = epipolar_segment(*views, seen, reach_m=12.0)
    sine = np.linalg.norm(np.cross(*(view.viewing_direction() for view in views)))
    aside_m = np.linalg.norm(views[0].plane_points(seen))
    half_m = 0.5 * 0.05 * np.linalg.norm(ends[1] - ends[0]) / sine
    assert np.hypot(half_m, aside_m) == pytest.approx(12.0, rel=1e-6)
    assert epipolar_segment(*views, seen, reach_m=0.99 * aside_m) is None


def test_a_line_of_sight_partly_behind_the_second_camera_has_no_segment():
    ahead = camera_projection(INTRINSICS, np.eye(3), np.array([0.0, 0.0, 5.0]))
    side = affine_camera(np.eye(3)[[2, 1, 0]] * [[1], [-1], [1]], pixel_m=0.05, shape=(480, 640))
    seen = side.image_points(np.array([0.0, 0.0, -3.0]))
    assert epipolar_segment(side, ahead, seen, reach_m=12.0) is not None
    behind = side.image_points(np.array([0.0, 0.0, -6.0]))
    assert epipolar_segment(side, ahead, behind, reach_m=12.0) is None
