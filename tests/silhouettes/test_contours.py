import numpy as np
from hypothesis import given, settings
from hypothesis.extra.numpy import arrays

from core.silhouettes.contours import cleaned_mask, traced_rings
from core.silhouettes.silhouette import Silhouette, clockwise_area_px


def traced(mask):
    rings = traced_rings(mask.astype(np.float32), 0.5)
    return Silhouette(rings=rings, image_shape=mask.shape, claim="complete")


@settings(max_examples=60, deadline=None)
@given(mask=arrays(bool, (9, 11)))
def test_raster_of_the_traced_rings_is_the_mask(mask):
    assert np.array_equal(traced(mask).mask(), mask)


def test_outer_rings_run_clockwise_and_holes_do_not():
    mask = np.zeros((30, 40), bool)
    mask[3:20, 4:30] = True
    mask[8:12, 10:20] = False
    mask[24:28, 30:36] = True
    areas = [clockwise_area_px(ring) for ring in traced(mask).rings]
    assert sorted(np.sign(areas)) == [-1, 1, 1]


def test_clockwise_is_as_seen_on_the_image():
    """Rows grow downward: right, then down, then left is clockwise."""
    ring = np.array([[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]])
    assert clockwise_area_px(ring) == 1.0


def test_diagonal_neighbours_belong_together():
    mask = np.zeros((6, 6), bool)
    mask[1:3, 1:3] = mask[3:5, 3:5] = True
    assert len(traced(mask).rings) == 1


def test_a_target_at_the_images_edge_stays_closed():
    mask = np.ones((5, 7), bool)
    (ring,) = traced(mask).rings
    assert clockwise_area_px(ring) > 0
    assert np.array_equal(traced(mask).mask(), mask)


def test_specks_and_pinholes_go_and_gaps_close():
    mask = np.zeros((60, 60), bool)
    mask[10:40, 10:25] = mask[10:40, 27:40] = True
    mask[50, 50] = True
    mask[20, 15] = False
    cleaned = cleaned_mask(mask, closing_px=5, smallest_part_px=4)
    assert not cleaned[50, 50]
    assert cleaned[20, 15]
    assert cleaned[15:35, 25:27].all()
    assert cleaned[10:40, 10:25].all()
    assert cleaned[10:40, 27:40].all()
    assert cleaned.sum() <= 30 * 30


def test_a_mask_at_the_border_is_not_eaten_by_closing():
    mask = np.ones((20, 20), bool)
    assert cleaned_mask(mask, closing_px=9, smallest_part_px=4).all()
