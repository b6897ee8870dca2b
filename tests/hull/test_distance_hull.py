import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.geometry.grid import VoxelGrid
from core.geometry.projection import Projection
from core.hull.distance_hull import (
    BAND_PX,
    CurvedView,
    distance_surface,
    hull_distance_px,
    inward_px,
)
from core.hull.view import View
from core.hull.votes import VoteCounts
from core.silhouettes.silhouette import Silhouette

SHAPE = (60, 60)
GRID = VoxelGrid.cube(side_m=2.0, spacing_m=0.125)


def disc(radius_px, row=29.5, column=29.5):
    turn = np.linspace(0, 2 * np.pi, 90, endpoint=False)
    ring = np.column_stack([row + radius_px * np.sin(turn), column + radius_px * np.cos(turn)])
    return Silhouette(rings=(ring[::-1],), image_shape=SHAPE, claim="complete")


def side(axis):
    rows = np.delete(np.eye(3), axis, axis=0) * 20.0
    return Projection(matrix=np.column_stack([rows, [29.5, 29.5]]))


def curved(silhouette, axis):
    return CurvedView(silhouette=silhouette, image_points=side(axis).image_points)


@settings(max_examples=15, deadline=None)
@given(radii=st.tuples(*[st.floats(5, 20)] * 3), offset=st.floats(-4, 4))
def test_it_is_the_voted_hull_but_for_what_is_on_the_edge(radii, offset):
    discs = [disc(radius, row=29.5 + offset) for radius in radii]
    volume = VoteCounts(GRID)
    for axis, each in enumerate(discs):
        volume.add(View(silhouette=each, projection=side(axis)))
    inside = hull_distance_px([curved(each, axis) for axis, each in enumerate(discs)], GRID)
    clear = np.abs(inside) > 0.4
    np.testing.assert_array_equal((inside > 0)[clear], volume.hull()[clear])


def test_the_surface_falls_between_voxels():
    views = [curved(disc(13.7), axis) for axis in range(3)]
    surface = distance_surface(hull_distance_px(views, GRID), GRID)
    widths = np.ptp(surface.vertices_m, axis=0)
    np.testing.assert_allclose(widths, 2 * 13.7 / 20, atol=0.02)
    assert surface.volume_m3() > 0


def test_a_view_that_may_miss_takes_nothing_away():
    good = [curved(disc(14), axis) for axis in range(3)]
    wrong = curved(disc(3, row=10), 0)
    assert (hull_distance_px([*good, wrong], GRID) > 0).sum() == 0
    kept = hull_distance_px([*good, wrong], GRID, may_miss=1) > 0
    assert kept[hull_distance_px(good, GRID) > 0].all()


def test_an_outline_of_nothing_and_one_of_everything():
    empty = Silhouette(rings=(), image_shape=SHAPE, claim="complete")
    assert (inward_px(empty) == -BAND_PX).all()
    assert (inward_px(disc(200)) == BAND_PX).all()
    surface = distance_surface(hull_distance_px([curved(empty, 0)], GRID), GRID)
    assert surface.is_empty


def test_all_views_missing_is_no_hull():
    with pytest.raises(ValueError, match="needs more views"):
        hull_distance_px([curved(disc(9), 0)], GRID, may_miss=1)
