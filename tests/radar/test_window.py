import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.signal import windows

from core.radar.window import HAMMING, taylor, window_named

LEVELS = st.floats(-60, -22).map(lambda level: round(level, 1))


def test_hamming_has_harriss_figures():
    assert HAMMING.half_power_width_cells == pytest.approx(1.303, abs=1e-3)
    assert HAMMING.first_null_cells == pytest.approx(2.0, abs=1e-6)
    assert HAMMING.highest_sidelobe_db == pytest.approx(-42.7, abs=0.1)
    place = (np.arange(64) + 0.5) / 64
    np.testing.assert_allclose(
        HAMMING.weights(place) * 0.54, 0.54 - 0.46 * np.cos(2 * np.pi * place), atol=1e-12
    )


@given(level=LEVELS, nbar=st.integers(4, 9))
def test_taylors_weights_are_scipys(level, nbar):
    ours = taylor(sidelobe_db=level, nbar=nbar).weights((np.arange(101) + 0.5) / 101)
    np.testing.assert_allclose(
        ours, windows.taylor(101, nbar=nbar, sll=-level, norm=False), atol=1e-9
    )


@given(level=LEVELS, nbar=st.integers(4, 9))
def test_the_point_response_is_the_windows_transform(level, nbar):
    place = np.linspace(-6, 6, 25)
    aperture = (np.arange(4000) + 0.5) / 4000
    for window in (HAMMING, taylor(sidelobe_db=level, nbar=nbar)):
        turns = np.exp(2j * np.pi * np.multiply.outer(place, aperture - 0.5))
        expected = (turns @ window.weights(aperture)).real / 4000
        np.testing.assert_allclose(window.point_response(place), expected, atol=1e-5)


def test_taylor_holds_its_sidelobes_with_a_main_lobe_narrower_than_hammings():
    window = taylor(sidelobe_db=-42.7, nbar=8)
    assert window.highest_sidelobe_db == pytest.approx(-42.7, abs=0.7)
    assert window.half_power_width_cells < HAMMING.half_power_width_cells


@given(level=LEVELS, nbar=st.integers(2, 12))
def test_a_window_is_found_again_by_its_name(level, nbar):
    window = taylor(sidelobe_db=level, nbar=nbar)
    assert window_named(window.name) == window
    assert window_named("hamming") is HAMMING


@pytest.mark.parametrize("name", ["", "hann", "taylor", "taylor -90 dB nbar 5", "taylor x dB"])
def test_a_window_that_does_not_exist_is_refused(name):
    with pytest.raises(ValueError, match=r"window"):
        window_named(name)
