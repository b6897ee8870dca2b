"""The interface for measurements: the book, its files, and the state that tells of both."""

import json
import time
from collections.abc import Iterator
from dataclasses import replace
from datetime import UTC, datetime, timedelta

import httpx
import numpy as np
import pytest

from app.playback import Playback
from app.source import NO_SOURCE
from core.experiments.demo import DEMO_ORBIT
from core.geometry.directions import direction_in_frames
from core.geometry.orbit import satellite_from_elements
from core.geometry.track import LineOfSightTrack
from core.radar.course import PassCourse, undivided_course
from tests.app.running import running
from tests.app.synthetic import SETTINGS, frames, source

EPOCH = datetime(2016, 3, 11, 15, 35, tzinfo=UTC)
SQUARE = [[60.0, 60.0], [60.0, 100.0], [100.0, 100.0], [100.0, 60.0]]


def end(*toward: float) -> dict:
    return {"kind": "part end", "near_m": [0, 0, 0], "toward": toward, "reach_m": 3}


SPAN = {"kind": "line feature", "name": "l₂ / span", "start": end(0, -1, 0), "end": end(0, 1, 0)}


def course() -> tuple[PassCourse, ...]:
    """A pass of six minutes, whose geometry nobody asks for."""
    time_s = np.linspace(0.0, 360.0, 50)
    angle = np.linspace(0.1, 3.0, 50)
    sight = np.column_stack([-np.cos(angle), 0 * angle, -np.sin(angle)])
    track = LineOfSightTrack(
        time_s=time_s,
        line_of_sight=sight,
        line_of_sight_rate_per_s=np.gradient(sight, time_s, axis=0),
        epoch_utc=EPOCH.isoformat().replace("+00:00", "Z"),
    )
    return (undivided_course(track, label="pass 1"),)


@pytest.fixture(scope="module")
def server() -> Iterator[httpx.Client]:
    """A workstation on eight frames of a pass whose orbit is known."""
    played = replace(
        source(8),
        frames=lambda: [replace(frame, label="pass 1") for frame in frames(8)],
        course=course,
        satellite=satellite_from_elements(DEMO_ORBIT),
    )
    with (
        running(played, SETTINGS, Playback(speed_hz=None)) as address,
        httpx.Client(base_url=address, trust_env=False, timeout=20) as page,
    ):
        wait(lambda: page.get("/api/state").json()["status"] == "finished")
        add(page, kind="volume")
        wait(lambda: "TEME" in page.get("/api/measurements").json()["frames"])
        yield page


@pytest.fixture
def page(server) -> httpx.Client:
    server.post("/api/measurements/clear")
    return server


def wait(condition):
    for _ in range(1000):
        if value := condition():
            return value
        time.sleep(0.01)
    raise AssertionError("the condition did not come true")


def add(page: httpx.Client, **spec: object) -> httpx.Response:
    return page.post("/api/measurements", json={"spec": spec})


def names(facts: dict) -> list[str]:
    return [item["name"] for item in facts["items"]]


def change(page: httpx.Client, name: str, **what: object) -> httpx.Response:
    return page.put("/api/measurements", json={"name": name, **what})


def take_in(page: httpx.Client, content: str | bytes, name: str = "m.json") -> httpx.Response:
    return page.post("/api/measurements/import", params={"name": name}, content=content)


def test_what_is_added_is_measured_on_the_hull_on_show(page) -> None:
    facts = add(page, **SPAN).json()
    state = page.get("/api/state").json()
    (item,) = facts["items"]
    assert (item["revision"], item["threshold"]) == (
        state["hull"]["revision"],
        state["hull"]["threshold"],
    )
    assert facts["revision"] == state["hull"]["revision"]
    assert 14 < item["value"] < 20
    assert (item["kind"], item["unit"], item["lost"]) == ("line feature", "m", None)
    assert (item["is_undirected"], item["observability"]) == (True, "good")
    assert np.linalg.norm(item["direction"]) == pytest.approx(1)
    cosines = np.cos(np.radians(item["angles_deg"]))
    np.testing.assert_allclose(cosines, np.abs(item["direction"]), atol=1e-9)
    assert state["measurements"]["items"][0] == item
    assert names(add(page, kind="volume").json()) == ["l₂ / span", "volume 1"]


