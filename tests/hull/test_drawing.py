import numpy as np
import pytest

from core.hull.drawing import drawn_silhouette
from core.silhouettes.silhouette import clockwise_area_px

SQUARE = np.array([[10.0, 10], [10, 40], [40, 40], [40, 10]])
HOLE = np.array([[20.0, 20], [20, 30], [30, 30], [30, 20]])


def drawn(*rings):
    return drawn_silhouette(rings, image_shape=(60, 60), claim="lit side")


@pytest.mark.parametrize("outer", [SQUARE, SQUARE[::-1]])
@pytest.mark.parametrize("hole", [HOLE, HOLE[::-1]])
def test_rings_may_run_either_way_and_one_within_another_is_its_hole(outer, hole):
    silhouette, repair = drawn(outer, hole)
    assert repair == ""
    assert [np.sign(clockwise_area_px(ring)) for ring in silhouette.rings] == [1, -1]
    assert silhouette.area_px() == 30 * 30 - 10 * 10
    assert {tuple(p) for p in silhouette.rings[0]} == {tuple(p) for p in SQUARE}


def test_an_outline_that_crosses_itself_is_split_and_says_so():
    bow = np.array([[10.0, 10], [40, 40], [10, 40], [40, 10]])
    silhouette, repair = drawn(bow)
    assert len(silhouette.rings) == 2
    assert silhouette.area_px() == pytest.approx(450)
    assert "crossed itself" in repair


def test_no_rings_show_no_target():
    silhouette, repair = drawn()
    assert silhouette.is_empty
    assert repair == ""


def test_a_target_may_leave_the_image_but_not_by_far():
    assert drawn(SQUARE - 40)[0].area_px() == pytest.approx(900)
    with pytest.raises(ValueError, match="far outside the image of 60 × 60 pixels"):
        drawn(SQUARE + 100)


@pytest.mark.parametrize(
    ("rings", "sentence"),
    [
        ([SQUARE[:2]], "Ring 1 of the outline has 2 vertices; at least 3 are needed"),
        ([SQUARE, SQUARE * np.nan], "Ring 2 of the outline: 8 of 8 values are NaN"),
        ([[[5.0, 5], [6, 6], [7, 7]]], "encloses no area"),
        ([SQUARE[:, :1]], r"wanted an array of shape any × 2, got \(4, 1\)"),
        ([SQUARE] * 201, "at most 200 rings and 20,000 vertices; got 201 rings"),
        ([np.tile(SQUARE, (5001, 1))], "got 1 rings and 20,004 vertices"),
    ],
)
def test_outlines_that_cannot_be_drawn_are_refused(rings, sentence):
    with pytest.raises(ValueError, match=sentence):
        drawn(*rings)
