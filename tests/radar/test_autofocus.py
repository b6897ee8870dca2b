import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.radar.autofocus import (
    centring_phase_rad,
    image_entropy,
    minimum_entropy,
    phase_corrected,
    phase_gradient,
    without_drift,
    without_line,
)
from core.radar.backprojection import backproject, pulse_contributions
from core.radar.refocusing import focus_points_m
from tests.radar.straying import points_history


def _wrapped_rms(phase_rad, true_rad):
    apart = np.unwrap(np.angle(np.exp(1j * (phase_rad - true_rad))))
    return without_line(apart).std()


def _errors(seed, pulses):
    random = np.random.default_rng(seed)
    smooth = np.polynomial.Polynomial([0, 0, *random.uniform(-8, 8, 2)])
    return smooth(np.linspace(-1, 1, pulses)) + random.uniform(-1.2, 1.2, pulses)


@given(st.lists(st.floats(0.0, 1e3), min_size=1, max_size=40), st.floats(0.01, 100.0))
def test_entropy_is_that_of_the_shares_and_knows_no_scale(amplitude, scale):
    amplitude = np.array(amplitude)
    if np.square(amplitude).sum() < 1e-6:
        return
    share = amplitude**2 / np.sum(amplitude**2)
    wanted = -sum(p * np.log(p) for p in share if p > 0)
    assert image_entropy(amplitude) == pytest.approx(wanted, abs=1e-9)
    assert image_entropy(scale * amplitude) == pytest.approx(wanted, abs=1e-9)
    assert image_entropy(amplitude) <= np.log(len(amplitude)) + 1e-9


def test_a_point_has_no_entropy_and_a_grey_image_the_most():
    assert image_entropy(np.eye(1, 50)) == 0
    assert image_entropy(np.ones((10, 10))) == pytest.approx(np.log(100))
    with pytest.raises(ValueError, match="dark image"):
        image_entropy(np.zeros((4, 4)))


@pytest.fixture(scope="module")
def points():
    history = points_history()
    return history, focus_points_m(history)


def test_what_the_pulses_add_is_the_image(points):
    history, pixels = points
    parts = pulse_contributions(history, pixels)
    assert parts.shape == (len(history.track), *pixels.shape[:2])
    np.testing.assert_allclose(parts.sum(axis=0), backproject(history, pixels), atol=1e-5)


@pytest.mark.parametrize("find", [phase_gradient, minimum_entropy])
@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=4)
def test_the_phases_of_points_come_back_but_for_a_line(points, find, seed):
    history, pixels = points
    true_rad = _errors(seed, len(history.track))
    contributions = pulse_contributions(phase_corrected(history, -true_rad), pixels)
    start_rad = (phase_gradient(contributions),) if find is minimum_entropy else ()
    found_rad = find(contributions, *start_rad)
    assert _wrapped_rms(found_rad, true_rad) < 0.25
    assert np.angle(np.exp(1j * np.diff(found_rad)).sum()) == pytest.approx(0, abs=1e-6)


@given(seed=st.integers(0, 2**32 - 1), step_rad=st.floats(-3, 3))
def test_a_drift_is_left_out_whatever_whole_turns_lie_on_it(seed, step_rad):
    random = np.random.default_rng(seed)
    noise = random.uniform(-1, 1, 60)
    turns = 2 * np.pi * np.cumsum(random.integers(-1, 2, 60))
    with_drift = without_drift(noise + turns + step_rad * np.arange(60))
    apart = np.exp(1j * (with_drift - without_drift(noise)))
    np.testing.assert_allclose(apart, 1, atol=1e-9)


def test_minimum_entropy_never_ends_above_where_it_began(points):
    history, pixels = points
    contributions = pulse_contributions(phase_corrected(history, -_errors(5, 128)), pixels)

    def entropy(phase_rad):
        turned = np.exp(-1j * phase_rad)[:, None, None]
        return image_entropy(np.abs((contributions * turned).sum(axis=0)))

    assert entropy(minimum_entropy(contributions)) < entropy(np.zeros(128)) - 1


def test_a_line_is_all_that_centring_adds_and_takes_doppler_to_zero():
    history = points_history(positions_m=((0.0, 0.0, 0.0),))
    drift_rad = 0.3 * np.arange(len(history.track))
    centred = centring_phase_rad(phase_corrected(history, -drift_rad))
    np.testing.assert_allclose(np.diff(centred), 0.3, atol=1e-5)
