import threading
from collections.abc import Iterator

import numpy as np
import pytest

from app.measuring import MeasurementDesk
from app.picking import Ray
from app.source import NO_SOURCE
from app.stream import LiveStream
from app.viewport_pages import ViewportPages
from app.viewport_picking import Pickers
from app.viser_server import PrivateViserServer
from tests.measurement.bodies import box

BODY = box((4.0, 2.0, 1.0), fineness=3)


def ray(x: float, y: float) -> Ray:
    return Ray(origin_m=np.array([x, y, -9.0]), direction=np.array([0.0, 0.0, 1.0]))


@pytest.fixture
def server() -> Iterator[PrivateViserServer]:
    server = PrivateViserServer()
    yield server
    server.stop()


@pytest.fixture
def desk() -> MeasurementDesk:
    return MeasurementDesk(LiveStream(NO_SOURCE))


@pytest.fixture
def changes() -> list[int]:
    return []


@pytest.fixture
def pickers(server, desk, changes) -> Pickers:
    pages = ViewportPages(server, lambda _: None)
    return Pickers(pages, lambda: BODY, desk, lambda: changes.append(1))


def names(desk: MeasurementDesk) -> list[str]:
    return [item.spec.name for item in desk.items]


def test_two_clicks_make_a_length_and_the_page_goes_on_measuring(pickers, desk, changes) -> None:
    pickers.begin("one", "length", "surface")
    pickers.click("one", ray(-1.0, 0.0))
    assert pickers.facts()["one"]["picked"] == 1
    assert desk.items == ()
    before = len(changes)
    pickers.click("one", ray(1.0, 0.0))
    assert len(changes) > before
    (item,) = desk.items
    np.testing.assert_allclose(item.spec.start.near_m, [-1, 0, -0.5], atol=1e-12)
    np.testing.assert_allclose(item.spec.end.near_m, [1, 0, -0.5], atol=1e-12)
    assert pickers.facts()["one"] == {
        "kind": "length",
        "snap": "surface",
        "picked": 0,
        "snaps": True,
        "complaint": "",
        "hint": "Length: click the first end",
    }


def test_each_page_picks_for_itself(pickers, desk) -> None:
    pickers.begin("one", "length", "surface")
    pickers.begin("two", "line feature", "extreme")
    for x in (-1.9, 1.9):
        pickers.click("two", ray(x, 0.1))
    pickers.click("one", ray(0.0, 0.0))
    assert names(desk) == ["l₁"]
    assert pickers.facts()["one"]["picked"] == 1
    assert pickers.facts()["two"]["picked"] == 0
    pickers.stop("two")
    assert set(pickers.facts()) == {"one"}


def test_a_click_on_nothing_complains_and_loses_nothing(pickers, desk) -> None:
    pickers.begin("one", "length", "surface")
    pickers.click("one", ray(1.0, 0.0))
    pickers.click("one", ray(9.0, 0.0))
    facts = pickers.facts()["one"]
    assert facts["picked"] == 1
    assert "no hull under the pointer" in facts["complaint"]
    pickers.click("one", ray(1.0, 0.0))
    assert "the same point again" in pickers.facts()["one"]["complaint"]
    pickers.click("one", ray(0.0, 0.5))
    assert pickers.facts()["one"]["complaint"] == ""
    assert len(desk.items) == 1


def test_a_polyline_is_ended_and_its_last_point_taken_back(pickers, desk) -> None:
    pickers.begin("one", "polyline", "surface")
    for x in (-1.0, 0.0, 1.0):
        pickers.click("one", ray(x, 0.0))
    pickers.take_back("one")
    pickers.finish("one")
    (item,) = desk.items
    assert len(item.spec.anchors) == 2
    pickers.click("one", ray(0.0, 0.0))
    pickers.finish("one")
    facts = pickers.facts()["one"]
    assert facts["picked"] == 1
    assert "at least two points" in facts["complaint"]


def test_what_the_hull_does_not_allow_is_said_and_not_put_on_the_desk(pickers, desk) -> None:
    pickers.begin("one", "cylinder axis", "surface")
    pickers.click("one", ray(0.0, 0.0))
    facts = pickers.facts()["one"]
    assert desk.items == ()
    assert facts["picked"] == 0
    assert "cylinder" in facts["complaint"]


def test_another_kind_begins_anew_and_another_snap_does_not(pickers) -> None:
    pickers.begin("one", "length", "surface")
    pickers.click("one", ray(1.0, 0.0))
    pickers.begin("one", "length", "extreme")
    assert pickers.facts()["one"]["picked"] == 1
    pickers.begin("one", "polyline", "extreme")
    assert pickers.facts()["one"]["picked"] == 0


def test_a_page_that_picks_nothing_is_told_so(pickers) -> None:
    for order in (pickers.take_back, pickers.finish, lambda name: pickers.click(name, ray(0, 0))):
        with pytest.raises(ValueError, match="picks nothing"):
            order("one")
    pickers.stop("one")
    assert pickers.facts() == {}


def test_clicks_from_many_threads_make_whole_measurements(pickers, desk) -> None:
    pickers.begin("one", "length", "surface")
    places = np.linspace(-1.8, 1.8, 12)
    threads = [
        threading.Thread(target=pickers.click, args=("one", ray(float(x), 0.3))) for x in places
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(desk.items) == 6
    assert len(set(names(desk))) == 6
