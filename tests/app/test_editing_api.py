"""Two pages edit one workstation through the interface."""

import time
from collections.abc import Iterator

import httpx
import numpy as np
import pytest

from app.playback import Playback
from core.hull.drawing import MOST_VERTICES
from core.silhouettes.silhouette import clockwise_area_px
from tests.app.running import running
from tests.app.synthetic import SETTINGS, source

SQUARE = [[60.0, 60.0], [60.0, 100.0], [100.0, 100.0], [100.0, 60.0]]


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    with running(source(4), SETTINGS, Playback(speed_hz=None)) as address:
        for _ in range(1000):
            if httpx.get(f"{address}/api/state", trust_env=False).json()["status"] == "finished":
                break
            time.sleep(0.02)
        yield address


@pytest.fixture
def page(address: str) -> Iterator[httpx.Client]:
    with httpx.Client(base_url=address, trust_env=False) as page:
        yield page


def state(page: httpx.Client) -> dict:
    return page.get("/api/state").json()


def outline(page: httpx.Client, number: int, **change: object) -> dict:
    """Return the order that commits the frame's present outline, changed."""
    present = page.get(f"/api/frames/{number}").json()["silhouette"]
    order = {name: present[name] for name in ("rings", "claim", "component")}
    return {**order, "tool": "vertex", "base_revision": present["revision"], **change}


def put(page: httpx.Client, number: int, order: dict, what: str = "silhouette") -> httpx.Response:
    return page.put(f"/api/frames/{number}/{what}", json=order)


def undo(page: httpx.Client, number: int, step: str = "undo") -> httpx.Response:
    revision = page.get(f"/api/frames/{number}").json()["silhouette"]["revision"]
    return page.post(f"/api/frames/{number}/{step}", json={"base_revision": revision})


def test_an_edit_is_followed_by_the_hull_and_can_be_undone(page) -> None:
    before = state(page)
    whole = page.get("/api/frames/1").json()["silhouette"]
    order = outline(page, 1, rings=[SQUARE])
    frame = put(page, 1, order).json()
    assert frame["silhouette"]["rings"] == [SQUARE]
    assert frame["silhouette"]["edited"]
    assert frame["silhouette"]["can_undo"]
    assert frame["silhouette"]["revision"] == order["base_revision"] + 1
    after = state(page)
    assert after["hull"]["revision"] > before["hull"]["revision"]
    assert after["hull"]["vertices"] != before["hull"]["vertices"]
    assert after["latency_ms"]["last"] > 0
    assert [info["edited"] for info in after["frames_info"]] == [True, False, False, False]
    back = undo(page, 1).json()["silhouette"]
    assert back["rings"] == whole["rings"]
    assert (back["edited"], back["can_undo"], back["can_redo"]) == (False, False, True)
    assert state(page)["hull"]["vertices"] == before["hull"]["vertices"]
    assert undo(page, 1).status_code == 409
    assert "no edit of this frame to take back" in undo(page, 1).json()["detail"]
    assert undo(page, 1, "redo").json()["silhouette"]["rings"] == [SQUARE]
    undo(page, 1)


def test_of_two_pages_the_later_edit_from_the_same_outline_is_refused(page, address) -> None:
    with httpx.Client(base_url=address, trust_env=False) as other:
        order = outline(page, 2, rings=[SQUARE])
        late = outline(other, 2)
        assert put(page, 2, order).status_code == 200
        refused = put(other, 2, late)
        assert refused.status_code == 409
        assert "has been changed meanwhile" in refused.json()["detail"]
        assert put(other, 2, late, "preview").status_code == 409
        shown = other.get("/api/frames/2").json()["silhouette"]
        assert shown["rings"] == [SQUARE]
        undo(page, 2)


def test_a_preview_is_shown_to_all_and_journals_nothing(page, address) -> None:
    before = page.get("/api/frames/3").json()["silhouette"]
    hull = state(page)["hull"]
    frame = put(page, 3, outline(page, 3, rings=[SQUARE]), "preview").json()
    assert frame["silhouette"]["rings"] == before["rings"]
    assert frame["silhouette"]["revision"] == before["revision"]
    with httpx.Client(base_url=address, trust_env=False) as other:
        assert state(other)["hull"]["is_preview"]
    assert page.delete("/api/frames/3/preview").status_code == 200
    assert not state(page)["hull"]["is_preview"]
    assert state(page)["hull"]["volume_m3"] == hull["volume_m3"]


def test_no_rings_show_no_target_and_do_not_vote(page) -> None:
    frame = put(page, 4, outline(page, 4, rings=[])).json()
    assert frame["note"] == "frame 4 shows no target and does not vote"
    after = state(page)
    assert not after["frames_info"][3]["votes"]
    assert (after["hull"]["views"], after["hull"]["threshold"]) == (3, 3)
    undo(page, 4)
    assert state(page)["hull"]["views"] == 4


