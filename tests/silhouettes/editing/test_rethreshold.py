from dataclasses import replace

import numpy as np
import pytest

from core.silhouettes.editing.rethreshold import rethresholded
from core.silhouettes.extraction import ExtractionSettings, extract_silhouette
from tests.silhouettes.editing.shapes import box, frame_of, silhouette


@pytest.fixture
def frame():
    random = np.random.default_rng(11)
    amplitude = random.rayleigh(0.01, (48, 60))
    amplitude[10:30, 15:45] += random.rayleigh(0.08, (20, 30))
    return frame_of(amplitude)


def test_a_frames_own_settings_are_an_extraction_with_them(frame):
    before = silhouette(box(1, 1, 5, 5))
    own = ExtractionSettings(detection_factor=9.0, closing_px=9)
    after, wanted = rethresholded(before, frame, own), extract_silhouette(frame, own)
    assert after.component == "boom"
    assert after.claim == "lit side"
    assert "a₂ = 9, closing 9 px" in after.provenance
    assert after.provenance.endswith("; by hand: re-threshold")
    for ring, other in zip(after.rings, wanted.rings, strict=True):
        assert np.array_equal(ring, other)


def test_a_higher_threshold_and_a_smaller_closing_leave_less(frame):
    before = silhouette(())
    areas = [
        rethresholded(
            before,
            frame,
            ExtractionSettings(detection_factor=factor, closing_px=closing, corrects_edge=False),
        ).area_px()
        for factor, closing in [(4.0, 7), (8.0, 7), (8.0, 0)]
    ]
    assert areas[0] > areas[1] > areas[2]


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"closing_px": -1}, "closing must be 0 to 48 pixels"),
        ({"closing_px": 49}, "got 49"),
        ({"detection_factor": 1.0}, "0 < a₁ ≤ a₂"),
    ],
)
def test_settings_without_meaning_are_refused(frame, changes, says):
    with pytest.raises(ValueError, match=says):
        rethresholded(silhouette(()), frame, replace(ExtractionSettings(), **changes))


def test_another_frames_silhouette_is_refused(frame):
    with pytest.raises(ValueError, match="re-threshold it in its own frame"):
        rethresholded(silhouette((), image_shape=(9, 9)), frame, ExtractionSettings())
