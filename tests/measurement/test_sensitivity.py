import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from core.measurement.sensitivity import displaced_silhouette
from core.silhouettes.areas import area_of, rings_of
from core.silhouettes.silhouette import Silhouette


def silhouette(geometry):
    return Silhouette(rings=rings_of(geometry), image_shape=(64, 64), claim="complete")


FRAME = shapely.box(10, 10, 40, 50).difference(shapely.box(20, 20, 30, 30))


def test_edges_move_outward_and_holes_shrink():
    grown = area_of(displaced_silhouette(silhouette(FRAME), 0.5).rings)
    assert grown.bounds == pytest.approx((9.5, 9.5, 40.5, 50.5))
    assert shapely.Polygon(grown.interiors[0]).bounds == pytest.approx((20.5, 20.5, 29.5, 29.5))


def test_narrow_parts_disappear_and_no_step_changes_nothing():
    bar = silhouette(shapely.box(10, 10, 11, 50))
    assert displaced_silhouette(bar, -0.6).is_empty
    assert displaced_silhouette(bar, 0) is bar
    assert displaced_silhouette(displaced_silhouette(bar, -0.6), 1.0).is_empty


@settings(max_examples=50)
@given(seed=st.integers(0, 10**6), cells=st.floats(0.01, 3))
def test_eroded_lies_within_and_dilated_holds_all_within_that_distance(seed, cells):
    points = np.random.default_rng(seed).uniform(10, 50, (8, 2))
    body = shapely.MultiPoint(points).convex_hull.difference(shapely.box(28, 28, 33, 33))
    outline = silhouette(body)
    body = area_of(outline.rings)
    smaller = area_of(displaced_silhouette(outline, -cells).rings)
    larger = area_of(displaced_silhouette(outline, cells).rings)
    assert shapely.difference(smaller, body).area < 1e-9
    assert shapely.difference(body, larger).area < 1e-9
    if not smaller.is_empty:
        # Around corners the edge runs along chords of a circle's sixteenths.
        assert 0.98 * cells <= shapely.distance(smaller, body.boundary) <= cells + 1e-6
    assert shapely.difference(larger, shapely.buffer(body, 1.001 * cells, quad_segs=64)).area < 1e-9
