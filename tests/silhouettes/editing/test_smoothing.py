import numpy as np
import pytest
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from core.silhouettes.areas import area_of
from core.silhouettes.editing.smoothing import simplified, smoothed, without_holes
from core.silhouettes.silhouette import clockwise_area_px
from tests.silhouettes.editing.shapes import (
    area_px,
    assert_well_turned,
    body,
    box,
    disc,
    hausdorff_px,
    outlines,
)


@settings(max_examples=30)
@given(rings=outlines(), strength=st.floats(0.2, 6.0))
def test_smoothing_keeps_the_area_and_every_part(rings, strength):
    assume(rings)
    after = smoothed(rings, strength)
    assert_well_turned(after)
    if len(after) == len(rings):  # parts that touched at a corner may have become one
        assert area_px(after) == pytest.approx(area_px(rings), rel=2e-3, abs=0.05)
    assert hausdorff_px(rings, after) < 2.5 * strength


@pytest.mark.parametrize("strength", [0.5, 2.0, 8.0, 100.0])
def test_a_disc_stays_a_disc(strength):
    assert hausdorff_px(smoothed(disc(20, 30, 9), strength), disc(20, 30, 9)) < 0.05


def test_jitter_goes_and_the_shape_stays():
    true = disc(24, 30, 15, vertices=300)
    jitter = np.random.default_rng(2).normal(0, 0.5, true[0].shape)
    rough = (true[0] + jitter,)
    after = smoothed(rough, 3.0)
    distance = np.hypot(*(after[0] - (24, 30)).T) - 15
    assert np.sqrt(np.mean(distance**2)) < 0.25
    assert hausdorff_px(rough, true) > 1.0


@settings(max_examples=30)
@given(rings=outlines(), tolerance=st.floats(0, 3))
def test_simplifying_keeps_within_the_tolerance_and_to_old_vertices(rings, tolerance):
    assume(rings)
    after = simplified(rings, tolerance)
    assert hausdorff_px(rings, after) <= tolerance + 1e-6
    assert sum(map(len, after)) <= sum(map(len, rings))
    old = {tuple(vertex) for ring in rings for vertex in ring}
    assert all(tuple(vertex) in old for ring in after for vertex in ring)
    assert_well_turned(after)


@settings(max_examples=30)
@given(rings=outlines(), largest=st.floats(0, 400))
def test_filled_holes_are_gone_and_nothing_else_is(rings, largest):
    after = without_holes(rings, largest)
    assert not any(-largest <= clockwise_area_px(ring) < 0 for ring in after)
    gained = area_of(after).difference(area_of(rings))
    assert area_of(rings).difference(area_of(after)).area < 1e-9
    holes = [shapely.Polygon(r) for r in rings if -largest <= clockwise_area_px(r) < 0]
    assert gained.difference(shapely.union_all(holes)).area < 1e-6


def test_a_part_within_a_filled_hole_becomes_one_with_it():
    plate, window, boom = body()
    island = box(17, 23, 19, 27)[0]
    assert [len(r) for r in without_holes((plate, window, boom, island))] == [4, 4]
    untouched = (plate, window, boom)
    assert without_holes(untouched, 5.0) is untouched
    assert without_holes(untouched)[0] is plate


def test_strengths_without_meaning_are_refused():
    with pytest.raises(ValueError, match="strength of positive pixels, got 0"):
        smoothed(body(), 0.0)
    with pytest.raises(ValueError, match="not negative; got -1"):
        simplified(body(), -1.0)
    with pytest.raises(ValueError, match="not negative; got nan"):
        without_holes(body(), float("nan"))
