import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.geometry.track import random_views_track
from core.radar.echoes import point_echoes
from core.radar.imaging import ImagingSettings, frames
from core.radar.phase_history import PhaseHistory
from core.radar.pulse_errors import (
    PulseErrorModel,
    PulseErrors,
    with_pulse_errors,
    without_pulse_errors,
)
from core.radar.waveform import SPEED_OF_LIGHT_M_PER_S, Waveform

WAVEFORM = Waveform(frequency_count=64)


def point(pulses=256, waveform=WAVEFORM):
    track = random_views_track(
        views=1,
        turn_rad=waveform.wavelength_m / 0.3,
        pulses_per_view=pulses,
        pulse_repetition_frequency_hz=100.0,
        random=np.random.default_rng(0),
    )
    samples = point_echoes(
        np.zeros((1, 3)), np.ones(1), track.line_of_sight, waveform.frequencies_hz()
    )
    return PhaseHistory(samples=samples, frequency_hz=waveform.frequencies_hz(), track=track)


coefficients = st.lists(st.floats(-3, 3), max_size=4)


@settings(max_examples=25)
@given(
    seed=st.integers(0, 2**32 - 1),
    rms=st.tuples(st.floats(0, 2), st.floats(0, 0.5)),
    polynomials=st.tuples(coefficients, coefficients),
)
def test_errors_can_be_taken_out_again_and_turn_each_sample_as_stated(seed, rms, polynomials):
    model = PulseErrorModel(
        phase_rms_rad=rms[0],
        range_rms_m=rms[1],
        phase_polynomial_rad=polynomials[0],
        range_polynomial_m=polynomials[1],
    )
    history = point(pulses=16)
    disturbed, truth = with_pulse_errors(history, model, np.random.default_rng(seed))
    back = without_pulse_errors(disturbed, truth)
    assert np.abs(back.samples - history.samples).max() < 1e-5
    wavelength = SPEED_OF_LIGHT_M_PER_S / history.frequency_hz[5]
    turn = np.exp(1j * (truth.phase_rad - 4 * np.pi * truth.range_m / wavelength))
    assert np.abs(disturbed.samples[:, 5] - history.samples[:, 5] * turn).max() < 1e-5


def test_the_smooth_part_is_the_polynomial_over_the_pass():
    model = PulseErrorModel(phase_polynomial_rad=(1.0, 0.0, 2.0), range_polynomial_m=(0.0, 0.5))
    _, truth = with_pulse_errors(point(pulses=101), model, np.random.default_rng(0))
    place = np.linspace(-1, 1, 101)
    assert truth.phase_rad == pytest.approx(1 + 2 * place**2)
    assert truth.range_m == pytest.approx(0.5 * place, abs=1e-12)


def test_the_random_part_has_the_stated_size_and_no_memory():
    model = PulseErrorModel(phase_rms_rad=0.3, range_rms_m=0.02)
    errors = model.drawn(np.arange(20_000.0), np.random.default_rng(1))
    for values, rms in ((errors.phase_rad, 0.3), (errors.range_m, 0.02)):
        assert values.std() == pytest.approx(rms, rel=0.03)
        assert abs(np.corrcoef(values[1:], values[:-1])[0, 1]) < 0.03
    assert abs(np.corrcoef(errors.phase_rad, errors.range_m)[0, 1]) < 0.03


def test_a_translation_moves_the_image_along_range_and_random_phases_blur_it():
    history, settings_ = point(), ImagingSettings(shape=(128, 128))
    (still,) = frames(history, settings_)
    moved, _ = with_pulse_errors(
        history, PulseErrorModel(range_polynomial_m=(0.6,)), np.random.default_rng(0)
    )
    (shifted,) = frames(moved, settings_)
    before, after = (
        np.unravel_index(np.argmax(frame.amplitude), frame.shape) for frame in (still, shifted)
    )
    assert (after[0] - before[0], after[1] - before[1]) == (10, 0)
    shaken, _ = with_pulse_errors(
        history, PulseErrorModel(phase_rms_rad=1.0), np.random.default_rng(0)
    )
    (blurred,) = frames(shaken, settings_)
    # The coherent part of white phase noise is exp(−σ²/2).
    assert blurred.amplitude.max() / still.amplitude.max() == pytest.approx(np.exp(-0.5), abs=0.08)


def test_what_cannot_be_an_error_is_refused():
    with pytest.raises(ValueError, match="phase_rms_rad must be finite and not negative"):
        PulseErrorModel(phase_rms_rad=-1.0)
    with pytest.raises(ValueError, match="finite coefficients"):
        PulseErrorModel(range_polynomial_m=(0.0, np.inf))
    with pytest.raises(ValueError, match="Errors of 3 pulses do not belong to echoes of 16"):
        without_pulse_errors(
            point(pulses=16), PulseErrors(phase_rad=np.zeros(3), range_m=np.zeros(3))
        )
