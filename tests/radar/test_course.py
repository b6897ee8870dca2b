from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.experiments.demo import demo_courses, demo_intervals
from core.geometry.track import random_views_track, track_from_angles
from core.radar.course import MOST_SAMPLES, course_of_echoes, pass_course, undivided_course
from core.radar.imaging import ImagingSettings, assessed_intervals, frames
from core.radar.intervals import Division
from core.radar.phase_history import PhaseHistory
from core.radar.waveform import Waveform

WAVEFORM = Waveform()
DIVISION = Division(wavelength_m=0.018, cross_range_resolution_m=0.15)


def turning(turn_rad, bend, pulses=3000, duration_s=100.0, power=2):
    """A line of sight that turns unevenly and leaves its plane."""
    share = np.linspace(0, 1, pulses)
    return track_from_angles(
        duration_s * share, 0.8 + bend * share**power, turn_rad * (share + share**2) / 2
    )


@settings(max_examples=25, deadline=None)
@given(turn_rad=st.floats(0.3, 2.0), bend=st.floats(-0.4, 0.4), pulses=st.integers(500, 4000))
def test_the_rotation_rate_is_the_angle_between_lines_of_sight_over_time(turn_rad, bend, pulses):
    course = undivided_course(turning(turn_rad, bend, pulses))
    assert len(course.time_s) == min(pulses, MOST_SAMPLES)
    ahead, behind = course.line_of_sight[1:], course.line_of_sight[:-1]
    angle_rad = 2 * np.arcsin(np.linalg.norm(ahead - behind, axis=1) / 2)
    between = (course.rotation_rate_rad_per_s[1:] + course.rotation_rate_rad_per_s[:-1]) / 2
    np.testing.assert_allclose(angle_rad / np.diff(course.time_s), between, rtol=2e-3)


def silent(track):
    """Echoes of nothing at all."""
    frequency_hz = WAVEFORM.frequencies_hz()
    samples = np.zeros((len(track), len(frequency_hz)), dtype=np.complex64)
    return PhaseHistory(samples=samples, frequency_hz=frequency_hz, track=track)


@settings(max_examples=8, deadline=None)
@given(
    bend=st.floats(0.1, 0.4),
    radius_m=st.sampled_from([None, 4.0, 9.0]),
    criterion=st.sampled_from(["angles", "bending", "motion"]),
    overlap=st.sampled_from([0.0, 0.5]),
)
def test_verdicts_are_those_of_the_imaging(bend, radius_m, criterion, overlap):
    wanted = ImagingSettings(target_radius_m=radius_m, criterion=criterion, overlap=overlap)
    history = silent(turning(0.5, bend, pulses=2500))
    course = course_of_echoes(history, wanted, label="pass 4")
    assert course.label == "pass 4"
    assert [each.assessed for each in course.intervals] == [*assessed_intervals(history, wanted)]


def test_every_image_finds_its_own_interval():
    wanted = ImagingSettings(target_radius_m=6.0, criterion="bending", shape=(16, 16), overlap=0.5)
    history = silent(turning(0.5, 0.25, pulses=1500))
    course = course_of_echoes(history, wanted)
    used = [each for each in course.intervals if each.assessed.used is not None]
    assert used
    images = list(frames(history, wanted))
    assert len(images) == len(used)
    for image, interval in zip(images, used, strict=True):
        assert course.interval_at(image.time_s) is interval
        assert interval.start_s <= interval.imaged_start_s <= interval.middle_s
        assert interval.middle_s <= interval.imaged_stop_s <= interval.stop_s


def test_resolution_is_what_the_interval_around_a_time_can_be_sharp_to():
    division = replace(DIVISION, target_radius_m=6.0, criterion="bending")
    course = pass_course(turning(1.2, 0.7, power=16), division)
    statuses = {each.assessed.verdict.status for each in course.intervals}
    assert statuses == {"accepted", "shortened", "rejected"}
    for time_s, resolution_m in zip(course.time_s, course.resolution_m, strict=True):
        interval = course.interval_at(float(time_s))
        if interval is None or interval.assessed.used is None:
            assert np.isnan(resolution_m)
        else:
            assert resolution_m == interval.assessed.verdict.resolution_m


def test_between_bursts_there_is_neither_interval_nor_resolution():
    track = random_views_track(
        views=3,
        turn_rad=DIVISION.wanted_rad,
        pulses_per_view=100,
        pulse_repetition_frequency_hz=100.0,
        random=np.random.default_rng(0),
    )
    course = pass_course(track, DIVISION)
    assert len(course.intervals) == 3
    assert course.interval_at(1.5) is None
    assert course.azimuth_rad is None
    assert np.isfinite(course.resolution_m).all()


def test_the_demo_has_a_course_of_each_pass_and_an_interval_of_each_frame():
    courses = demo_courses()
    assert [course.label for course in courses] == ["pass 1", "pass 2", "pass 3"]
    for number, track, interval in demo_intervals(WAVEFORM):
        found = courses[number - 1].interval_at(float(track.time_s[interval.middle]))
        assert found is not None
        assert found.imaged == interval
    verdicts = {each.assessed.verdict.status for each in courses[0].intervals}
    assert verdicts == {"accepted", "shortened"}
    highest_deg = [np.degrees(course.elevation_rad.max()) for course in courses]
    assert highest_deg == pytest.approx([42, 57, 84], abs=1)


def test_a_course_of_unequal_lengths_is_refused():
    course = undivided_course(turning(0.5, 0.1))
    with pytest.raises(ValueError, match=r"resolution_m: wanted an array of shape 400, got"):
        replace(course, resolution_m=np.zeros(3))
