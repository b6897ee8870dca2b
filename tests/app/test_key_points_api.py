"""Key points marked, renamed and measured through the interface, and kept beside the live loop."""

import time
from collections.abc import Iterator
from dataclasses import replace

import httpx
import numpy as np
import pytest

from app.key_points import KeyPoints
from app.playback import Playback
from app.server import workstation
from app.viewport_key_points import KeyPointNodes
from app.viser_server import PrivateViserServer
from core.analysis.analysis import Analysis
from core.measurement.anchors import KeyPoint as Corner
from core.measurement.key_points import length_between, located
from core.measurement.results import Lost
from core.measurement.specs import Length
from tests.app.running import running
from tests.app.synthetic import SETTINGS, frames, source
from tests.app.test_viewport import snapshot_of

CORNER_M = np.array([-5.0, 1.6, -1.6])
OTHER_M = np.array([5.0, 1.6, -1.6])
PROJECTIONS = [frame.projection for frame in frames(4)]


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
        while page.get("/api/key_points").json()["key_points_book"]["can_undo"]:
            page.post("/api/key_points/undo")


def mark(
    page: httpx.Client, name: str, point_m: np.ndarray, number: int, off: float = 0.0
) -> httpx.Response:
    row, column = PROJECTIONS[number - 1].image_points(point_m)
    order = {"name": name, "frame": number, "row": row + off, "column": column}
    return page.put("/api/key_points/mark", json=order)


def test_a_corner_marked_in_frames_gets_its_place_residuals_and_way_back(page) -> None:
    (point,) = mark(page, "corner", CORNER_M, 1).json()["key_points"]
    assert (point["position_m"], point["sigma_m"]) == (None, None)
    assert "at least two frames" in point["complaint"]
    mark(page, "corner", CORNER_M, 2, 0.5)
    facts = mark(page, "corner", CORNER_M, 3).json()
    (point,) = facts["key_points"]
    seen = [projection.image_points(CORNER_M) for projection in PROJECTIONS[:3]]
    seen[1] = seen[1] + [0.5, 0.0]
    alone = located("corner", PROJECTIONS[:3], np.array(seen), sigma_px=1.0)
    assert point["position_m"] == pytest.approx(alone.position_m.tolist())
    assert point["sigma_m"] == pytest.approx(np.sqrt(np.diag(alone.covariance_m2)).tolist())
    assert [m["frame"] for m in point["marks"]] == [1, 2, 3]
    residuals = [m["residual_px"] for m in point["marks"]]
    assert residuals == pytest.approx(alone.residual_px.tolist())
    state = page.get("/api/state").json()
    assert state["key_points"] == [point]
    assert state["key_points_book"] == facts["key_points_book"]
    assert page.get("/api/key_points").json() == facts
    undone = page.post("/api/key_points/undo").json()
    assert [m["frame"] for m in undone["key_points"][0]["marks"]] == [1, 2]
    again = page.post("/api/key_points/redo").json()
    assert again["key_points"] == [point]
    assert page.post("/api/key_points/redo").status_code == 409
    without = page.delete("/api/key_points/mark", params={"name": "corner", "frame": 2})
    assert [m["frame"] for m in without.json()["key_points"][0]["marks"]] == [1, 3]
    gone = page.delete("/api/key_points/point", params={"name": "corner"})
    assert gone.json()["key_points"] == []


def test_where_a_point_should_be_seen_is_a_line_and_then_a_place(page) -> None:
    mark(page, "corner", CORNER_M, 1)
    seen = PROJECTIONS[3].image_points(CORNER_M)
    (expected,) = page.get("/api/key_points/expected/4").json()["expected"]
    assert expected["place"] is None
    ((start, end),) = np.array(expected["lines"])
    along, off = end - start, seen - start
    assert abs(along[0] * off[1] - along[1] * off[0]) < 1e-6 * (along @ along)
    mark(page, "corner", CORNER_M, 2)
    (expected,) = page.get("/api/key_points/expected/4").json()["expected"]
    assert expected["place"] == pytest.approx(seen.tolist())
    assert expected["lines"] == []
    assert page.get("/api/key_points/expected/5").status_code == 404