def test_excluded_frames_do_not_vote(page) -> None:
    shown = page.put("/api/frames/2/state", json={"state": "excluded"}).json()
    assert (shown["frames_info"][1]["state"], shown["frames_info"][1]["votes"]) == (
        "excluded",
        False,
    )
    assert shown["hull"]["views"] == 3
    assert page.get("/api/frames/2").json()["state"] == "excluded"
    again = page.put("/api/frames/2/state", json={"state": "ok"}).json()
    assert again["hull"]["views"] == 4


def test_an_empty_hull_names_the_frames_that_emptied_it(page) -> None:
    corner = [[0.0, 0.0], [0.0, 4.0], [4.0, 4.0], [4.0, 0.0]]
    put(page, 1, outline(page, 1, rings=[corner], claim="complete"))
    hull = state(page)["hull"]
    assert hull["is_empty"]
    assert 1 in hull["emptied_by"]
    for number in hull["emptied_by"]:
        page.put(f"/api/frames/{number}/state", json={"state": "excluded"})
    assert not state(page)["hull"]["is_empty"]
    for number in hull["emptied_by"]:
        page.put(f"/api/frames/{number}/state", json={"state": "todo"})
    undo(page, 1)


def test_carving_follows_its_controls(page) -> None:
    before = state(page)
    asked = {
        "tolerated_misses": 1,
        "rule": "strict",
        "spacing_m": 0.5,
        "side_m": 25.0,
        "frame_range": [1, None],
    }
    shown = page.put("/api/carving", json=asked).json()
    assert shown["carving"] == asked
    assert shown["window_m"] == 25.0
    assert shown["hull"]["threshold"] == 3
    too_fine = page.put("/api/carving", json={"spacing_m": 0.03})
    assert too_fine.status_code == 422
    assert "833 voxels a side; at most 640" in too_fine.json()["detail"]
    assert state(page)["carving"] == asked
    fewer = page.put("/api/carving", json={"frame_range": [2, 3]}).json()
    assert fewer["hull"]["views"] == 2
    assert [info["votes"] for info in fewer["frames_info"]] == [False, True, True, False]
    assert "outside the range" in page.get("/api/frames/4").json()["note"]
    backward = page.put("/api/carving", json={"frame_range": [3, 2]})
    assert (backward.status_code, state(page)["carving"]) == (422, fewer["carving"])
    assert "not before it; got 3 to 2" in backward.json()["detail"]
    back = page.put("/api/carving", json=before["carving"]).json()
    assert back["hull"]["volume_m3"] == before["hull"]["volume_m3"]


def test_an_outline_that_crosses_itself_is_split_and_says_so(page) -> None:
    bow = [[60.0, 60.0], [100.0, 100.0], [60.0, 100.0], [100.0, 60.0]]
    shown = put(page, 1, outline(page, 1, rings=[bow])).json()["silhouette"]
    assert len(shown["rings"]) == 2
    assert "crossed itself" in shown["repair"]
    undo(page, 1)


@pytest.mark.parametrize(
    ("rings", "sentence"),
    [
        ([SQUARE[:2]], "has 2 vertices; at least 3"),
        ([[[1, 1], [2, 2], [3, 3]]], "encloses no area"),
        ([[[1e9, 1], [2, 2], [3, 4]]], "far outside the image"),
        ([SQUARE] * 201, "at most 200 items"),
        ([[[1.0, 2.0]] * (MOST_VERTICES + 1)], "at most 20000 items"),
        ([[[1, 2, 3]] * 3], "body → rings"),
        ("x", "body → rings"),
    ],
)
def test_outlines_that_cannot_be_are_refused_in_a_sentence(page, rings, sentence) -> None:
    response = put(page, 1, outline(page, 1, rings=rings))
    assert response.status_code == 422
    assert sentence in response.json()["detail"]
    assert page.get("/api/frames/1").json()["silhouette"]["rings"] != rings


def test_numbers_that_are_none_are_refused(page) -> None:
    order = outline(page, 1)
    body = '{"rings": [[[NaN, 1], [2, 2], [3, 4]]], "claim": "complete", "base_revision": %d}'
    response = page.put(
        "/api/frames/1/silhouette",
        content=body % order["base_revision"],
        headers={"content-type": "application/json"},
    )
    assert response.status_code == 422
    assert "NaN" in response.json()["detail"]


def test_bodies_hold_what_is_known_and_no_more_than_an_outline(page) -> None:
    assert put(page, 1, outline(page, 1, file="/etc/passwd")).status_code == 422
    assert put(page, 9, outline(page, 1)).status_code == 404
    assert page.put("/api/frames/1/state", json={"state": "gone"}).status_code == 422
    assert put(page, 1, outline(page, 1, tool="x" * 2_000_000)).status_code == 413


def test_a_reprojection_is_the_hull_as_the_frame_sees_it(page) -> None:
    shown = page.get("/api/frames/2/reprojection").json()
    assert shown["revision"] == state(page)["hull"]["revision"]
    seen = np.concatenate([np.array(ring) for ring in shown["rings"]])
    drawn = page.get("/api/frames/2").json()["silhouette"]["rings"]
    reach = np.concatenate([np.array(ring) for ring in drawn])
    assert np.all(seen.max(axis=0)[1] <= reach.max(axis=0)[1] + 1.0)
    assert np.all(seen.min(axis=0) >= reach.min(axis=0) - 1.0)


