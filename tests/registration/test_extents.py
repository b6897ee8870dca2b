import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import ConvexHull

from core.benchmarks.workload import satellite, satellite_views
from core.geometry.projection import Projection
from core.hull.view import View
from core.registration.extents import extent_equations, mean_pixel_m
from core.silhouettes.silhouette import Silhouette
from tests.registration.shifting import body_views, random_offsets, shifted


@given(seed=st.integers(0, 1000))
@settings(max_examples=10)
def test_the_true_offsets_leave_nothing_of_complete_outlines(seed):
    views = body_views(5, seed=seed)
    offsets = random_offsets(views, seed=seed)
    equations = extent_equations(shifted(views, offsets))
    assert len(equations) > 0
    assert not equations.sign.any()
    assert np.abs(equations.left_px(offsets)).max() < 1e-6


def test_the_pixel_is_the_views():
    assert mean_pixel_m(satellite_views(3)) == pytest.approx(0.0185)


def lit_sides(views):
    """The near chain of every outline's convex hull: true toward the radar, short behind."""
    points = np.concatenate(satellite(16))
    for view in views:
        image = view.projection.image_points(points)
        hull = ConvexHull(image)
        near = np.unique(hull.simplices[hull.equations[:, 0] <= 0])
        chain = image[near][np.argsort(image[near][:, 1])]
        silhouette = Silhouette(rings=(chain,), image_shape=(512, 512), claim="lit side")
        yield View(silhouette=silhouette, projection=view.projection)


@given(seed=st.integers(0, 1000))
@settings(max_examples=10)
def test_lit_sides_equal_toward_the_radar_and_bound_behind(seed):
    views = list(lit_sides(body_views(6, seed=seed)))
    offsets = random_offsets(views, seed=seed)
    equations = extent_equations(shifted(views, offsets))
    left = equations.left_px(offsets)
    assert np.abs(left[equations.sign == 0]).max() < 1e-6
    assert (equations.sign * left).min() > -1e-6


def test_where_only_one_side_is_lit_the_other_may_fall_short():
    equations = extent_equations(list(lit_sides(body_views(6, seed=1))))
    assert {-1, 0, 1} == set(equations.sign.tolist())
    assert (equations.sign * equations.left_px(np.zeros((6, 2)))).max() > 1


def test_a_perspective_camera_and_an_empty_silhouette_are_refused():
    views = body_views(3)
    camera = Projection(matrix=np.array([[1.0, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 5]]))
    with pytest.raises(ValueError, match="affine views"):
        extent_equations([*views, View(silhouette=views[0].silhouette, projection=camera)])
    empty = Silhouette(rings=(), image_shape=(4, 4), claim="complete")
    with pytest.raises(ValueError, match="no extents"):
        extent_equations([*views, View(silhouette=empty, projection=views[0].projection)])
