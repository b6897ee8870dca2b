"""Laws of image formation: axes, signs, and the equality of fast and slow."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.experiments.demo import demo_tracks
from core.geometry.track import random_views_track
from core.radar.echoes import point_echoes
from core.radar.imaging import ImagingSettings, interval_frame, whole_interval
from core.radar.intervals import divide
from core.radar.phase_history import PhaseHistory
from core.radar.waveform import Waveform

WAVEFORM = Waveform(frequency_count=128, pulse_repetition_frequency_hz=40.0)
METHODS = ("polar", "keystone", "range-doppler", "backprojection")
CORNERS = np.array([[0.0, 0, 0], [4.0, 0, 0], [0, 2.5, 1.0], [-1.0, -2.0, 3.0]])
STRENGTHS = np.array([1.0, 1.3, 1.7, 2.2])


def history(track, points, amplitudes):
    frequency = WAVEFORM.frequencies_hz()
    echoes = point_echoes(
        np.asarray(points), np.asarray(amplitudes, dtype=complex), track.line_of_sight, frequency
    )
    return PhaseHistory(samples=echoes, frequency_hz=frequency, track=track)


def from_a_random_side(seed, resolution_m=0.15, pulses=160):
    return random_views_track(
        views=1,
        turn_rad=WAVEFORM.wavelength_m / (2 * resolution_m),
        pulses_per_view=pulses,
        pulse_repetition_frequency_hz=100.0,
        random=np.random.default_rng(seed),
    )


@pytest.fixture(scope="module")
def tracks():
    return demo_tracks(WAVEFORM)


@pytest.mark.parametrize("method", METHODS)
@settings(max_examples=8)
@given(seed=st.integers(0, 2**16))
def test_no_method_mirrors_an_axis_from_any_side(method, seed):
    """Four unlike points: each must stand where the projection of the true body says."""
    # At 0.3 m even plain range-Doppler keeps points within 4 m.
    echoes = history(from_a_random_side(seed, resolution_m=0.3), CORNERS, STRENGTHS)
    imaging = ImagingSettings(method=method, shape=(128, 128), pixel_spacing_m=0.1)
    frame = interval_frame(echoes, whole_interval(echoes), imaging)
    places = frame.projection.image_points(CORNERS)
    apart = np.linalg.norm(places[:, None] - places[None], axis=-1)
    for place, strength, others in zip(places, STRENGTHS, apart, strict=True):
        if np.sort(others)[1] > 12:  # 1.2 m: no other point's main lobe is near
            row, column = np.round(place).astype(int)
            near = frame.amplitude[row - 1 : row + 2, column - 1 : column + 2]
            assert near.max() == pytest.approx(strength, rel=0.25)


@pytest.mark.parametrize("method", METHODS)
def test_no_method_mirrors_an_axis_along_any_real_pass(method, tracks):
    imaging = ImagingSettings(method=method, shape=(96, 96), pixel_spacing_m=0.15)
    for track in tracks:
        intervals = divide(track, wavelength_m=WAVEFORM.wavelength_m, cross_range_resolution_m=0.45)
        for interval in intervals[:: len(intervals) // 3]:
            echoes = history(track.part(interval.start, interval.stop), CORNERS, STRENGTHS)
            frame = interval_frame(echoes, interval.alone(), imaging)
            rows, columns = np.round(frame.projection.image_points(CORNERS[[3]])[0]).astype(int)
            seen = frame.amplitude[rows - 1 : rows + 2, columns - 1 : columns + 2].max()
            mirrored = frame.amplitude[
                (95 - rows, rows, 95 - rows), (columns, 95 - columns, 95 - columns)
            ]
            assert seen > 1.5
            assert seen > 2 * np.median(mirrored)


@settings(max_examples=8)
@given(seed=st.integers(0, 2**16), count=st.integers(1, 12))
def test_polar_format_and_keystone_equal_back_projection(seed, count):
    """Within 2 %: back-projection's interpolation and the keystone's curve take 1 % each."""
    random = np.random.default_rng(seed)
    track = from_a_random_side(seed)
    amplitude = random.normal(size=count) + 1j * random.normal(size=count)
    echoes = history(track, random.uniform(-4, 4, (count, 3)), amplitude)
    shape = (72, 72)
    made = {
        method: interval_frame(
            echoes,
            whole_interval(echoes),
            ImagingSettings(method=method, shape=shape, pixel_spacing_m=0.15),
        ).amplitude
        for method in ("polar", "keystone", "backprojection")
    }
    allowed = 0.02 * np.abs(amplitude).sum()
    assert np.abs(made["polar"] - made["backprojection"]).max() < allowed
    assert np.abs(made["keystone"] - made["backprojection"]).max() < allowed


@settings(max_examples=25)
@given(
    number=st.integers(0, 2),
    share=st.floats(0.01, 0.98),
    point=st.lists(st.floats(-9, 9), min_size=3, max_size=3).map(np.array),
)
def test_doppler_is_the_finite_difference_of_range_along_real_passes(tracks, number, share, point):
    """f_d = −(2/λ) dR/dt, from true distances to a radar at −range·k; curvature leaves |p|²/R."""
    track = tracks[number]
    pulse = int(share * (len(track) - 20))
    around = track.part(pulse, pulse + 11)
    radar_m = -around.range_m[:, None] * around.line_of_sight
    distance_m = np.linalg.norm(point - radar_m, axis=1) - around.range_m
    dopplers_hz = -2 / WAVEFORM.wavelength_m * np.gradient(distance_m, around.time_s)
    predicted_hz = -2 / WAVEFORM.wavelength_m * (around.line_of_sight_rate_per_s @ point)
    assert dopplers_hz[5] == pytest.approx(predicted_hz[5], abs=2e-3)


def test_the_echoes_phase_turns_with_the_doppler(tracks):
    """The simulated echo of a point that recedes turns backwards, at −(2/λ) dR/dt hertz."""
    track = tracks[1].part(8000, 8040)
    point = np.array([3.0, -2.0, 1.0])
    echo = history(track, [point], [1.0]).samples[:, 64]
    frequency_hz = WAVEFORM.frequencies_hz()[64]
    turning_hz = np.diff(np.unwrap(np.angle(echo))) / np.diff(track.time_s) / (2 * np.pi)
    rate = track.line_of_sight_rate_per_s[:-1] @ point
    wanted_hz = -2 * frequency_hz / 299_792_458.0 * rate
    np.testing.assert_allclose(turning_hz, wanted_hz, atol=0.02)
