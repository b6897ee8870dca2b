import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.geometry.track import angles_from_line_of_sight, line_of_sight_from_angles
from core.radar.circular_sar import (
    NearFieldSettings,
    body_waveform,
    circular_track,
    late_m,
    near_field_echoes,
    near_field_frames,
    simulate_near_field,
    sub_apertures,
)
from core.radar.phase_history import PhaseHistory
from core.radar.scatterers import surface_scatterers
from core.radar.waveform import SPEED_OF_LIGHT_M_PER_S
from core.targets import tiangong_like

FREQUENCY_HZ = body_waveform().frequencies_hz()


def _short_track(range_m=6.0):
    """One sub-aperture's arc in the middle of 120°."""
    whole = circular_track(range_m=range_m)
    return whole.part(449, 575)


def _frame(points_m, track):
    samples = near_field_echoes(points_m, np.ones(len(points_m), complex), track, FREQUENCY_HZ)
    history = PhaseHistory(samples=samples, frequency_hz=FREQUENCY_HZ, track=track)
    return next(near_field_frames(history))


def _axes(track):
    middle = len(track) // 2
    k, rate = track.line_of_sight[middle], track.line_of_sight_rate_per_s[middle]
    across = rate / np.linalg.norm(rate)
    return k, across, np.cross(k, across)


def test_the_antenna_goes_round_at_one_height():
    track = circular_track(range_m=6.0, elevation_rad=0.5, middle_azimuth_rad=0.3, pulses=200)
    antenna_m = -track.range_m[:, None] * track.line_of_sight
    np.testing.assert_allclose(antenna_m[:, 2], -6.0 * np.sin(0.5))
    np.testing.assert_allclose(np.hypot(*antenna_m[:, :2].T), 6.0 * np.cos(0.5))
    _, azimuth = angles_from_line_of_sight(track.line_of_sight)
    assert np.ptp(azimuth) * 200 / 199 == pytest.approx(np.deg2rad(120))
    assert azimuth.mean() == pytest.approx(0.3)
    slope = np.gradient(track.line_of_sight, track.time_s, axis=0)[1:-1]
    np.testing.assert_allclose(track.line_of_sight_rate_per_s[1:-1], slope, atol=1e-4)


@pytest.mark.parametrize("change", [{"range_m": 0.0}, {"pulses": 2}, {"elevation_rad": 1.6}])
def test_a_senseless_circle_is_refused(change):
    with pytest.raises(ValueError, match="A circular track needs"):
        circular_track(**{"range_m": 5.0, **change})


@given(seed=st.integers(0, 2**32 - 1), points=st.integers(0, 20), count=st.integers(2, 33))
@settings(max_examples=25)
def test_echoes_are_the_exact_sum_over_points(seed, points, count):
    random = np.random.default_rng(seed)
    track = circular_track(range_m=3.0, pulses=7)
    position_m = random.uniform(-1, 1, (points, 3))
    amplitude = random.normal(size=points) + 1j * random.normal(size=points)
    frequency_hz = np.linspace(24e9, 30e9, count)
    antenna_m = -track.range_m[:, None] * track.line_of_sight
    distance_m = np.linalg.norm(position_m[None] - antenna_m[:, None], axis=-1)
    beyond_m = distance_m - track.range_m[:, None]
    wavenumber = 4 * np.pi / SPEED_OF_LIGHT_M_PER_S * frequency_hz
    exact = np.einsum("p,npf->nf", amplitude, np.exp(-1j * beyond_m[..., None] * wavenumber))
    echoes = near_field_echoes(position_m, amplitude, track, frequency_hz)
    np.testing.assert_allclose(echoes, exact, atol=2e-5 * max(np.abs(amplitude).sum(), 1))


def test_echoes_need_to_know_how_far_the_radar_is():
    track = circular_track(range_m=3.0, pulses=7)
    far = type(track)(
        time_s=track.time_s,
        line_of_sight=track.line_of_sight,
        line_of_sight_rate_per_s=track.line_of_sight_rate_per_s,
    )
    with pytest.raises(ValueError, match="how far the radar is"):
        near_field_echoes(np.zeros((1, 3)), np.ones(1, complex), far, FREQUENCY_HZ)


def test_120_degrees_make_eight_sub_apertures_of_the_wanted_resolution():
    track = circular_track(range_m=6.0)
    history = PhaseHistory(
        samples=np.zeros((len(track), 128)), frequency_hz=FREQUENCY_HZ, track=track
    )
    intervals = sub_apertures(history, NearFieldSettings())
    assert len(intervals) == 8
    for interval in intervals:
        reached_m = history.wavelength_m / (2 * interval.turn_rad)
        assert reached_m == pytest.approx(0.025, rel=0.01)


@pytest.mark.parametrize(
    ("along_m", "across_m"), [(0.9, 0.3), (-0.9, 0.3), (-0.9, -0.35), (0.4, -0.2)]
)
def test_a_point_of_the_plane_lands_within_half_a_pixel_unmirrored(along_m, across_m):
    track = _short_track()
    k, across, _ = _axes(track)
    frame = _frame((along_m * k + across_m * across)[None], track)
    assert frame.shape == (383, 160)
    row, column = np.unravel_index(np.argmax(frame.amplitude), frame.shape)
    assert row == pytest.approx(191 + along_m / 0.005, abs=0.5)
    assert column == pytest.approx(80 + across_m / 0.005, abs=0.5)
    assert frame.amplitude.max() == pytest.approx(1.0, abs=0.01)


@pytest.mark.parametrize("height_m", [0.3, -0.5])
def test_a_point_off_the_plane_comes_late_by_what_is_stated(height_m):
    track = _short_track()
    k, across, normal = _axes(track)
    point_m = 0.4 * k - 0.2 * across + height_m * normal
    frame = _frame(point_m[None], track)
    row, column = np.unravel_index(np.argmax(frame.amplitude), frame.shape)
    added_m = late_m(frame, 6.0, point_m)
    assert added_m == pytest.approx(height_m**2 / (2 * 6.4), rel=0.01)
    at = frame.projection.image_points(point_m)
    assert row == pytest.approx(at[0] + added_m / 0.005, abs=0.51)
    assert column == pytest.approx(at[1], abs=0.51)


def test_a_body_is_shaded_and_seen_by_the_arc():
    random = np.random.default_rng(0)
    body = tiangong_like(length_m=1.6, diameter_m=0.4, span_m=0.6, panel_width_m=0.2)
    scatterers = surface_scatterers(body, count=1000, random=random)
    track = circular_track(range_m=6.0, pulses=64)
    history = simulate_near_field(
        scatterers, track, body_waveform(), signal_to_noise_db=200.0, random=random
    )
    power = np.square(np.abs(history.samples)).mean()
    assert 0.2 < power / scatterers.mean_echo_power() < 2
    far = tiangong_like()
    with pytest.raises(ValueError, match=r"more than the waveform's unambiguous 3\.20 m"):
        simulate_near_field(
            surface_scatterers(far, count=50, random=random),
            track,
            body_waveform(),
            signal_to_noise_db=20.0,
            random=random,
        )


def test_the_middle_line_of_sight_is_the_papers():
    track = circular_track(range_m=6.0, elevation_rad=0.4, pulses=3)
    np.testing.assert_allclose(
        track.line_of_sight[1], line_of_sight_from_angles(np.array(0.4), np.array(0.0))
    )
