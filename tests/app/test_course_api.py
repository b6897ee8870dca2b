from collections.abc import Iterator
from dataclasses import replace

import httpx
import numpy as np
import pytest

from app.course_facts import interval_facts, pass_facts
from app.playback import Playback
from app.sources import pass_source
from core.formats.pass_file import RecordedPass, write_pass
from core.radar.course import PassCourse, undivided_course
from core.radar.imaging import frame_count
from tests.app.courses import COURSE, track
from tests.app.running import running
from tests.app.synthetic import SETTINGS, frames, source
from tests.radar.test_course import silent


@pytest.fixture(scope="module")
def client() -> Iterator[httpx.Client]:
    """A workstation whose source knows the course of its pass, of which no frame is shown yet."""
    known = replace(source(2), course=lambda: (COURSE,))
    with (
        running(known, SETTINGS, Playback(is_playing=False)) as address,
        httpx.Client(base_url=address, trust_env=False) as client,
    ):
        yield client


def test_a_pass_is_told_over_time_with_the_verdict_on_each_interval(client: httpx.Client) -> None:
    (facts,) = client.get("/api/course").json()["passes"]
    assert facts["label"] == "pass 1"
    assert "6 m about the origin" in facts["judged"]
    samples = len(facts["time_s"])
    for name in ("azimuth_deg", "elevation_deg", "theta_deg", "rotation_rate_deg_s"):
        assert len(facts[name]) == samples, name
    np.testing.assert_allclose(
        np.radians(facts["rotation_rate_deg_s"]), COURSE.rotation_rate_rad_per_s, atol=1e-7
    )
    assert COURSE.elevation_rad is not None
    np.testing.assert_allclose(np.radians(facts["elevation_deg"]), COURSE.elevation_rad, atol=1e-5)
    gaps = [value is None for value in facts["resolution_m"]]
    assert gaps == np.isnan(COURSE.resolution_m).tolist()
    assert any(gaps)
    assert [each["verdict"] for each in facts["intervals"]] == [
        each.assessed.verdict.status for each in COURSE.intervals
    ]
    rejected = next(each for each in facts["intervals"] if each["verdict"] == "rejected")
    assert "more than π/4" in rejected["reason"]
    assert rejected["start_s"] < rejected["middle_s"] < rejected["stop_s"]


def test_a_source_without_a_track_has_no_course() -> None:
    assert source(2).course() == ()


def test_a_pass_without_a_station_has_the_angles_of_the_target_frame_alone() -> None:
    facts = pass_facts(undivided_course(track(station=False), label="x"))
    assert facts["azimuth_deg"] is None
    assert facts["elevation_deg"] is None
    assert facts["phi_deg"][-1] > facts["phi_deg"][0]
    assert facts["intervals"] == []
    assert facts["judged"] == ""
    assert set(facts["resolution_m"]) == {None}


def test_a_frame_finds_its_interval_by_pass_and_time() -> None:
    (shown,) = frames(1)
    interval = COURSE.intervals[3]
    of_pass = replace(shown, time_s=interval.middle_s, label="pass 1")
    facts = interval_facts(of_pass, (COURSE,))
    assert facts is not None
    assert facts["verdict"] == interval.assessed.verdict.status
    assert facts["pulses"] == interval.imaged.stop - interval.imaged.start
    assert facts["start_s"] < of_pass.time_s < facts["stop_s"]
    for each in COURSE.intervals:
        of_each = interval_facts(replace(of_pass, time_s=each.middle_s), (COURSE,))
        assert of_each is not None
        assert ("blurs" in of_each["in_words"]) is (of_each["verdict"] != "accepted")
    assert interval_facts(replace(of_pass, label="pass 2"), (COURSE,)) is None
    assert interval_facts(replace(of_pass, time_s=1e6), (COURSE,)) is None
    assert interval_facts(replace(of_pass, sensor="optical"), (COURSE,)) is None


def test_a_pass_file_of_echoes_gives_its_course_once(tmp_path) -> None:
    history = silent(track(pulses=1500))
    path = tmp_path / "pass.h5"
    write_pass(path, RecordedPass(history=history))
    read = pass_source(path)
    (course,) = read.course()
    assert isinstance(course, PassCourse)
    assert len(course.intervals) == frame_count(history) == read.expected_frames
    assert read.course()[0] is course
    write_pass(path, RecordedPass(history=history, frames=tuple(frames(2))))
    (course,) = pass_source(path).course()
    assert course.intervals == ()
