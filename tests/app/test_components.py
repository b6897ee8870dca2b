"""Parts of the target through the interface: outlines and hulls of their own."""

import csv
import io
import time
from collections.abc import Iterator

import httpx
import pytest

from app.playback import Playback
from tests.app.running import running
from tests.app.synthetic import SETTINGS, source

KNIFE = [[70.0, 70.0], [70.0, 90.0], [90.0, 90.0], [90.0, 70.0]]


@pytest.fixture(scope="module")
def page() -> Iterator[httpx.Client]:
    with (
        running(source(4), SETTINGS, Playback(speed_hz=None)) as address,
        httpx.Client(base_url=address, trust_env=False) as page,
    ):
        for _ in range(1000):
            if state(page)["status"] == "finished":
                break
            time.sleep(0.02)
        yield page


@pytest.fixture(autouse=True)
def none_left(page: httpx.Client) -> Iterator[None]:
    yield
    for part in state(page)["components"]:
        page.delete("/api/components", params={"component": part["label"]}).raise_for_status()


def state(page: httpx.Client) -> dict:
    return page.get("/api/state").json()


def facts(page: httpx.Client, number: int, label: str = "target") -> dict:
    return page.get(f"/api/frames/{number}", params={"component": label}).json()


def draw(page, number, label="knife", rings=(KNIFE,), what="silhouette") -> httpx.Response:
    present = facts(page, number, label)["silhouette"]
    order = {
        "rings": list(rings),
        "claim": "complete",
        "component": label,
        "tool": "polygon",
        "base_revision": present["revision"],
    }
    return page.put(f"/api/frames/{number}/{what}", json=order)


def step(page, number, label, direction="undo") -> httpx.Response:
    base = facts(page, number, label)["silhouette"]["revision"]
    body = {"component": label, "base_revision": base}
    return page.post(f"/api/frames/{number}/{direction}", json=body)


def test_a_part_gets_its_own_hull_and_leaves_the_whole_as_it_was(page) -> None:
    before = state(page)
    assert before["components"] == []
    whole = facts(page, 1)
    undrawn = facts(page, 1, "knife")
    assert undrawn["silhouette"]["rings"] == []
    assert undrawn["note"] == "frame 1 shows no knife and does not vote"
    for number in (1, 2, 3):
        shown = draw(page, number).json()
        assert shown["silhouette"]["rings"] == [KNIFE]
        assert shown["silhouette"]["component"] == "knife"
    after = state(page)
    (knife,) = after["components"]
    assert (knife["label"], knife["colour"]) == ("knife", "#e69f00")
    assert (knife["hull"]["views"], knife["hull"]["threshold"]) == (3, 3)
    assert 0 < knife["hull"]["volume_m3"] < before["hull"]["volume_m3"]
    assert len(knife["hull"]["lines"]) == 3
    assert knife["hull"]["revision"] > after["hull"]["revision"] == before["hull"]["revision"]
    assert after["hull"] == before["hull"]
    assert after["residuals"] == before["residuals"]
    assert [info["components"] for info in after["frames_info"]] == [
        *3 * [["target", "knife"]],
        ["target"],
    ]
    assert facts(page, 1)["silhouette"] == whole["silhouette"]
    assert facts(page, 1)["others"] == [
        {"component": "knife", "colour": "#e69f00", "rings": [KNIFE]}
    ]
    (other,) = facts(page, 1, "knife")["others"]
    assert (other["component"], other["colour"]) == ("target", "#a8b8cc")


def test_a_place_is_told_once_the_hulls_are_quiet(page, wait_for) -> None:
    for number in (1, 2, 3):
        draw(page, number)
    (knife,) = state(page)["components"]
    assert knife["has_place"]
    assert knife["place"] is None
    (knife,) = wait_for(lambda: [c for c in state(page)["components"] if c["place"]])
    assert len(knife["place"]["offset_m"]) == 3
    assert 0 < knife["place"]["volume_share"] < 1
    draw(page, 3, rings=[])
    (other,) = state(page)["components"]
    assert other["place"] is None


def test_undo_redo_and_stale_edits_are_of_one_layer(page) -> None:
    draw(page, 2)
    revision = facts(page, 2, "knife")["silhouette"]["revision"]
    whole = facts(page, 2)["silhouette"]
    assert not whole["can_undo"]
    assert step(page, 2, "target").status_code == 409
    assert step(page, 2, "knife").json()["silhouette"]["rings"] == []
    assert state(page)["components"] == []
    assert state(page)["frames_info"][1]["revisions"]["knife"] == revision + 1
    assert step(page, 2, "knife", "redo").json()["silhouette"]["rings"] == [KNIFE]
    assert facts(page, 2)["silhouette"] == whole
    late = {"rings": [], "claim": "complete", "component": "knife", "base_revision": revision}
    refused = page.put("/api/frames/2/silhouette", json=late)
    assert refused.status_code == 409


def test_a_preview_of_a_part_shows_in_its_hull_and_in_no_other(page) -> None:
    before = state(page)["hull"]
    draw(page, 3, what="preview")
    (knife,) = state(page)["components"]
    assert knife["hull"]["is_preview"]
    assert knife["place"] is None
    assert state(page)["hull"] == before
    assert page.get("/api/export/measurements.json").status_code == 409
    ended = page.delete("/api/frames/3/preview", params={"component": "knife"}).json()
    assert ended["silhouette"]["component"] == "knife"
    assert state(page)["components"] == []


