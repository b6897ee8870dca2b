"""Another source loaded while the workstation runs: the demo's stand-in, and uploaded files."""

import os
import tempfile
import time
from collections.abc import Iterator

import httpx
import pytest

from app import source_api
from app.gate import LARGEST_UPLOADS_BYTES
from app.playback import Playback
from app.source import NO_SOURCE
from app.source_api import shown_name
from core.formats.pass_file import RecordedPass, write_pass
from tests.app.running import running
from tests.app.synthetic import SETTINGS, frames, source
from tests.app.test_gate import status_of

FILE = {"Content-Type": "application/octet-stream"}
SQUARE = [[60.0, 60.0], [60.0, 100.0], [100.0, 100.0], [100.0, 60.0]]


@pytest.fixture
def page() -> Iterator[httpx.Client]:
    """A client of a workstation that began without a source."""
    with (
        running(NO_SOURCE, SETTINGS, Playback(speed_hz=None)) as address,
        httpx.Client(base_url=address, trust_env=False) as page,
    ):
        yield page


@pytest.fixture(scope="module")
def pass_bytes(tmp_path_factory) -> bytes:
    path = tmp_path_factory.mktemp("passes") / "three.h5"
    write_pass(path, RecordedPass(frames=tuple(frames(3))))
    return path.read_bytes()


def finished(page: httpx.Client) -> dict:
    for _ in range(1000):
        state = page.get("/api/state").json()
        if state["status"] in ("finished", "failed"):
            return state
        time.sleep(0.02)
    raise AssertionError(state)


def load(page: httpx.Client, content: bytes, name: str = "three.h5") -> httpx.Response:
    return page.post("/api/source", params={"name": name}, content=content, headers=FILE)


def temporary_folders() -> set[str]:
    return {name for name in os.listdir(tempfile.gettempdir()) if name.startswith("radarhull-")}


def test_a_workstation_without_a_source_waits_and_plays_what_is_loaded(page, pass_bytes) -> None:
    before = temporary_folders()
    state = page.get("/api/state").json()
    assert (state["status"], state["frames"], state["hull"]) == ("empty", 0, None)
    for action in ("play", "step", "restart", "pause"):
        page.post("/api/playback", json={"action": action})
        assert page.get("/api/state").json()["status"] == "empty"
    loaded = load(page, pass_bytes, "../evil/../three.h5")
    assert loaded.status_code == 200
    assert loaded.json()["source"]["name"] == "three.h5"
    state = finished(page)
    assert (state["status"], state["frames"]) == ("finished", 3)
    assert temporary_folders() == before


def test_an_edit_that_was_meant_for_another_source_is_refused(page, pass_bytes) -> None:
    load(page, pass_bytes)
    first = finished(page)
    order = {"rings": [SQUARE], "claim": "lit side", "tool": "vertex", "base_revision": 0}
    stale = page.get("/api/frames/2").json()["silhouette"]["revision"]
    edited = page.put("/api/frames/1/silhouette", json={**order, "base_revision": stale})
    assert edited.json()["silhouette"]["edited"]
    load(page, pass_bytes)
    second = finished(page)
    assert second["run"] > first["run"]
    assert second["source"]["key"] != first["source"]["key"]
    assert second["hull"]["revision"] > first["hull"]["revision"]
    assert [info["edited"] for info in second["frames_info"]] == [False, False, False]
    late = page.put("/api/frames/2/silhouette", json={**order, "base_revision": stale})
    assert late.status_code == 409


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (b"", "0 bytes came"),
        (b"no HDF5 at all", "bad.h5 is not a whole HDF5 file"),
        (None, "bad.h5 is not a whole HDF5 file: it is cut short"),
    ],
)
def test_a_file_that_cannot_be_played_leaves_everything_as_it_was(
    page, pass_bytes, content, sentence
) -> None:
    before = page.get("/api/state").json()
    refused = load(page, pass_bytes[:-4000] if content is None else content, "bad.h5")
    assert refused.status_code == 422
    assert sentence in refused.json()["detail"]
    assert "/tmp" not in refused.json()["detail"]
    assert page.get("/api/state").json() == before


def test_what_is_neither_file_nor_demo_is_refused(page) -> None:
    assert page.post("/api/source", json={"demo": False}).status_code == 422
    assert page.post("/api/source", json={"demo": 1}).status_code == 422
    assert page.post("/api/source", json={"path": "/etc/passwd"}).status_code == 422
    assert page.post("/api/source", json=[0] * 10_000).status_code == 422
    as_text = page.post("/api/source", content=b"x", headers={"Content-Type": "text/plain"})
    assert as_text.status_code == 415
    foreign = page.post("/api/source", json={"demo": True}, headers={"Origin": "http://evil"})
    assert foreign.status_code == 403
    assert page.get("/api/state").json()["status"] == "empty"


def test_the_demo_is_loaded_by_name(page, monkeypatch) -> None:
    monkeypatch.setattr(source_api, "demo_source", lambda: source(2))
    loaded = page.post("/api/source", json={"demo": True}).json()
    assert loaded["source"]["name"] == "synthetic body"
    assert finished(page)["frames"] == 2


def test_a_full_disk_refuses_before_it_is_full(page, pass_bytes, monkeypatch) -> None:
    monkeypatch.setattr(source_api, "SPARE_BYTES", 2**60)
    refused = load(page, pass_bytes)
    assert refused.status_code == 507
    assert "free some space" in refused.json()["detail"]


def test_one_file_is_taken_in_at_a_time_and_the_next_after_it_was_given_up(
    page, pass_bytes
) -> None:
    before = temporary_folders()
    refused = []

    def pieces() -> Iterator[bytes]:
        yield pass_bytes[:1000]
        with httpx.Client(base_url=page.base_url, trust_env=False) as other:
            for _ in range(200):
                answer = load(other, pass_bytes)
                if answer.status_code == 409:
                    break
                time.sleep(0.01)
            refused.append(answer)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        page.post("/api/source", content=pieces(), headers=FILE)
    assert "Another pass file is being loaded" in refused[0].json()["detail"]
    for _ in range(200):
        if load(page, pass_bytes).status_code == 200:
            break
        time.sleep(0.01)
    assert finished(page)["frames"] == 3
    assert temporary_folders() == before


@pytest.mark.parametrize(
    ("name", "shown"),
    [
        ("pass.h5", "pass.h5"),
        ("/etc/passwd", "passwd"),
        ("C:\\data\\pass 7.h5", "pass 7.h5"),
        ("", "uploaded pass"),
        ("a\n\x1b[31mb\u202e.h5", "a[31mb.h5"),
        ("..", ".."),
        ("x" * 500, "x" * 80),
    ],
)
def test_a_foreign_name_is_only_shown(name, shown) -> None:
    assert shown_name(name) == shown


def test_uploads_have_limits_of_their_own() -> None:
    for path, most in LARGEST_UPLOADS_BYTES.items():
        host = ("host", "localhost")
        assert status_of(host, ("content-length", str(most)), path=path) == 200
        assert status_of(host, ("content-length", str(most + 1)), path=path) == 413
        assert status_of(host, ("content-length", str(most)), path="/api/playback") == 413
