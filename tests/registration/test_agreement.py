import numpy as np
import pytest

from core.registration.agreement import contour_equations, contours, hull_depths_px
from core.registration.depth import DistanceMaps
from tests.registration.shifting import body_views


@pytest.fixture(scope="module")
def scene():
    views = body_views(16)
    maps = DistanceMaps.of(views)
    return views, maps, contours(views, maps)


def depths_with(scene, offsets):
    views, maps, outlines = scene
    return hull_depths_px(views, outlines, maps, offsets, np.zeros(len(views), bool))


def test_true_outlines_never_leave_the_hull_of_the_others(scene):
    depths = np.concatenate(depths_with(scene, np.zeros((16, 2))))
    # Distances are of pixels, and steps along a line two pixels apart.
    assert np.quantile(depths, 0.01) > -2.5
    assert np.median(np.abs(depths)) < 2


def test_a_frame_that_stands_wrong_leaves_it(scene):
    offsets = np.zeros((16, 2))
    offsets[5] = 12.0, -9.0
    depths = depths_with(scene, offsets)
    assert np.mean(depths[5] < -3) > 0.2


def test_its_equations_lead_back(scene):
    offsets = np.zeros((16, 2))
    offsets[5] = 2.0, -1.5
    depths = depths_with(scene, offsets)
    equations = contour_equations(scene[2], depths, offsets, float(np.median(depths[5])))
    rows = (equations.view == 5) & (np.abs(np.concatenate(depths)) < 4)
    solved = np.linalg.lstsq(equations.slope[rows], equations.value_px[rows])[0]
    assert np.linalg.norm(solved) < 0.6 * np.linalg.norm(offsets[5])


def test_inward_points_into_the_outline(scene):
    _, maps, outlines = scene
    inside = outlines[0].points + 2 * outlines[0].inward
    at = np.round(inside).astype(int) - maps.corner[0]
    assert np.mean(maps.image(0)[at[:, 0], at[:, 1]] > 0) > 0.97