def test_proposals_and_reprojection_are_of_the_layer(page) -> None:
    draw(page, 1)
    draw(page, 2)
    body = {"tool": "copy", "component": "knife", "parameters": {"from": 2}}
    copied = page.post("/api/frames/3/proposals", json=body).json()
    assert len(copied["rings"]) == 1
    assert copied["claim"] == "complete"
    body = {"tool": "copy", "component": "knife", "parameters": {"from": 3}}
    assert page.post("/api/frames/1/proposals", json=body).json()["note"] == (
        "Frame 3 shows no knife."
    )
    seen = page.get("/api/frames/1/reprojection", params={"component": "knife"}).json()
    assert seen["revision"] == state(page)["components"][0]["hull"]["revision"]
    assert 0 < seen["overlap"] <= 1
    grown = {**body, "tool": "smooth", "parameters": {}}
    assert "draw one first" in page.post("/api/frames/3/proposals", json=grown).json()["detail"]


@pytest.mark.parametrize("kind", ["coco.json", "labelme.zip", "masks.zip"])
def test_a_part_comes_back_from_a_file_of_outlines(page, kind) -> None:
    square = [[69.5, 69.5], [69.5, 90.5], [90.5, 90.5], [90.5, 69.5]]
    draw(page, 2, rings=[square])
    exported = page.get(f"/api/export/silhouettes-{kind}").content
    step(page, 2, "knife")
    revisions = [info["revision"] for info in state(page)["frames_info"]]
    taken = page.post(
        "/api/silhouettes",
        content=exported,
        params={"name": kind},
        headers={"Content-Type": "application/octet-stream"},
    ).json()
    assert taken == {"changed": [2], "unchanged": [1, 3, 4]}
    again = facts(page, 2, "knife")["silhouette"]
    # A mask says of a square of 21 pixels that its corners are cut.
    assert again["area_px"] == pytest.approx(441, abs=1)
    assert again["provenance"] == f"imported from {kind}"
    assert [info["revision"] for info in state(page)["frames_info"]] == revisions


def test_a_part_s_hull_is_exported_under_its_name_and_revision(page) -> None:
    draw(page, 1, "solar panel")
    draw(page, 2, "solar panel")
    hull = state(page)["components"][0]["hull"]
    answer = page.get("/api/export/hull.stl", params={"component": "solar panel"})
    name = f"synthetic-body-rev{hull['revision']}-solar-panel-hull.stl"
    assert f'filename="{name}"' in answer.headers["Content-Disposition"]
    assert len(answer.content) == 84 + 50 * hull["faces"]
    refused = page.get("/api/export/hull.stl", params={"component": "boom"})
    assert (refused.status_code, "boom" in refused.json()["detail"]) == (409, True)


def test_measurements_are_exported_with_their_component_and_its_hull(page) -> None:
    draw(page, 1)
    draw(page, 2)
    (knife,) = state(page)["components"]
    assert page.get("/api/export/measurements.json").json()["components"] == [knife]
    rows = list(csv.DictReader(io.StringIO(page.get("/api/export/measurements.csv").text)))
    volumes = {row["name"]: row for row in rows if row["kind"] == "hull volume"}
    assert set(volumes) == {"volume", "knife: volume"}
    assert volumes["knife: volume"]["revision"] == str(knife["hull"]["revision"])
    assert volumes["volume"]["revision"] == str(state(page)["hull"]["revision"])


def test_a_part_is_deleted_from_all_frames_and_comes_back_by_undo(page) -> None:
    for number in (1, 4):
        draw(page, number, "solar  panel")
    assert state(page)["components"][0]["label"] == "solar panel"
    gone = page.delete("/api/components", params={"component": "solar panel"}).json()
    assert gone["components"] == []
    assert step(page, 4, "solar panel").json()["silhouette"]["rings"] == [KNIFE]
    assert state(page)["components"][0]["hull"]["views"] == 1
    for label in ("boom", "target"):
        refused = page.delete("/api/components", params={"component": label})
        assert refused.status_code == 422
        assert "No frame has an outline of a part" in refused.json()["detail"]


@pytest.mark.parametrize("label", ["", "  ", "x" * 41, "a\u0007b"])
def test_a_name_that_nobody_can_read_is_refused(page, label) -> None:
    answer = page.get("/api/frames/1", params={"component": label})
    assert answer.status_code == 422
    assert "label has 1 to 40 printable characters" in answer.json()["detail"]


def test_a_part_keeps_its_colour_whatever_comes_or_goes(page) -> None:
    draw(page, 1, "knife")
    draw(page, 1, "a new one")
    shown = page.get("/api/viewport").json()["components"]
    assert [each["label"] for each in shown] == ["target", "a new one", "knife"]
    assert shown[0]["colour"] == "#a8b8cc"
    colours = {each["label"]: each["colour"] for each in shown}
    page.delete("/api/components", params={"component": "knife"})
    (part,) = state(page)["components"]
    assert part["colour"] == colours["a new one"]
    step(page, 1, "knife")
    assert facts(page, 1, "knife")["colour"] == colours["knife"]