def test_a_length_between_key_points_has_its_interval(page) -> None:
    for number in (1, 2, 3):
        mark(page, "a", CORNER_M, number, 0.3 * number)
        mark(page, "b / c", OTHER_M, number)
    found = page.get("/api/key_points/length", params={"first": "a", "second": "b / c"}).json()
    off = np.array([[0.3, 0.0], [0.6, 0.0], [0.9, 0.0]])
    ends = [
        located(
            "end",
            PROJECTIONS[:3],
            np.array([projection.image_points(point_m) for projection in PROJECTIONS[:3]]) + by,
            sigma_px=1.0,
        )
        for point_m, by in ((CORNER_M, off), (OTHER_M, 0 * off))
    ]
    alone = length_between(*ends)
    assert found["value_m"] == pytest.approx(alone.value_m)
    assert (found["low_m"], found["high_m"]) == pytest.approx((alone.low_m, alone.high_m))
    page.put("/api/key_points/sigma", json={"sigma_px": 2.0})
    wider = page.get("/api/key_points/length", params={"first": "a", "second": "b / c"}).json()
    assert wider["standard_error_m"] == pytest.approx(2 * found["standard_error_m"])
    page.put("/api/key_points/sigma", json={"sigma_px": 1.0})


def test_measurements_follow_a_key_point_to_its_new_name(page) -> None:
    for number in (1, 2):
        mark(page, "a", CORNER_M, number)
        mark(page, "b", OTHER_M, number)
    ends = {"start": {"kind": "key point", "name": "a"}, "end": {"kind": "key point", "name": "b"}}
    page.post("/api/measurements", json={"spec": {"kind": "length", "name": "side", **ends}})
    page.put("/api/key_points/name", json={"name": "a", "new_name": " far  end"})
    deadline = time.monotonic() + 10
    while time.monotonic() < deadline:
        (item,) = page.get("/api/measurements").json()["items"]
        if item["value"] is not None:
            break
        time.sleep(0.02)
    assert item["value"] == pytest.approx(10.0)
    assert item["low"] < 10.0 < item["high"]
    page.post("/api/measurements/clear")


def test_what_makes_no_sense_is_refused_and_changes_nothing(page) -> None:
    before = mark(page, "corner", CORNER_M, 1).json()
    answers = [
        (mark(page, " ", CORNER_M, 2), 422, "name has 1 to 40 printable characters"),
        (mark(page, "corner", [900.0, 0.0, 0.0], 2), 422, "Frame 2 has 160 × 160 pixels"),
        (
            page.put("/api/key_points/mark", json={"name": "x", "frame": 9, "row": 1, "column": 1}),
            404,
            "There is no frame 9",
        ),
        (
            page.put("/api/key_points/name", json={"name": "edge", "new_name": "rim"}),
            422,
            'no key point "edge"',
        ),
        (
            page.delete("/api/key_points/mark", params={"name": "corner", "frame": 3}),
            422,
            "corner is not marked in frame 3",
        ),
        (page.put("/api/key_points/sigma", json={"sigma_px": 0}), 422, "between 0.01 and 100 px"),
        (
            page.get("/api/key_points/length", params={"first": "corner", "second": "rim"}),
            422,
            "at least two frames",
        ),
    ]
    for answer, status, sentence in answers:
        assert answer.status_code == status
        assert sentence in answer.json()["detail"]
    assert page.get("/api/key_points").json() == before
    renamed = page.put("/api/key_points/name", json={"name": "corner", "new_name": " rim  A"})
    assert [point["name"] for point in renamed.json()["key_points"]] == ["rim A"]


