import numpy as np
import pytest

from core.geometry.projection import Projection
from core.hull.bounds import hull_bounds_m
from core.hull.view import View
from core.silhouettes.silhouette import Silhouette

AFFINE_XY = Projection(matrix=np.array([[10.0, 0, 0, 50], [0, 10, 0, 50]]))
AFFINE_YZ = Projection(matrix=np.array([[0, 10.0, 0, 50], [0, 0, 10, 50]]))
CAMERA_ALONG_Z = Projection(
    matrix=np.array([[0.0, 500, 50, 500], [500, 0, 50, 500], [0, 0, 1, 10]])
)


def _view(projection, lower, upper):
    (a, b), (c, d) = lower, upper
    ring = np.array([[a, b], [a, d], [c, d], [c, b]], dtype=float)
    silhouette = Silhouette(rings=(ring,), image_shape=(100, 100), claim="complete")
    return View(silhouette=silhouette, projection=projection)


def test_affine_views_bound_the_box_that_their_rectangles_share():
    views = [_view(AFFINE_XY, (40, 45), (70, 60)), _view(AFFINE_YZ, (20, 30), (55, 80))]
    lower_m, upper_m = hull_bounds_m(views)
    assert lower_m == pytest.approx([-1.0, -0.5, -2.0])
    assert upper_m == pytest.approx([2.0, 0.5, 3.0])


def test_a_camera_bounds_a_pyramid():
    views = [_view(AFFINE_YZ, (0, 30), (100, 70)), _view(CAMERA_ALONG_Z, (0, 0), (100, 100))]
    lower_m, upper_m = hull_bounds_m(views)
    assert lower_m == pytest.approx([-1.2, -1.2, -2.0])  # widest at the far end, depth 12 m
    assert upper_m == pytest.approx([1.2, 1.2, 2.0])


def test_one_affine_view_leaves_its_depth_unbounded():
    with pytest.raises(ValueError, match="unbounded along z"):
        hull_bounds_m([_view(AFFINE_XY, (40, 45), (70, 60))])


def test_views_that_contradict_each_other_are_refused():
    views = [_view(AFFINE_XY, (40, 45), (70, 60)), _view(AFFINE_XY, (80, 45), (90, 60))]
    with pytest.raises(ValueError, match="No point lies in all silhouettes"):
        hull_bounds_m([*views, _view(AFFINE_YZ, (20, 30), (55, 80))])


def test_an_empty_silhouette_is_refused():
    empty = Silhouette(rings=(), image_shape=(10, 10), claim="complete")
    with pytest.raises(ValueError, match="a silhouette in each"):
        hull_bounds_m([View(silhouette=empty, projection=AFFINE_XY)])