def propose(page: httpx.Client, tool: str, **parameters: object) -> httpx.Response:
    return page.post("/api/frames/2/proposals", json={"tool": tool, "parameters": parameters})


def test_tools_propose_and_change_nothing(page) -> None:
    before = state(page)
    present = page.get("/api/frames/2").json()["silhouette"]
    assert propose(page, "threshold").json()["rings"] == present["rings"]
    tighter = propose(page, "threshold", a2=20.0, closing_px=3).json()
    assert tighter["rings"] != present["rings"]
    assert tighter["claim"] == "lit side"
    copied = propose(page, "copy", **{"from": 3}).json()
    assert len(copied["rings"]) == len(page.get("/api/frames/3").json()["silhouette"]["rings"])
    seen = page.get("/api/frames/2/reprojection").json()["rings"]
    assert propose(page, "reprojection").json()["rings"] == seen
    after = state(page)
    for name in ("hull", "frames_info", "carving"):
        assert after[name] == before[name]


@pytest.mark.parametrize(
    ("tool", "parameters", "sentence"),
    [
        ("wand", {}, 'There is no tool "wand"'),
        ("threshold", {"a9": 1}, "a9: Extra inputs"),
        ("threshold", {"a1": -1}, "greater than 0"),
        ("copy", {"from": 77}, "There is no frame 77 to copy from"),
        ("copy", {}, "from: Field required"),
    ],
)
def test_tools_refuse_in_a_sentence(page, tool, parameters, sentence) -> None:
    response = propose(page, tool, **parameters)
    assert response.status_code == 422
    assert sentence in response.json()["detail"]


@pytest.mark.parametrize(
    ("tool", "parameters"),
    [
        ("grow", {"row": None, "column": None, "tolerance_db": 3}),
        ("snap", {"reach_px": 3}),
        ("smooth", {"strength_px": 1}),
        ("simplify", {"tolerance_px": 0.5}),
        ("fill holes", {}),
        ("interpolate", {"from": [1, 2]}),
    ],
)
def test_every_tool_proposes_an_outline_and_changes_nothing(page, tool, parameters) -> None:
    before = page.get("/api/frames/1").json()["silhouette"]
    if "row" in parameters:
        row, column = np.mean(before["rings"][0], axis=0)
        parameters = {**parameters, "row": row, "column": column}
    asked = {"tool": tool, "parameters": parameters, "rings": before["rings"]}
    answer = page.post("/api/frames/1/proposals", json=asked)
    assert answer.status_code == 200, answer.text
    assert all(len(ring) >= 3 for ring in answer.json()["rings"])
    assert answer.json()["rings"]
    assert page.get("/api/frames/1").json()["silhouette"] == before


def test_livewire_proposes_a_path(page) -> None:
    ring = page.get("/api/frames/1").json()["silhouette"]["rings"][0]
    asked = {"tool": "livewire", "parameters": {"points": [ring[0], ring[len(ring) // 3]]}}
    path = page.post("/api/frames/1/proposals", json={**asked, "rings": [ring]}).json()["path"]
    assert len(path) > 2
    assert np.hypot(*np.subtract(path[0], ring[0])) < 3


def test_a_tool_that_changes_an_outline_needs_one(page) -> None:
    asked = {"tool": "smooth", "parameters": {}, "rings": []}
    answer = page.post("/api/frames/1/proposals", json=asked)
    assert answer.status_code == 422
    assert "draw one first" in answer.json()["detail"]


def test_grabcut_is_for_photographs(page) -> None:
    ring = page.get("/api/frames/1").json()["silhouette"]["rings"][0]
    asked = {"tool": "grabcut", "parameters": {}, "rings": [ring]}
    answer = page.post("/api/frames/1/proposals", json=asked)
    assert answer.status_code == 422
    assert "comes from a radar" in answer.json()["detail"]


@pytest.mark.parametrize("label", ["", "  ", "x" * 41, "a\u0007b"])
def test_a_label_that_nobody_can_read_is_refused(page, label) -> None:
    refused = put(page, 1, outline(page, 1, component=label))
    assert refused.status_code == 422
    assert "A part's label has 1 to 40 printable characters" in refused.json()["detail"]


def test_a_reprojection_tells_by_how_much_it_differs_outside_the_shadow(page) -> None:
    before = page.get("/api/frames/2/reprojection").json()
    assert before["overlap"] > 0.8
    put(page, 2, outline(page, 2, rings=[SQUARE]))
    lit = page.get("/api/frames/2/reprojection").json()
    assert lit["outline_revision"] == before["outline_revision"] + 1
    seen_px = sum(clockwise_area_px(np.array(ring)) for ring in lit["rings"])
    shared_px = 40.0 * 40.0 - lit["only_outline_px"]
    # The hull reaches on behind the lit side, where nothing is known, and hardly anywhere else.
    assert seen_px > shared_px + 20.0
    assert lit["only_hull_px"] < 0.5 * (seen_px - shared_px)
    undo(page, 2)
