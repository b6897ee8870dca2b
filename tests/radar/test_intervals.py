from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.geometry.track import random_views_track, track_from_angles
from core.radar.intervals import divide

WAVELENGTH_M = 0.018


def sweep(turn_rad, pulses=2000):
    """A line of sight that first turns slowly, then fast."""
    time = np.linspace(0, 1, pulses)
    return track_from_angles(100 * time, np.zeros(pulses), turn_rad * time**2)


@settings(max_examples=30, deadline=None)
@given(resolution_m=st.floats(0.1, 0.5), overlap=st.floats(0, 0.8))
def test_every_interval_has_the_wanted_resolution(resolution_m, overlap):
    track = sweep(1.0)
    intervals = divide(
        track,
        wavelength_m=WAVELENGTH_M,
        cross_range_resolution_m=resolution_m,
        overlap=overlap,
    )
    reached = [WAVELENGTH_M / (2 * interval.turn_rad) for interval in intervals]
    # The coarsest turn between two pulses is 1e-3 rad.
    assert reached == pytest.approx([resolution_m] * len(reached), rel=0.06)
    assert all(a.start <= b.start for a, b in pairwise(intervals))
    assert intervals[-1].stop == len(track)
    assert all(each.start <= each.middle < each.stop for each in intervals)


def test_bursts_made_for_one_interval_give_one_each():
    turn = WAVELENGTH_M / 0.3
    track = random_views_track(
        views=5,
        turn_rad=turn,
        pulses_per_view=64,
        pulse_repetition_frequency_hz=100.0,
        random=np.random.default_rng(0),
    )
    intervals = divide(track, wavelength_m=WAVELENGTH_M, cross_range_resolution_m=0.15)
    assert [(each.start, each.stop) for each in intervals] == [
        (64 * view, 64 * view + 64) for view in range(5)
    ]


def test_too_little_turn_is_refused_with_both_angles():
    with pytest.raises(ValueError, match=r"turn by 3\.44°, but it turns by at most 0\.57°"):
        divide(sweep(0.01), wavelength_m=WAVELENGTH_M, cross_range_resolution_m=0.15)


def test_pulses_too_sparse_for_an_interval_are_refused_with_what_can_be_had():
    with pytest.raises(ValueError, match=r"holds fewer than 8 pulses; a resolution of .* or finer"):
        divide(sweep(1.0, pulses=50), wavelength_m=WAVELENGTH_M, cross_range_resolution_m=1.0)
