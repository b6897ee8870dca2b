from dataclasses import replace
from datetime import UTC, datetime
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.experiments.demo import DEMO_STATION
from core.formats.element_sets import read_element_sets
from core.geometry.orbit import line_of_sight_track, passes, satellite_from_tle
from core.geometry.track import (
    LineOfSightTrack,
    angles_from_line_of_sight,
    random_views_track,
    track_from_angles,
)
from core.radar.focus import quadratic_phase
from core.radar.intervals import Division, assess, divide, usable
from core.radar.unsuitable import unsuitable_parts

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


def near_the_zenith(pulses=6000):
    """A straight flight over a station that it misses by a twentieth of its height."""
    time = np.linspace(-2.0, 2.0, pulses)
    vector = np.stack([time, np.full(pulses, 0.05), np.full(pulses, -1.0)], axis=1)
    line_of_sight = vector / np.linalg.norm(vector, axis=1, keepdims=True)
    return track_from_angles(50 * time, *angles_from_line_of_sight(line_of_sight))


def test_the_zenith_part_is_named_as_unsuitable():
    track = near_the_zenith()
    division = Division(
        wavelength_m=WAVELENGTH_M, cross_range_resolution_m=0.2, target_radius_m=8.0
    )
    assessed = assess(track, division)
    names = [part.name for part in unsuitable_parts(track, assessed)]
    assert "zenith part" in names
    (zenith,) = [p for p in unsuitable_parts(track, assessed) if p.name == "zenith part"]
    assert zenith.start_s < 0 < zenith.stop_s
    assert zenith.stop_s - zenith.start_s < 20
    assert "more than π/4; a sharp image would have" in zenith.reason
    # The line of sight itself does not bend there, so polar format loses nothing.
    by_bending = assess(track, replace(division, criterion="bending"))
    assert all(each.verdict.status == "accepted" for each in by_bending)


@pytest.mark.parametrize("criterion", ["angles", "motion"])
def test_what_is_used_is_sharp_and_what_is_rejected_would_be_too_coarse(criterion):
    track = near_the_zenith()
    division = Division(
        wavelength_m=WAVELENGTH_M,
        cross_range_resolution_m=0.2,
        target_radius_m=8.0,
        criterion=criterion,
        coarsest_resolution_m=0.35,
    )
    assessed = assess(track, division)
    seen = {each.verdict.status for each in assessed}
    assert {"shortened", "rejected"} <= seen
    for each in assessed:
        if each.used is None:
            assert each.verdict.resolution_m > 0.35
            continue
        phase = quadratic_phase(
            track, each.used.start, each.used.stop, wavelength_m=WAVELENGTH_M, target_radius_m=8.0
        )
        assert phase.left_by(criterion) <= np.pi / 4
        reached_m = WAVELENGTH_M / (2 * each.used.turn_rad)
        assert each.verdict.resolution_m == pytest.approx(reached_m)
        assert each.wanted.start <= each.used.start < each.used.stop <= each.wanted.stop
        assert (each.verdict.status == "accepted") == (each.used == each.wanted)
    assert usable(assessed) == divide(
        track,
        wavelength_m=WAVELENGTH_M,
        cross_range_resolution_m=0.2,
        target_radius_m=8.0,
        criterion=criterion,
        coarsest_resolution_m=0.35,
    )


def test_a_pass_that_is_nowhere_sharp_is_refused_with_what_could_be_had():
    with pytest.raises(ValueError, match=r"None of \d+ intervals can be sharp.* would have 0\.\d"):
        divide(
            near_the_zenith(),
            wavelength_m=WAVELENGTH_M,
            cross_range_resolution_m=0.1,
            target_radius_m=30.0,
        )


def test_without_a_target_size_all_is_accepted():
    track = near_the_zenith()
    assessed = assess(track, Division(wavelength_m=WAVELENGTH_M, cross_range_resolution_m=0.2))
    assert {each.verdict.status for each in assessed} == {"accepted"}
    assert unsuitable_parts(track, assessed) == ()


def test_every_frame_of_tiangong_1s_pass_has_the_wanted_resolution(shared_data):
    satellite = satellite_from_tle(
        *read_element_sets(shared_data("tiangong1") / "tiangong1.tle")[1]
    )
    (first, *_) = passes(
        satellite,
        DEMO_STATION,
        start_utc=datetime(2016, 3, 11, 17, tzinfo=UTC),
        duration_s=3600.0,
        elevation_mask_rad=np.deg2rad(10),
    )
    track = line_of_sight_track(
        satellite,
        DEMO_STATION,
        start_utc=first.rise_utc,
        duration_s=first.duration_s,
        pulse_repetition_frequency_hz=100.0,
    )
    for overlap in (0.0, 0.5):
        intervals = divide(
            track, wavelength_m=WAVELENGTH_M, cross_range_resolution_m=0.15, overlap=overlap
        )
        reached = np.array([WAVELENGTH_M / (2 * each.turn_rad) for each in intervals])
        assert np.abs(reached / 0.15 - 1).max() < 0.01
        shared = [(a.stop - b.start) / (a.stop - a.start) for a, b in pairwise(intervals)]
        assert np.median(shared) == pytest.approx(overlap, abs=0.06)


@pytest.mark.parametrize(
    ("wrong", "told"),
    [
        ({"wavelength_m": 0.0}, "positive wavelength"),
        ({"cross_range_resolution_m": -1.0}, "positive wavelength and resolution"),
        ({"overlap": 1.0}, "overlap of 0 to below 1"),
        ({"target_radius_m": 0.0}, "target_radius_m must be positive"),
        ({"coarsest_resolution_m": np.nan}, "coarsest_resolution_m must be positive"),
    ],
)
def test_senseless_divisions_are_refused(wrong, told):
    asked = {"wavelength_m": WAVELENGTH_M, "cross_range_resolution_m": 0.15, **wrong}
    with pytest.raises(ValueError, match=told):
        divide(sweep(1.0), **asked)


def test_a_pass_of_two_pulses_is_refused():
    line_of_sight = np.array([[1.0, 0, 0], [np.cos(0.1), np.sin(0.1), 0]])
    track = LineOfSightTrack(
        time_s=[0.0, 1.0],
        line_of_sight=line_of_sight,
        line_of_sight_rate_per_s=[[0, 0.1, 0], [-0.01, 0.1, 0]],
    )
    with pytest.raises(ValueError, match="holds fewer than 8 pulses"):
        divide(track, wavelength_m=WAVELENGTH_M, cross_range_resolution_m=0.15)
