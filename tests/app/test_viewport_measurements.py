from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest

from app.measured_items import Item
from app.measuring import MeasurementDesk
from app.snapshot import Snapshot
from app.source import NO_SOURCE
from app.stream import LiveStream
from app.viewport_measurements import MeasurementDrawing, with_anchor
from app.viser_server import PrivateViserServer
from core.analysis.analysis import Analysis
from core.measurement.anchors import Point, SurfacePoint
from core.measurement.measuring import measure
from core.measurement.measuring_job import MeasuringContext
from core.measurement.specs import Length, Polyline, Volume
from tests.app.synthetic import SETTINGS
from tests.measurement.bodies import box

BODY = box((4.0, 2.0, 1.0), fineness=3)
END = "/measurements/0-end-1"


def at(*place):
    return SurfacePoint(near_m=np.array(place, dtype=float))


SPAN = Length(name="span", start=at(-2, 0, 0), end=at(2, 0, 0))
WIDTH = Length(name="width", start=at(0, -1, 0), end=at(0, 1, 0))


def snapshot_of(surface=BODY, revision: int = 1) -> Snapshot:
    hull = replace(Analysis(SETTINGS).hull, revision=revision)
    return Snapshot(
        run=1, status="finished", speed_hz=None, settings=SETTINGS, hull=hull, surface=surface
    )


def items_of(desk: MeasurementDesk, revision: int = 1) -> tuple[Item, ...]:
    """The desk's measurements as they will be once its thread has measured them."""
    context = MeasuringContext(revision=revision)
    return tuple(replace(i, result=measure(i.spec, BODY, context)) for i in desk.items)


@pytest.fixture
def server() -> Iterator[PrivateViserServer]:
    server = PrivateViserServer()
    yield server
    server.stop()


@pytest.fixture
def desk() -> MeasurementDesk:
    desk = MeasurementDesk(LiveStream(NO_SOURCE))
    desk.add(SPAN)
    desk.add(WIDTH)
    return desk


@pytest.fixture
def drawing(server, desk) -> MeasurementDrawing:
    drawing = MeasurementDrawing(server, desk)
    drawing.note(snapshot_of())
    drawing.show(items_of(desk))
    return drawing


def sent(server: PrivateViserServer) -> list[str]:
    """Which nodes the messages since the last look are about, without their layer."""
    buffer = server._websock_server._broadcast_buffer
    names = [
        message.name.removeprefix("/measurements/")
        for number, message in sorted(buffer.message_from_id.items())
        if number > sent.seen and hasattr(message, "name")
    ]
    sent.seen = max(buffer.message_from_id, default=sent.seen)
    return names


sent.seen = -1


def test_only_nodes_that_change_are_sent(server, desk, drawing) -> None:
    sent.seen = -1
    assert {"0-lines", "0-end-0", "0-end-1", "0-label", "1-lines"} <= set(sent(server))
    drawing.show(items_of(desk))
    assert sent(server) == []
    longer = Length(name="width", start=at(0.5, -1, 0), end=at(0, 1, 0))
    desk.replace("width", longer)
    drawing.show(items_of(desk))
    assert set(sent(server)) == {"1-lines", "1-end-0", "1-label"}
    desk.remove("span")
    drawing.show(items_of(desk))
    assert set(sent(server)) == {"0-lines", "0-end-0", "0-end-1", "0-label"}
    assert server.scene.get_handle_by_name("/measurements/0-lines") is None
    assert server.scene.get_handle_by_name("/measurements/1-lines") is not None


def test_a_new_hull_turns_the_drawing_grey_until_it_is_measured(desk, drawing) -> None:
    bright = drawing._handles["/measurements/0-lines"].colors.copy()
    drawing.note(snapshot_of(revision=2))
    # What the desk tells is still of the hull before.
    drawing.show(items_of(desk, revision=1))
    line = drawing._handles["/measurements/0-lines"]
    assert not np.array_equal(line.colors, bright)
    drawing.show(items_of(desk, revision=2))
    np.testing.assert_array_equal(line.colors, bright)
    assert drawing._handles["/measurements/0-lines"] is line


def drag(drawing, *places):
    direction = np.array([0.0, 0.0, 1.0])
    drawing.drag(END, "start", np.array([*places[0], -9.0]), direction)
    for place in places:
        drawing.drag(END, "update", np.array([*place, -9.0]), direction)
    drawing.drag(END, "end", np.array([*places[-1], -9.0]), direction)


def test_a_dragged_end_stays_on_the_hull_and_is_one_step_to_undo(desk, drawing) -> None:
    drag(drawing, (1.8, 0.1), (1.5, 0.4), (1.0, 0.5))
    spec = desk.items[0].spec
    np.testing.assert_allclose(spec.end.near_m, [1.0, 0.5, -0.5], atol=1e-9)
    assert spec.start is SPAN.start
    np.testing.assert_allclose(drawing._handles[END].position, [1.0, 0.5, -0.5], atol=1e-9)
    desk.undo()
    assert desk.items[0].spec is SPAN


def test_while_it_is_dragged_the_line_and_the_number_follow(desk, drawing) -> None:
    direction = np.array([0.0, 0.0, 1.0])
    drawing.drag(END, "start", np.array([1.0, 0.0, -9.0]), direction)
    line, label = (drawing._handles[f"/measurements/0-{part}"] for part in ("lines", "label"))
    np.testing.assert_allclose(line.points[0, 1], [1.0, 0.0, -0.5], atol=1e-6)
    assert label.text == f"span {np.hypot(3.0, 0.5):.2f} m"
    assert desk.items[0].spec is SPAN


def test_a_pointer_off_the_hull_leaves_the_end_where_it_was(desk, drawing) -> None:
    drag(drawing, (1.0, 0.5), (7.0, 0.0))
    np.testing.assert_allclose(desk.items[0].spec.end.near_m, [1.0, 0.5, -0.5], atol=1e-9)


def test_an_end_whose_measurement_was_removed_meanwhile_changes_nothing(desk, drawing) -> None:
    direction = np.array([0.0, 0.0, 1.0])
    drawing.drag(END, "start", np.array([1.0, 0.0, -9.0]), direction)
    desk.remove("span")
    drawing.show(items_of(desk))
    drawing.drag(END, "update", np.array([0.5, 0.0, -9.0]), direction)
    drawing.drag(END, "end", np.array([0.5, 0.0, -9.0]), direction)
    assert [item.spec.name for item in desk.items] == ["width"]


def test_every_anchor_of_a_polyline_can_be_replaced() -> None:
    places = tuple(Point(point_m=np.full(3, float(n))) for n in range(3))
    way, other = Polyline(name="way", anchors=places), Point(point_m=np.full(3, 9.0))
    for number in range(3):
        moved = with_anchor(way, number, other)
        assert [a is b for a, b in zip(moved.anchors, places, strict=True)] == [
            n != number for n in range(3)
        ]
    with pytest.raises(ValueError, match="has no ends"):
        with_anchor(Volume(name="all"), 0, other)
