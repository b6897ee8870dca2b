import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.geometry.spin import Spin
from core.geometry.track import LineOfSightTrack

vectors = st.tuples(*[st.floats(-1, 1)] * 3).filter(lambda v: np.linalg.norm(v) > 0.1)


def unit(vector):
    return np.array(vector) / np.linalg.norm(vector)


def orbiting(time_s, first, second):
    """A line of sight that turns by 0.01 rad/s in inertial space, and its rate."""
    across = unit(np.cross(first, second))
    angle = 0.01 * time_s[:, None]
    return (
        np.cos(angle) * first + np.sin(angle) * across,
        0.01 * (np.cos(angle) * across - np.sin(angle) * first),
    )


@given(vectors, st.floats(-0.5, 0.5), st.floats(-100, 100))
def test_an_attitude_is_a_rotation_that_keeps_the_axis(axis, rate, time_s):
    spin = Spin(axis=np.array(axis), rate_rad_per_s=rate)
    (attitude,) = spin.attitude(np.array([time_s]))
    assert attitude @ attitude.T == pytest.approx(np.eye(3), abs=1e-12)
    assert np.linalg.det(attitude) == pytest.approx(1)
    assert attitude @ spin.axis == pytest.approx(spin.axis, abs=1e-12)


@given(vectors, st.floats(-0.5, 0.5))
def test_lines_of_sight_are_turned_back_and_their_rate_is_their_derivative(axis, rate):
    spin = Spin(axis=np.array(axis), rate_rad_per_s=rate)
    time_s, step_s = np.array([-31.0, 0.0, 12.5]), 1e-4
    first, second = unit([1, 2, -1]), unit([0, 1, 3])
    sight, moving = spin.lines_of_sight(time_s, *orbiting(time_s, first, second))
    inertial, _ = orbiting(time_s, first, second)
    assert np.einsum("nij,nj->ni", spin.attitude(time_s), sight) == pytest.approx(inertial)
    ahead, behind = (
        spin.lines_of_sight(at, *orbiting(at, first, second))[0]
        for at in (time_s + step_s, time_s - step_s)
    )
    assert moving == pytest.approx((ahead - behind) / (2 * step_s), abs=1e-7)


def test_at_time_0_the_target_frame_is_the_inertial_one_and_turns_by_the_right_hand():
    spin = Spin(axis=np.array([0, 0, 2.0]), rate_rad_per_s=np.pi / 2)
    attitudes = spin.attitude(np.array([0.0, 1.0]))
    assert attitudes[0] == pytest.approx(np.eye(3))
    assert attitudes[1] @ [1, 0, 0] == pytest.approx([0, 1, 0])


@given(vectors, st.floats(-0.4, 0.4), st.floats(-0.4, 0.4))
def test_a_tilt_is_the_angle_between_the_axes(axis, first, second):
    spin = Spin(axis=np.array(axis), rate_rad_per_s=0.05)
    changed = spin.changed(np.array([first, second]), 1.1)
    assert spin.axis_angle_rad(changed) == pytest.approx(np.hypot(first, second), abs=1e-9)
    assert changed.rate_rad_per_s == pytest.approx(0.055)


def test_a_track_keeps_all_but_its_directions():
    time_s = np.linspace(0, 1, 5)
    sight, rate = orbiting(time_s, unit([1, 2, -1]), unit([0, 1, 3]))
    inertial = LineOfSightTrack(
        time_s=time_s,
        line_of_sight=sight,
        line_of_sight_rate_per_s=rate,
        range_m=np.full(5, 7e5),
        epoch_utc="2024-05-21T15:48:00Z",
    )
    track = Spin(axis=np.array([1.0, 0, 0]), rate_rad_per_s=0.1).target_track(inertial)
    assert track.line_of_sight[0] == pytest.approx(sight[0])
    assert not np.allclose(track.line_of_sight[-1], sight[-1])
    assert np.array_equal(track.range_m, inertial.range_m)
    assert track.epoch_utc == inertial.epoch_utc


def test_a_spin_without_an_axis_is_refused():
    with pytest.raises(ValueError, match="axis with a length above zero"):
        Spin(axis=np.zeros(3), rate_rad_per_s=0.1)
