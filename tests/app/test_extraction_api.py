"""The target is detected in all frames anew, and that can be taken back."""

import time
from collections.abc import Iterator
from dataclasses import replace

import httpx
import pytest

from app.playback import Playback
from app.stream import LiveStream
from tests.app.running import running
from tests.app.synthetic import SETTINGS, source


@pytest.fixture(scope="module")
def page() -> Iterator[httpx.Client]:
    with (
        running(source(3), SETTINGS, Playback(speed_hz=None)) as address,
        httpx.Client(base_url=address, trust_env=False) as page,
    ):
        for _ in range(1000):
            if page.get("/api/state").json()["status"] == "finished":
                break
            time.sleep(0.02)
        yield page


def outlines(page: httpx.Client) -> list:
    return [page.get(f"/api/frames/{n}").json()["silhouette"]["rings"] for n in (1, 2, 3)]


def test_detecting_again_keeps_edited_outlines_and_is_taken_back(page) -> None:
    silhouette = page.get("/api/frames/2").json()["silhouette"]
    order = {name: silhouette[name] for name in ("claim", "component")}
    square = [[[60.0, 60.0], [60.0, 100.0], [100.0, 100.0], [100.0, 60.0]]]
    order |= {"rings": square, "tool": "vertex", "base_revision": silhouette["revision"]}
    page.put("/api/frames/2/silhouette", json=order)
    before, serial = outlines(page), page.get("/api/state").json()["serial"]
    asked = {"a2": 15.0, "closing_px": 3}
    counted = page.post("/api/extraction", json={**asked, "only_counts": True}).json()
    assert counted == {"changed": [1, 3], "kept": [2], "state": None}
    assert (outlines(page), page.get("/api/state").json()["serial"]) == (before, serial)
    done = page.post("/api/extraction", json=asked).json()
    assert (done["changed"], done["kept"]) == ([1, 3], [2])
    after = outlines(page)
    assert after[1] == square
    assert after[0] != before[0]
    assert done["state"]["hull"]["frames"] == 3
    back = page.post("/api/extraction/undo").json()
    assert back["changed"] == [1, 3]
    assert outlines(page) == before
    overwritten = page.post("/api/extraction", json={**asked, "overwrites_edited": True}).json()
    assert (overwritten["changed"], overwritten["kept"]) == ([1, 2, 3], [])
    page.post("/api/extraction/undo")
    assert outlines(page) == before
    refused = page.post("/api/extraction/undo")
    assert refused.status_code == 409
    assert "no detection in all frames to take back" in refused.json()["detail"]


@pytest.mark.parametrize(
    ("order", "sentence"),
    [
        ({"a1": 0}, "a1: Input should be greater than 0"),
        ({"closing_px": 100}, "closing_px: Input should be less than or equal to 99"),
        ({"overwrite": True}, "overwrite: Extra inputs are not permitted"),
    ],
)
def test_settings_that_cannot_be_are_refused_in_a_sentence(page, order, sentence) -> None:
    refused = page.post("/api/extraction", json=order)
    assert refused.status_code == 422
    assert sentence in refused.json()["detail"]


def test_frames_that_come_later_are_detected_by_the_new_settings(wait_for) -> None:
    stream = LiveStream(source(2), SETTINGS, playback=Playback(is_playing=False))
    stream.start()
    try:
        stream.step()
        wait_for(lambda: len(stream.snapshot.records) == 1)
        extraction = replace(stream.snapshot.settings.extraction, closing_px=9)
        stream.edit(lambda analysis: analysis.extract_again(extraction))
        stream.step()
        wait_for(lambda: len(stream.snapshot.records) == 2)
        found = [record.silhouette.provenance for record in stream.snapshot.records]
        assert all("closing 9 px" in provenance for provenance in found)
    finally:
        stream.stop()