def test_vectors_come_in_rtn_and_teme_at_the_time_of_the_frame_on_show(page) -> None:
    add(page, **SPAN)
    page.post("/api/shown", json={"frame": 3})
    item = page.get("/api/measurements").json()["items"][0]
    at_utc = EPOCH + timedelta(seconds=12.0)
    wanted = direction_in_frames(
        np.array(item["direction"]), satellite=satellite_from_elements(DEMO_ORBIT), at_utc=at_utc
    )
    assert item["epoch_utc"] == wanted.epoch_utc
    np.testing.assert_allclose(item["rtn"], wanted.rtn)
    np.testing.assert_allclose(item["teme"], wanted.teme)
    x, y, z = item["direction"]
    np.testing.assert_allclose(item["rtn"], [-z, x, -y])
    row = page.get("/api/measurements.json", params={"frame": "TEME"}).json()["measurements"][0]
    assert row["reading"]["frame"] == "TEME"
    assert row["reading"]["epoch_utc"] == wanted.epoch_utc
    np.testing.assert_allclose(row["reading"]["direction"], wanted.teme)
    page.post("/api/shown", json={"frame": None})


def test_the_book_is_renamed_hidden_annotated_replaced_and_taken_back(page) -> None:
    add(page, **SPAN)
    add(page, kind="volume", name="all")
    add(page, kind="scale factor", name="b", first="l₂ / span", second="l₂ / span")
    facts = change(page, "l₂ / span", rename="l₂", note="tip to tip", is_hidden=True).json()
    assert names(facts) == ["l₂", "all", "b"]
    assert (facts["items"][0]["note"], facts["items"][0]["is_hidden"]) == ("tip to tip", True)
    assert facts["items"][2]["refers_to"] == ["l₂", "l₂"]
    moved = {**SPAN, "start": end(1, 0, 0), "end": end(-1, 0, 0)}
    del moved["name"]
    after = change(page, "l₂", spec=moved).json()["items"][0]
    assert (after["note"], after["change"]) == ("tip to tip", None)
    assert after["value"] < facts["items"][0]["value"] - 2
    refused = page.delete("/api/measurements", params={"name": "l₂"})
    assert refused.status_code == 409
    assert refused.json()["detail"] == '"b" is computed from "l₂"; delete it too, or first.'
    gone = page.delete("/api/measurements", params={"name": "l₂", "along": True}).json()
    assert names(gone) == ["all"]
    back = page.post("/api/measurements/undo").json()
    assert names(back) == ["l₂", "all", "b"]
    assert back["items"][0]["value"] == after["value"]
    assert names(page.post("/api/measurements/redo").json()) == ["all"]
    assert page.post("/api/measurements/redo").status_code == 409
    assert page.post("/api/measurements/clear").json()["can_undo"]


@pytest.mark.parametrize("ending", ["json", "csv"])
def test_measurements_come_back_from_their_own_file_as_they_were(page, ending) -> None:
    add(page, **SPAN)
    add(page, kind="principal axes", name="axes")
    add(page, kind="section", name="cut", normal=[1, 0, 0])
    add(page, kind="angle between", name="turn", first="axes", second="l₂ / span")
    add(
        page, kind="length", name="lost", start=end(0, 1, 0), end={"kind": "key point", "name": "k"}
    )
    before = page.get("/api/measurements").json()["items"]
    written = page.get(f"/api/measurements.{ending}")
    page.post("/api/measurements/clear")
    after = take_in(page, written.content, f"m.{ending}").json()["items"]
    assert [{**item, "change": None} for item in before] == after
    assert page.get(f"/api/measurements.{ending}").text == written.text
    assert names(take_in(page, written.content, f"m.{ending}").json()) == [
        item["name"] for item in before
    ]


def test_an_edit_changes_numbers_with_their_revision(page) -> None:
    add(page, kind="volume", name="all")
    before = page.get("/api/measurements").json()["items"][0]
    frame = page.get("/api/frames/2").json()["silhouette"]
    order = {"rings": [SQUARE], "claim": "lit side", "tool": "vertex"}
    page.put("/api/frames/2/silhouette", json={**order, "base_revision": frame["revision"]})
    revision = page.get("/api/state").json()["hull"]["revision"]
    after = wait(
        lambda: (
            next(
                item
                for item in [page.get("/api/measurements").json()["items"][0]]
                if item["revision"] == revision
            )
            if page.get("/api/measurements").json()["revision"] == revision
            else None
        )
    )
    assert after["value"] < before["value"]
    assert after["change"] == after["value"] - before["value"]
    page.post("/api/frames/2/undo", json={"base_revision": frame["revision"] + 1})