def test_places_follow_the_registration_of_frames_and_marks_outlive_a_replay() -> None:
    analysis = Analysis(replace(SETTINGS, registration="centroid"))
    for frame in frames(3):
        analysis.receive(frame)
    keys, told = ["demo"], []
    points = KeyPoints(lambda: keys[0])
    points.observe(told.append)
    points.note(snapshot_of(analysis))
    for number, projection in enumerate(PROJECTIONS[:3], start=1):
        place = tuple(projection.image_points(CORNER_M))
        points.change(lambda book, n=number, place=place: book.marked("corner", n, place))
    before = points.state.points[0].place.position_m
    registered = [frame.frame.projection for frame in analysis.frames]
    seen = np.array([projection.image_points(CORNER_M) for projection in PROJECTIONS[:3]])
    assert before == pytest.approx(located("c", registered, seen, sigma_px=1.0).position_m)
    count = len(told)
    points.note(snapshot_of(analysis))
    assert len(told) == count
    outline = analysis.frame(1).silhouette
    shifted = replace(outline, rings=tuple(ring + np.array([4.0, 0.0]) for ring in outline.rings))
    analysis.commit(1, shifted, tool="move", base_revision=0)
    points.note(snapshot_of(analysis))
    assert np.linalg.norm(points.state.points[0].place.position_m - before) > 0.1
    analysis.rewind()
    points.note(snapshot_of(analysis))
    assert points.state.points[0].place is None
    assert len(points.state.book.marks["corner"]) == 3
    keys[0] = "another source"
    points.note(snapshot_of(analysis))
    assert points.state.points == ()
    assert not points.state.book.can_undo
    assert points.state.book.revision > told[-2].book.revision


def test_the_desk_measures_between_key_points_with_the_interval_of_their_marks(wait_for) -> None:
    playback = Playback(speed_hz=None)
    with workstation(source(3), SETTINGS, playback=playback) as app:
        desk, points = app.state.desk, app.state.key_points
        wait_for(lambda: len(points.state.projections) == 3)
        desk.add(Length(name="side", start=Corner(name="a"), end=Corner(name="b")))
        wait_for(lambda: isinstance(desk.items[0].result, Lost))
        assert 'no key point "a"' in desk.items[0].result.reason
        for name, point_m in (("a", CORNER_M), ("b", OTHER_M)):
            for number, projection in enumerate(PROJECTIONS[:3], start=1):
                place = tuple(projection.image_points(point_m))
                points.change(lambda book, at=(name, number, place): book.marked(*at))
        alone = length_between(*(point.place for point in points.state.points))

        def told() -> float:
            interval = desk.items[0].interval
            return float("nan") if interval is None else interval.high

        wait_for(lambda: abs(told() - alone.high_m) < 1e-3)
        (item,) = desk.items
        assert item.result.value == pytest.approx(alone.value_m)
        assert item.observability is None
        assert item.interval.low == pytest.approx(alone.low_m, abs=1e-3)
        assert item.interval.method == "95 % interval: from the marks of its key points"
        same = desk.key_points
        points.change(lambda book: book.marked("c", 1, (80.0, 80.0)))
        assert desk.key_points is same


def test_placed_points_stand_in_the_viewport_and_go_with_their_marks() -> None:
    analysis = Analysis(SETTINGS)
    for frame in frames(3):
        analysis.receive(frame)
    points = KeyPoints(lambda: "demo")
    points.note(snapshot_of(analysis))
    server = PrivateViserServer()
    try:
        points.observe(KeyPointNodes(server).show)

        def nodes() -> dict:
            handles = server.scene._handle_from_node_name
            return {name: handle for name, handle in handles.items() if "/key-points/" in name}

        assert nodes() == {}
        for name, point_m in (("a", CORNER_M), ("b", OTHER_M)):
            for number, projection in enumerate(PROJECTIONS[:2], start=1):
                place = tuple(projection.image_points(point_m))
                points.change(lambda book, at=(name, number, place): book.marked(*at))
        assert len(nodes()) == 4
        assert nodes()["/key-points/0"].position == pytest.approx(CORNER_M, abs=1e-6)
        assert nodes()["/key-points/1/label"].text == "b"
        points.change(lambda book: book.without("a"))
        assert sorted(nodes()) == ["/key-points/0", "/key-points/0/label"]
        assert nodes()["/key-points/0"].position == pytest.approx(OTHER_M, abs=1e-6)
        points.change(lambda book: book.without_mark("b", 1))
        assert nodes() == {}
    finally:
        server.stop()
