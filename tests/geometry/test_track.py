import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.geometry.track import (
    LineOfSightTrack,
    accumulated_turn_rad,
    angles_from_line_of_sight,
    line_of_sight_from_angles,
    random_views_track,
    track_from_angles,
)

angle = st.floats(-1.5, 1.5)


@given(elevation=angle, azimuth=st.floats(-3.1, 3.1))
def test_angles_and_line_of_sight_are_inverse(elevation, azimuth):
    line_of_sight = line_of_sight_from_angles(elevation, azimuth)
    assert np.linalg.norm(line_of_sight) == pytest.approx(1)
    assert angles_from_line_of_sight(line_of_sight) == (
        pytest.approx(elevation, abs=1e-7),
        pytest.approx(azimuth, abs=1e-7),
    )


def test_line_of_sight_follows_equation_3():
    elevation, azimuth = 0.3, 1.1
    expected = (
        np.cos(0.3) * np.sin(1.1),
        np.cos(0.3) * np.cos(1.1),
        np.sin(0.3),
    )
    assert line_of_sight_from_angles(elevation, azimuth) == pytest.approx(expected)


@given(
    rate=st.floats(0.001, 0.05), elevation_rate=st.floats(-0.02, 0.02), start=st.floats(-1.0, 1.0)
)
def test_rate_of_a_table_of_angles_is_the_derivative(rate, elevation_rate, start):
    time = np.linspace(0, 20, 2001)
    elevation = start + elevation_rate * time
    azimuth = rate * time
    track = track_from_angles(time, elevation, azimuth)
    sin_e, cos_e = np.sin(elevation), np.cos(elevation)
    sin_a, cos_a = np.sin(azimuth), np.cos(azimuth)
    analytic = np.stack(
        [
            -elevation_rate * sin_e * sin_a + rate * cos_e * cos_a,
            -elevation_rate * sin_e * cos_a - rate * cos_e * sin_a,
            elevation_rate * cos_e,
        ],
        axis=1,
    )
    assert np.abs(track.line_of_sight_rate_per_s - analytic).max() < 1e-7


def test_random_views_turn_by_the_wanted_angle_about_a_fixed_axis():
    track = random_views_track(
        views=7,
        turn_rad=0.06,
        pulses_per_view=64,
        pulse_repetition_frequency_hz=100.0,
        random=np.random.default_rng(3),
    )
    bursts = track.bursts()
    assert len(bursts) == 7
    for start, stop in bursts:
        part = track.part(start, stop)
        assert accumulated_turn_rad(part.line_of_sight)[-1] == pytest.approx(0.06 * 63 / 64)
        numeric = np.gradient(part.line_of_sight, part.time_s, axis=0, edge_order=2)
        assert np.abs(numeric - part.line_of_sight_rate_per_s)[2:-2].max() < 1e-6


def test_a_track_that_stands_still_is_refused():
    still = np.tile([1.0, 0.0, 0.0], (5, 1))
    with pytest.raises(ValueError, match="stands still"):
        LineOfSightTrack(
            time_s=np.arange(5.0), line_of_sight=still, line_of_sight_rate_per_s=np.zeros((5, 3))
        )


def test_times_that_run_backwards_are_refused():
    with pytest.raises(ValueError, match=r"Pulse times must grow; pulse 2 comes at 0\.5 s"):
        LineOfSightTrack(
            time_s=[0.0, 1.0, 0.5],
            line_of_sight=np.tile([1.0, 0.0, 0.0], (3, 1)),
            line_of_sight_rate_per_s=np.tile([0.0, 1.0, 0.0], (3, 1)),
        )
