import json

import numpy as np
import pytest
from httpx import Client

from app.facts import frame_facts
from app.snapshot import Record
from core.analysis.analysis import Analysis
from core.reconstruction import reconstruct
from tests.app.synthetic import SETTINGS, empty_frame, frames


def test_state_describes_the_source_and_the_hull(client: Client) -> None:
    state = client.get("/api/state").json()
    assert state["source"]["name"] == "synthetic body"
    assert state["frames"] == state["shown"] == state["hull"]["frames"] == 4
    assert state["hull"]["vertices"] > 100


def test_the_state_tells_where_each_frame_looks_and_where_it_is_blind(client: Client) -> None:
    state = client.get("/api/state").json()
    truth = list(frames(4))
    np.testing.assert_allclose(state["sights"], [frame.line_of_sight for frame in truth])
    blind = np.array(state["blind"])
    np.testing.assert_allclose(np.linalg.norm(blind, axis=1), 1)
    for direction, frame in zip(blind, truth, strict=True):
        np.testing.assert_allclose(frame.projection.matrix[:, :3] @ direction, 0, atol=1e-12)


def test_a_frame_tells_its_circumstances(client: Client) -> None:
    frame = client.get("/api/frames/2").json()
    truth = list(frames(4))[1]
    assert frame["time_s"] == 6.0
    assert frame["shape"] == list(truth.shape)
    np.testing.assert_allclose(frame["line_of_sight"], truth.line_of_sight)
    np.testing.assert_allclose(frame["origin_px"], [80, 80])
    elevation, azimuth = np.radians([frame["theta_deg"], frame["phi_deg"]])
    k = [np.cos(elevation) * np.sin(azimuth), np.cos(elevation) * np.cos(azimuth)]
    np.testing.assert_allclose([*k, np.sin(elevation)], truth.line_of_sight, atol=1e-12)
    assert frame["silhouette"]["rings"]
    assert frame["hull"]["frames"] == 2
    assert frame["silhouette"]["vote_repair"] == ""


def test_an_unbounded_extent_has_no_number(client: Client) -> None:
    hull = client.get("/api/frames/1").json()["hull"]
    assert any(not extent["is_bounded"] for extent in hull["extents"])
    for extent in hull["extents"]:
        assert (extent["value_m"] is None) == (not extent["is_bounded"])
    assert hull["volume_m3"] is None
    assert hull["unobserved"] is not None


def test_principal_lines_come_with_the_hull_that_they_measure(client: Client) -> None:
    first = client.get("/api/frames/1").json()["hull"]
    assert (first["views"], first["lines"]) == (1, [])
    hull = client.get("/api/state").json()["hull"]
    assert (hull["frames"], hull["views"]) == (4, 4)
    truth = list(reconstruct(frames(4), SETTINGS))[-1].lines
    assert len(truth) == 3
    for shown, line in zip(hull["lines"], truth, strict=True):
        assert shown["name"] == line.name
        assert shown["length_m"] == pytest.approx(line.length_m)
        np.testing.assert_allclose(shown["direction"], line.direction)


def test_a_frame_that_shows_no_target_says_so() -> None:
    analysis = Analysis(SETTINGS)
    analysed = analysis.receive(empty_frame())
    facts = frame_facts(Record(analysed=analysed, hull=analysis.hull))
    assert facts["note"] == "frame 1 shows no target and does not vote"
    assert facts["hull"]["views"] == 0
    assert facts["hull"]["is_empty"]


def test_an_image_gives_the_levels_back(client: Client) -> None:
    response = client.get("/api/frames/3/image")
    shape = int(response.headers["X-Rows"]), int(response.headers["X-Columns"])
    numbers = np.frombuffer(response.content, dtype="<u2").reshape(shape)
    floor_db, step_db = (float(response.headers[name]) for name in ("X-Floor-dB", "X-Step-dB"))
    truth = list(frames(4))[2].decibels(floor_db=floor_db)
    np.testing.assert_allclose(floor_db + numbers * step_db, truth, atol=step_db)


def test_speed_and_choice_are_obeyed(client: Client) -> None:
    assert client.post("/api/playback", json={"speed_hz": 2}).json()["speed_hz"] == 2
    assert client.post("/api/playback", json={"speed_hz": None}).json()["speed_hz"] is None
    shown = client.post("/api/shown", json={"frame": 1}).json()
    assert (shown["shown"], shown["following"], shown["hull"]["frames"]) == (1, False, 4)
    assert client.post("/api/shown", json={"frame": None}).json()["following"]


@pytest.mark.parametrize(
    ("request_line", "body", "status", "sentence"),
    [
        ("GET /api/frames/9", None, 404, "There is no frame 9; 4 have arrived so far, from 1."),
        ("GET /api/frames/x", None, 422, "The request is not understood: path → number"),
        ("POST /api/shown", {"frame": 0}, 404, "frame 0 cannot be shown"),
        ("POST /api/playback", {"action": "stop"}, 422, "body → action: Input should be 'play'"),
        ("POST /api/playback", {"speed_hz": 1e9}, 422, "between 0.05 and 100 frames per second"),
        ("POST /api/playback", {"file": "/etc/passwd"}, 422, "body → file"),
        ("GET /nowhere", None, 404, "There is nothing at /nowhere."),
        ("DELETE /api/state", None, 405, "DELETE is not possible at /api/state."),
    ],
)
def test_bad_requests_get_one_sentence(client, request_line, body, status, sentence) -> None:
    response = client.request(*request_line.split(), json=body)
    assert response.status_code == status
    assert sentence in response.json()["detail"]
    assert "\n" not in response.json()["detail"]


def test_the_live_link_sends_the_state_now_and_after_changes(client: Client, link) -> None:
    with link("/api/live") as live:
        assert json.loads(live.recv(5))["frames"] == 4
        client.post("/api/shown", json={"frame": 2})
        assert json.loads(live.recv(5))["shown"] == 2
        client.post("/api/shown", json={"frame": None})
        assert json.loads(live.recv(5))["following"]


def test_the_interface_is_described_and_no_page_pulls_from_elsewhere(client: Client) -> None:
    assert "/api/state" in client.get("/openapi.json").json()["paths"]
    assert client.get("/docs").status_code == 404
    assert client.get("/redoc").status_code == 404
