import pytest
from hypothesis import given, settings

from core.silhouettes.areas import area_of
from core.silhouettes.editing.disagreement import disagreement
from tests.silhouettes.editing.shapes import area_px, box, outlines


@settings(max_examples=30)
@given(outline=outlines(), reprojection=outlines())
def test_what_differs_and_what_is_common_make_up_both(outline, reprojection):
    found = disagreement(outline, reprojection)
    drawn, seen = area_of(outline), area_of(reprojection)
    assert area_px(found.only_outline) == pytest.approx(found.only_outline_px, abs=1e-6)
    assert area_px(found.only_reprojection) == pytest.approx(found.only_reprojection_px, abs=1e-6)
    common_px = drawn.intersection(seen).area
    assert found.only_outline_px + common_px == pytest.approx(drawn.area, abs=1e-6)
    assert found.only_reprojection_px + common_px == pytest.approx(seen.area, abs=1e-6)


@given(outline=outlines())
def test_an_outline_agrees_with_itself(outline):
    found = disagreement(outline, outline)
    assert found.only_outline == found.only_reprojection == ()
    assert found.overlap == pytest.approx(1)


def test_what_lies_in_the_shadow_is_no_difference_but_a_part_carved_away_is():
    found = disagreement(box(10, 10, 20, 30), box(12, 10, 40, 32), shadow=box(20, 10, 47, 30))
    assert found.only_outline_px == pytest.approx(2 * 20)
    assert found.only_reprojection_px == pytest.approx(28 * 2)
    assert found.overlap == pytest.approx(160 / (200 + 56))
