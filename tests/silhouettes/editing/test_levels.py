import numpy as np
import pytest

from core.silhouettes.editing.levels import grey_picture, intensity, smoothed_db
from tests.silhouettes.editing.shapes import frame_of


def step(sensor):
    amplitude = np.full((30, 30), 0.01)
    amplitude[:, 15:] = 2.0
    return frame_of(amplitude, sensor=sensor)


def test_levels_are_power_for_radar_and_brightness_for_optical_frames():
    assert intensity(step("radar"), 0.0)[0, 0] == pytest.approx(0.005**2)
    assert intensity(step("optical"), 0.0)[0, 0] == pytest.approx(0.005)
    for sensor in ("radar", "optical"):
        level = smoothed_db(step(sensor), 0.0)
        assert level == pytest.approx(step(sensor).decibels(), abs=1e-3)


def test_smoothing_keeps_the_mean_and_an_edge_in_its_place():
    level = intensity(step("radar"), 1.5)
    assert level.mean() == pytest.approx(intensity(step("radar"), 0.0).mean(), rel=1e-6)
    assert level[15, 14:16].mean() == pytest.approx(0.5, abs=1e-3)


@pytest.mark.parametrize("sensor", ["radar", "optical"])
def test_pictures_use_all_the_greys_though_a_glint_outshines_the_rest(sensor):
    random = np.random.default_rng(3)
    amplitude = random.rayleigh(0.01, (64, 64))
    amplitude[20:40, 20:40] = 0.4
    amplitude[30, 30] = 1000.0 if sensor == "radar" else 30.0
    picture = grey_picture(frame_of(amplitude, sensor=sensor), 0.0)
    assert np.median(picture[:15]) < 60
    assert picture[25, 25] > 150
    assert picture.max() == 255


def test_a_sparse_frame_still_has_white():
    amplitude = np.zeros((64, 64))
    amplitude[5, 5] = 1.0
    for sensor in ("radar", "optical"):
        assert grey_picture(frame_of(amplitude, sensor=sensor), 0.0).max() == 255


def test_frames_and_widths_without_meaning_are_refused():
    with pytest.raises(ValueError, match='"trial" is dark throughout'):
        intensity(frame_of(np.zeros((4, 4))), 1.0)
    with pytest.raises(ValueError, match="width in pixels, 0 for none; got -1"):
        intensity(step("radar"), -1.0)
