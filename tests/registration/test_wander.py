import numpy as np
import pytest

from core.registration.wander import Wander


def test_drift_and_jumps_are_told_apart():
    offsets = np.column_stack([0.5 * np.arange(1, 11), np.zeros(10)])
    offsets[6:, 1] += 8.0
    wander = Wander(frame_numbers=np.arange(1, 11), offsets_px=offsets)
    assert wander.drift_px_per_frame == pytest.approx([0.5, 0.0], abs=1e-9)
    assert wander.jumps_px == pytest.approx([0, 0, 0, 0, 0, 0, 8, 0, 0, 0], abs=1e-9)
    assert wander.sentence().endswith("and jump by 8.0 px at most, at frame 7.")
    assert "reach 5.0 px in range and 8.0 px in cross-range" in wander.sentence()


def test_a_frame_left_out_is_no_jump():
    numbers = np.array([1, 2, 4, 5, 9])
    wander = Wander(frame_numbers=numbers, offsets_px=np.outer(numbers, [1.0, -2.0]))
    assert wander.jumps_px == pytest.approx(np.zeros(5), abs=1e-9)


@pytest.mark.parametrize("count", [0, 1])
def test_few_frames_have_no_drift(count):
    wander = Wander(frame_numbers=np.arange(count), offsets_px=np.ones((count, 2)))
    assert wander.drift_px_per_frame.tolist() == [0, 0]
    assert wander.jumps_px.shape == (count,)
    assert wander.sentence()
