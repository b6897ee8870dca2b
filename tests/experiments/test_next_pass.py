import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from core.experiments.next_pass import (
    SUPPORT,
    Aspect,
    ball_hull_volume,
    carved_voxels,
    compact_body,
    hull_points_m,
)
from core.geometry.grid import VoxelGrid
from core.geometry.projection import Projection
from core.hull.view import View
from core.measurement.observability import observability
from core.silhouettes.silhouette import Silhouette

SPACING_M = 0.5


def aspects(count, seed):
    turns = Rotation.random(count, rng=np.random.default_rng(seed)).as_matrix()
    return [Aspect(line_of_sight=turn[0], cross_range=turn[1]) for turn in turns]


def some_hull(seed):
    random = np.random.default_rng(seed)
    inside = random.random((9, 8, 7)) < 0.6
    grid = VoxelGrid(origin_m=np.array([-2.0, -2.0, -1.5]), spacing_m=SPACING_M, shape=(9, 8, 7))
    return hull_points_m(inside, grid), random


def slowly_carved(points_m, body, views):
    """The shadow rule voxel by voxel."""
    carved = np.zeros(len(points_m), dtype=bool)
    for view in views:
        cells = np.floor(points_m @ view.cross_range / SPACING_M)
        ranges = points_m @ view.line_of_sight
        for number in range(len(points_m)):
            same = [ranges[n] for n in np.flatnonzero(body) if cells[n] == cells[number]]
            carved[number] |= not same or ranges[number] < min(same) - 1e-9
    return carved & ~body


@given(seed=st.integers(0, 999), views=st.integers(1, 4), share=st.floats(0.05, 1))
@settings(max_examples=25, deadline=None)
def test_carving_is_the_shadow_rule_voxel_by_voxel(seed, views, share):
    points, random = some_hull(seed)
    body = random.random(len(points)) < share
    body[0] = True
    seen = aspects(views, seed)
    carved = carved_voxels(points, body, seen, SPACING_M)
    assert np.array_equal(carved, slowly_carved(points, body, seen))
    more = carved_voxels(points, body, [*seen, *aspects(1, seed + 1)], SPACING_M)
    assert np.all(more[carved])


def test_a_hull_that_is_the_body_loses_nothing():
    points, _ = some_hull(1)
    whole = np.ones(len(points), dtype=bool)
    assert not carved_voxels(points, whole, aspects(5, 1), SPACING_M).any()


@given(seed=st.integers(0, 999))
@settings(max_examples=15, deadline=None)
def test_the_compact_body_returns_every_first_echo_that_was_seen(seed):
    points, _ = some_hull(seed)
    seen = aspects(4, seed)
    body = compact_body(points, seen, SPACING_M)
    for view in seen:
        cells = np.floor(points @ view.cross_range / SPACING_M)
        ranges = points @ view.line_of_sight
        for cell in np.unique(cells):
            first = ranges[(cells == cell) & body].min()
            assert first <= ranges[cells == cell].min() + SUPPORT * SPACING_M + 1e-9


def test_a_body_seen_along_one_plane_is_predicted_shorter_than_its_hull_across_it():
    grid = VoxelGrid.cube(side_m=12, spacing_m=SPACING_M)
    centres = grid.centres_m()
    open_hull = np.linalg.norm(centres[..., :2], axis=-1) < 2
    points = hull_points_m(open_hull, grid)
    turns = np.deg2rad(np.arange(0, 180, 20))
    seen = [
        Aspect(
            line_of_sight=np.array([np.cos(turn), np.sin(turn), 0]),
            cross_range=np.array([-np.sin(turn), np.cos(turn), 0]),
        )
        for turn in turns
    ]
    along = Aspect(line_of_sight=np.array([1.0, 0, 0]), cross_range=np.array([0, 0, 1.0]))
    body = compact_body(points, seen, SPACING_M)
    assert np.ptp(points[body][:, 2]) < 0.5 * np.ptp(points[:, 2])
    gains = [carved_voxels(points, body, [view], SPACING_M).sum() for view in (along, seen[0])]
    assert gains[0] > 0.5 * len(points)
    assert gains[1] < 0.1 * len(points)


def test_one_whole_view_leaves_of_a_ball_a_cylinder_cut_off_by_the_grid():
    square = np.array([[2.0, 2], [2, 6], [6, 6], [6, 2]])
    view = View(
        silhouette=Silhouette(rings=(square,), image_shape=(9, 9), claim="complete"),
        projection=Projection(matrix=np.eye(4)[:2]),
    )
    volume = ball_hull_volume(observability([view]), radius_m=2.0, side_m=9.0)
    assert volume == pytest.approx(np.pi * 2.0**2 * 9.0, rel=0.01)
