import numpy as np
import pytest

from core.formats.gotcha import read_gotcha
from core.radar.autofocus import image_entropy, phase_corrected
from core.radar.imaging import ImagingSettings, frames, whole_frame
from core.radar.range_alignment import aligned
from core.radar.refocusing import RefocusSettings, focused, refocused
from tests.radar.straying import body_history, points_history

SETTINGS = ImagingSettings(shape=(200, 200), pixel_spacing_m=0.08)


def _entropy(history):
    return image_entropy(next(frames(history, SETTINGS)).amplitude)


@pytest.mark.parametrize("autofocus", ["phase-gradient", "minimum-entropy"])
@pytest.mark.parametrize("seed", [2, 4])
def test_the_entropy_comes_back_within_two_percent(seed, autofocus):
    history, way_m = body_history(seed=seed)
    received = aligned(history, -way_m)
    clean = _entropy(history)
    assert _entropy(received) > 1.15 * clean
    assert _entropy(focused(received, RefocusSettings(autofocus=autofocus))) == pytest.approx(
        clean, rel=0.02
    )


def test_a_body_in_focus_stays_in_focus():
    history, _ = body_history(seed=2)
    assert _entropy(focused(history)) == pytest.approx(_entropy(history), rel=0.02)


def test_every_interval_is_corrected_by_itself_and_the_rest_left_alone():
    history = points_history()
    settings = RefocusSettings(autofocus="phase-gradient")
    told = []
    both = refocused(
        history, [(0, 48), (56, 120)], settings, lambda *step: told.append(step)
    ).samples
    np.testing.assert_array_equal(both[:48], focused(history.part(0, 48), settings).samples)
    np.testing.assert_array_equal(both[56:120], focused(history.part(56, 120), settings).samples)
    np.testing.assert_array_equal(both[48:56], history.samples[48:56])
    np.testing.assert_array_equal(both[120:], history.samples[120:])
    assert told == [(1, 2), (2, 2)]


def test_pulses_of_two_intervals_are_refused():
    history = points_history()
    with pytest.raises(ValueError, match="pulse 30 is in two of them"):
        refocused(history, [(0, 40), (30, 80)], RefocusSettings(autofocus="none"))


def test_nothing_asked_for_is_nothing_done():
    assert not RefocusSettings(autofocus="none", aligns=False).is_active
    history, _ = body_history(seed=2, pulses=64)
    same = focused(history, RefocusSettings(autofocus="none", aligns=False))
    np.testing.assert_array_equal(same.samples, history.samples)


def test_measured_echoes_come_back_from_tens_of_radians(shared_data):
    (path,) = sorted(shared_data("gotcha").glob("*az002*.mat"))
    history = read_gotcha([path])
    pulses = len(history.track)
    random = np.random.default_rng(1)
    time = np.linspace(-1, 1, pulses)
    error_rad = 30 * time**2 + random.uniform(-1.5, 1.5, pulses)
    disturbed = phase_corrected(history, -error_rad)
    settings = RefocusSettings(autofocus="phase-gradient", aligns=False)
    found = focused(disturbed, settings)
    clean, lost, back = (_scene_entropy(each) for each in (history, disturbed, found))
    assert lost > 1.1 * clean
    assert back < 1.02 * clean


def _scene_entropy(history):
    settings = ImagingSettings(method="backprojection", shape=(160, 160), pixel_spacing_m=0.4)
    return image_entropy(whole_frame(history, settings).amplitude)
