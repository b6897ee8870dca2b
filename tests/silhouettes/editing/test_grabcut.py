import numpy as np
import pytest
from scipy.ndimage import gaussian_filter

from core.silhouettes.editing.grabcut import grab_cut
from tests.silhouettes.editing.shapes import (
    SHAPE,
    assert_well_turned,
    body,
    box,
    coverage,
    frame_of,
    hausdorff_px,
)


@pytest.fixture(scope="module")
def frame():
    random = np.random.default_rng(6)
    level = gaussian_filter(0.3 * coverage(body()), 0.5)
    return frame_of(np.abs(level + random.normal(0, 0.01, SHAPE)), sensor="optical")


def test_a_rough_box_becomes_the_outline_with_its_window_and_boom(frame):
    rough = box(7, 7, 42, 53)
    after = grab_cut(rough, frame, margin_px=30.0)
    assert_well_turned(after)
    assert hausdorff_px(after, body()) < 1.5
    again = grab_cut(rough, frame, margin_px=30.0)
    for ring, other in zip(after, again, strict=True):
        assert np.array_equal(ring, other)


def test_the_outline_moves_no_further_than_the_margin(frame):
    rough = box(10, 12, 31, 46)  # over the window, without the boom
    after = grab_cut(rough, frame, margin_px=3.0)
    rows = np.concatenate(after)[:, 0]
    assert rows.max() < 34.5
    assert hausdorff_px(after, rough) < 8


def test_colours_tell_what_brightness_does_not():
    inside = coverage(body()) > 0.5
    colours = np.where(inside[..., None], [200, 40, 40], [40, 200, 40]).astype(np.uint8)
    grey = frame_of(np.ones(SHAPE), sensor="optical")
    after = grab_cut(box(7, 7, 42, 53), grey, margin_px=30.0, colours=colours)
    assert hausdorff_px(after, body()) < 1.0


@pytest.mark.parametrize(
    ("rings", "changes", "says"),
    [
        ((), {}, "holds 0 of 2880 pixels"),
        (box(-1, -1, 48, 60), {}, "holds 2880 of 2880"),
        (body(), {"margin_px": 0.0}, "positive pixels, got 0"),
        (body(), {"colours": np.zeros((3, 3, 3))}, "Colours: wanted"),
    ],
)
def test_outlines_to_start_from_are_asked_for(frame, rings, changes, says):
    with pytest.raises(ValueError, match=says):
        grab_cut(rings, frame, **changes)


def test_radar_frames_are_sent_elsewhere():
    with pytest.raises(ValueError, match="comes from a radar; GrabCut is for optical"):
        grab_cut(body(), frame_of(np.ones(SHAPE)))
