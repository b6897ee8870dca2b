import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from core.silhouettes.areas import area_of, rings_of
from core.silhouettes.editing.brush import combined, combined_rings, painted, stroke_area
from core.silhouettes.silhouette import Silhouette
from tests.silhouettes.editing.shapes import (
    SHAPE,
    area_px,
    assert_well_turned,
    body,
    box,
    disc,
    outlines,
)

STROKES = st.lists(st.tuples(st.floats(-5, 52), st.floats(-5, 64)), min_size=1, max_size=5)
RADII = st.floats(0.3, 12)


@settings(max_examples=30)
@given(rings=outlines(), points=STROKES, radius=RADII, add=st.booleans())
def test_a_stroke_is_the_union_or_difference_of_the_areas(rings, points, radius, add):
    after = painted(rings, SHAPE, points, radius, add=add)
    before, stroke = area_of(rings), stroke_area(points, radius)
    wanted = before.union(stroke) if add else before.difference(stroke)
    if add:
        wanted = wanted.intersection(shapely.box(-0.5, -0.5, SHAPE[0] - 0.5, SHAPE[1] - 0.5))
    assert area_of(after).symmetric_difference(wanted).area < 1e-4
    assert_well_turned(after)


@settings(max_examples=30)
@given(rings=outlines(), points=STROKES, radius=RADII, add=st.booleans())
def test_vertices_out_of_reach_stay_to_the_last_bit(rings, points, radius, add):
    after = painted(rings, SHAPE, points, radius, add=add)
    line = shapely.LineString(np.round([*points, points[-1]], 6))  # as GEOS can measure it
    kept = {tuple(vertex) for ring in after for vertex in ring}
    for ring in rings:
        far = shapely.distance(shapely.points(ring), line) > radius + 1e-6
        assert kept.issuperset(map(tuple, ring[far]))
        if shapely.distance(shapely.LinearRing(ring), line) > radius + 1e-6 and not add:
            inside = shapely.Polygon(ring).distance(line) <= radius
            assert inside or any(other is ring for other in after)


@settings(max_examples=30)
@given(points=STROKES, radius=RADII, rings=outlines())
def test_erasing_what_was_painted_on_empty_space_gives_the_outline_back(points, radius, rings):
    around = shapely.buffer(stroke_area(points, radius), 0.01)
    free = rings_of(
        [part for part in shapely.get_parts(area_of(rings)) if not part.intersects(around)]
    )
    there = painted(free, SHAPE, points, radius, add=True)
    back = painted(there, SHAPE, points, radius, add=False)
    assert area_px(back) == pytest.approx(area_px(free), abs=1e-6)


def test_a_ring_out_of_reach_is_the_same_object():
    plate, window, boom = body()
    after = painted((plate, window, boom), SHAPE, [(36, 30)], 2.0, add=True)
    assert after[0] is plate
    assert after[1] is window
    assert len(after) == 3


def test_an_eraser_splits_a_boom_and_drills_a_hole():
    split = painted(box(10, 5, 13, 50), SHAPE, [(5, 20), (20, 20)], 2.0, add=False)
    assert len(split) == 2
    assert area_px(split) == pytest.approx(3 * 45 - 3 * 4)
    drilled = painted(box(5, 5, 40, 50), SHAPE, [(20, 20)], 3.0, add=False)
    assert len(drilled) == 2
    assert area_px(drilled) == pytest.approx(35 * 45 - 9 * np.pi, abs=0.3)


def test_a_round_brush_is_round_to_a_fiftieth_of_a_pixel():
    for radius in (0.5, 3.0, 40.0):
        rim = np.array(stroke_area([(0, 0)], radius).exterior.segmentize(0.01).coords)
        distance = np.hypot(rim[:, 0], rim[:, 1])
        assert radius - 0.0201 <= distance.min() <= distance.max() <= radius + 1e-9


def test_nothing_is_painted_outside_the_image_but_all_can_be_erased():
    after = painted((), SHAPE, [(0, 0)], 5.0, add=True)
    assert min(ring.min() for ring in after) == -0.5
    assert painted(box(-9, -9, -4, -4), SHAPE, [(-6, -6)], 9.0, add=False) == ()


@settings(max_examples=30)
@given(rings=outlines(), others=outlines())
def test_combining_rings_is_the_algebra_of_their_masks(rings, others):
    def mask(outline):
        return Silhouette(rings=outline, image_shape=SHAPE, claim="complete").mask()

    a, b = mask(rings), mask(others)
    assert np.array_equal(mask(combined_rings(rings, others, "add")), a | b)
    assert np.array_equal(mask(combined_rings(rings, others, "subtract")), a & ~b)
    assert np.array_equal(mask(combined_rings(rings, others, "intersect")), a & b)


def test_a_lasso_that_crosses_itself_takes_all_that_it_encloses():
    loop = disc(20, 20, 8)[0]
    assert area_px(combined((), np.concatenate([loop, loop]), "add")) == pytest.approx(
        area_px((loop,))
    )
    bow_tie = [[0.0, 0.0], [4.0, 4.0], [4.0, 0.0], [0.0, 4.0]]
    assert area_px(combined((), bow_tie, "add")) == pytest.approx(8)


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda: painted((), SHAPE, np.empty((0, 2)), 2.0, add=True), "at least one point"),
        (lambda: painted((), SHAPE, [(1, 1)], 0.0, add=True), "positive pixels, got 0"),
        (lambda: painted((), SHAPE, [(1, np.inf)], 1.0, add=True), "NaN or infinite"),
        (lambda: combined((), [(0, 0), (1, 1), (2, 2)], "add"), "encloses no area"),
        (lambda: combined((), [(0, 0)], "add"), "1 vertices, encloses no area"),
        (lambda: combined((), np.empty((0, 2)), "add"), "encloses no area"),
        (lambda: combined((), [(0, 0), (0, 1), (2, 2)], "xor"), 'not "xor"'),
    ],
)
def test_strokes_and_polygons_of_nothing_are_refused(call, says):
    with pytest.raises(ValueError, match=says):
        call()