def test_intervals_are_stated_when_asked_and_go_into_the_files(page) -> None:
    add(page, **SPAN)
    page.put("/api/measurements/intervals", json={"action": "start"})
    facts = wait(
        lambda: (f := page.get("/api/measurements").json())["items"][0]["low"] is not None and f
    )
    (item,) = facts["items"]
    assert item["low"] < item["value"] < item["high"]
    assert "95 % interval" in item["interval_note"]
    assert facts["intervals"]["is_running"] is False
    assert facts["hull"]["revision"] == facts["revision"]
    row = page.get("/api/measurements.json").json()["measurements"][0]["reading"]
    assert (row["low"], row["high"]) == (item["low"], item["high"])
    assert page.put("/api/measurements/intervals", json={"action": "cancel"}).status_code == 200


@pytest.mark.parametrize(
    ("spec", "words"),
    [
        ({"kind": "width"}, "is of kind 'width'; known are"),
        ({"kind": "length", "name": "a"}, 'lacks its field "start"'),
        ({"kind": "volume", "name": "taken"}, '2 measurements are called "taken"'),
        ({"kind": "volume", "name": ""}, "needs a name"),
        ({"kind": "scale factor", "first": "taken", "second": "x"}, 'refers to "x"'),
        ({"kind": "section", "normal": [0, 0, 0]}, "a length above zero"),
    ],
)
def test_what_cannot_be_measured_is_refused_in_words(page, spec, words) -> None:
    add(page, kind="volume", name="taken")
    answer = add(page, **spec)
    assert answer.status_code == 422
    assert words in answer.json()["detail"]
    assert names(page.get("/api/measurements").json()) == ["taken"]


def test_a_file_is_taken_in_whole_or_not_at_all(page) -> None:
    add(page, **SPAN)
    content = page.get("/api/measurements.json").json()
    reading = content["measurements"][0]["reading"]
    other = {"kind": "volume", "name": "volume", "note": "", "region": {"kind": "whole surface"}}
    for rows, words in (
        ([other, {**SPAN, "name": "x", "reading": {**reading, "frame": "ECI"}}], 'got "ECI"'),
        ([other, {**other, "name": SPAN["name"]}], "Nothing was imported"),
        ([other, other], '2 measurements are called "volume"'),
    ):
        answer = take_in(page, json.dumps({**content, "measurements": rows}))
        assert answer.status_code == 422
        assert words in answer.json()["detail"]
    assert "no JSON" in take_in(page, b"nothing").json()["detail"]
    assert "no text in UTF-8" in take_in(page, b"\xff\xfe", "m.csv").json()["detail"]
    assert names(page.get("/api/measurements").json()) == [SPAN["name"]]


def test_changes_that_cannot_be_leave_all_as_it_was(page) -> None:
    add(page, kind="volume", name="a")
    add(page, kind="volume", name="b")
    answer = change(page, "a", note="new", rename="b")
    assert '2 measurements are called "b"' in answer.json()["detail"]
    assert page.get("/api/measurements").json()["items"][0]["note"] == ""
    assert 'no measurement "z"' in change(page, "z", is_hidden=True).json()["detail"]
    assert 'no measurement "z"' in page.delete("/api/measurements?name=z").json()["detail"]
    assert page.get("/api/measurements.json?frame=ECI").status_code == 422


def test_without_a_hull_there_is_nothing_to_export_and_frames_need_an_orbit(client) -> None:
    with (
        running(NO_SOURCE, SETTINGS, Playback(speed_hz=None)) as address,
        httpx.Client(base_url=address, trust_env=False) as empty,
    ):
        answer = empty.get("/api/measurements.csv")
        assert (answer.status_code, answer.json()["detail"]) == (
            409,
            "There is nothing measured yet; wait for the first frame.",
        )
        facts = add(empty, kind="volume").json()
        assert (facts["revision"], facts["items"][0]["value"]) == (None, None)
    add(client, **SPAN)
    answer = client.get("/api/measurements.csv", params={"frame": "RTN"})
    assert answer.status_code == 409
    assert "this pass has no orbit" in answer.json()["detail"]
    client.post("/api/measurements/clear")
