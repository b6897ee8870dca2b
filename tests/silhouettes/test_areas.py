import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis.extra.numpy import arrays

from core.silhouettes.areas import area_of, rings_of
from core.silhouettes.contours import traced_rings
from core.silhouettes.silhouette import Silhouette, clockwise_area_px


def square(first, last, *, clockwise=True):
    ring = np.array([[first, first], [first, last], [last, last], [last, first]], dtype=float)
    return ring if clockwise else ring[::-1]


@settings(max_examples=40)
@given(mask=arrays(bool, (8, 9)))
def test_rings_of_the_area_of_rings_enclose_the_same(mask):
    rings = traced_rings(mask.astype(np.float32), 0.5)
    area = area_of(rings)
    again = Silhouette(rings=rings_of(area), image_shape=mask.shape, claim="complete")
    assert area.is_valid
    assert area.area == pytest.approx(sum(clockwise_area_px(ring) for ring in rings))
    assert np.array_equal(again.mask(), mask)


def test_a_part_within_a_hole_stays_in_any_order():
    rings = (square(3, 5), square(2, 8, clockwise=False), square(0, 10))
    assert area_of(rings).area == 100 - 36 + 4
    assert area_of(rings[::-1]).area == 100 - 36 + 4


def test_both_lobes_of_a_crossed_ring_count_whichever_way_it_turns():
    bow_tie = np.array([[0.0, 0.0], [4.0, 4.0], [4.0, 0.0], [0.0, 4.0]])
    assert area_of((bow_tie,)).area == pytest.approx(8)
    assert area_of((bow_tie[::-1],)).area == pytest.approx(8)


def test_no_rings_enclose_nothing():
    assert area_of(()).is_empty
    assert rings_of(area_of(())) == ()
