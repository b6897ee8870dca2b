from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.geometry.bistatic import bistatic_track
from core.geometry.track import track_from_angles

TIME_S = np.linspace(0, 2, 401)


def single(elevation_rad, azimuth_rad, turn_rad=0.1):
    """A radar past which the target turns at a growing rate."""
    return track_from_angles(
        TIME_S, elevation_rad + 0.01 * TIME_S, azimuth_rad + turn_rad * TIME_S * (1 + TIME_S) / 6
    )


@given(elevation_rad=st.floats(-1, 1), apart_rad=st.floats(0, 2), turn_rad=st.floats(0.05, 0.3))
def test_the_one_radar_has_the_pairs_delay_and_its_rate(elevation_rad, apart_rad, turn_rad):
    sender, receiver = single(elevation_rad, 0.2), single(-0.1, 0.2 + apart_rad, turn_rad)
    pair = bistatic_track(sender, receiver)
    delay = (sender.line_of_sight + receiver.line_of_sight) / 2
    assert np.abs(pair.phase_direction() - delay).max() < 1e-12
    half_angle = np.arccos(np.sum(sender.line_of_sight * receiver.line_of_sight, axis=1)) / 2
    assert np.abs(pair.bisector_scale - np.cos(half_angle)).max() < 1e-6
    by_difference = np.gradient(pair.line_of_sight, TIME_S, axis=0, edge_order=2)
    assert np.abs(pair.line_of_sight_rate_per_s - by_difference).max() < 1e-4
    assert pair.part(3, 9).bisector_scale.tolist() == pair.bisector_scale[3:9].tolist()


def test_a_radar_paired_with_itself_is_itself():
    alone = single(0.3, 0.2)
    pair = bistatic_track(alone, alone)
    assert np.abs(pair.phase_direction() - alone.line_of_sight).max() < 1e-12
    assert pair.bisector_scale == pytest.approx(1)


def test_pulses_that_do_not_belong_together_are_refused():
    alone = single(0.3, 0.2)
    pair = bistatic_track(alone, single(0.3, 0.6))
    for other, wanted in (
        (alone.part(0, 100), "401 of the transmitter and 100"),
        (replace(alone, epoch_utc="2016-03-11T00:00:00"), "epochs"),
        (replace(alone, time_s=TIME_S + 0.01), "0.01 s apart"),
        (pair, "not of pairs"),
    ):
        with pytest.raises(ValueError, match=wanted):
            bistatic_track(alone, other)


def test_forward_scattering_is_refused():
    ahead = single(0.0, 0.0)
    behind = replace(
        ahead,
        line_of_sight=-ahead.line_of_sight,
        line_of_sight_rate_per_s=-ahead.line_of_sight_rate_per_s,
    )
    with pytest.raises(ValueError, match=r"reaches 180\.0°"):
        bistatic_track(ahead, behind)


def test_a_scale_that_no_angle_has_is_refused():
    alone = single(0.3, 0.2)
    for value in (0.0, 1.5):
        with pytest.raises(ValueError, match="above 0 and reach at most 1"):
            replace(alone, bisector_scale=np.full(len(TIME_S), value))
