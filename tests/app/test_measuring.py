"""The desk: every committed hull is measured, the latest wins, intervals belong to one hull."""

import threading
import time
from collections.abc import Iterator

import numpy as np
import pytest

from app import idle_work, measured_items, measuring_intervals
from app.measuring import MeasurementDesk
from app.measuring_intervals import voting_views
from app.playback import Playback
from app.stream import LiveStream
from core.analysis.history import NothingLeft
from core.measurement.anchors import KeyPoint, PartEnd
from core.measurement.intervals import measured_intervals
from core.measurement.measuring import measure_all
from core.measurement.measuring_job import MeasuringContext
from core.measurement.results import Lost
from core.measurement.specs import AngleBetween, Length, PrincipalAxes, ScaleFactor, Volume
from tests.app.synthetic import SETTINGS, source
from tests.app.test_stream import commit, shifted


def end(toward: list[float]) -> PartEnd:
    return PartEnd(near_m=np.zeros(3), toward=toward, reach_m=3.0)


SPAN = Length(name="span", start=end([0, -1, 0]), end=end([0, 1, 0]))


@pytest.fixture
def stream(monkeypatch, wait_for) -> Iterator[LiveStream]:
    """A stream of eight frames, all received."""
    monkeypatch.setattr(idle_work, "QUIET_S", 60.0)
    stream = LiveStream(source(8), SETTINGS, playback=Playback(speed_hz=None))
    stream.start()
    wait_for(lambda: stream.snapshot.status == "finished")
    yield stream
    stream.stop()


@pytest.fixture
def desk(stream) -> Iterator[MeasurementDesk]:
    before = set(threading.enumerate())
    desk = MeasurementDesk(stream)
    stream.observe(desk.note)
    desk.start()
    yield desk
    desk.stop()
    assert not set(threading.enumerate()) - before


def measured(desk: MeasurementDesk) -> list:
    assert desk.wait(20)
    return [item.result for item in desk.items]


def test_every_kept_hull_is_measured_and_every_number_says_its_revision(stream, desk) -> None:
    desk.add(SPAN)
    desk.add(Volume(name="volume"))
    desk.add(ScaleFactor(name="share", first="span", second="span"))
    first = measured(desk)
    hull, surface = stream.snapshot.hull, stream.snapshot.surface
    context = MeasuringContext(revision=hull.revision, threshold=hull.threshold)
    for found, wanted in zip(first, measure_all(desk.book.specs, surface, context), strict=True):
        assert (found.value, found.revision) == (wanted.value, hull.revision)
        assert found.threshold == hull.threshold
    assert [item.change for item in desk.items] == [None] * 3
    assert [item.observability for item in desk.items] == ["good"] * 3
    edited = commit(stream, 3, shifted(stream, 3, 8.0), 0)
    second = measured(desk)
    assert {found.revision for found in second} == {edited.hull.revision} == {desk.revision}
    for item, before, after in zip(desk.items, first, second, strict=True):
        assert item.change == after.value - before.value
    assert desk.items[1].change != 0
    # On the same hull another name, another entry or a hidden one changes no change.
    changes = [item.change for item in desk.items]
    desk.rename("volume", "all of it")
    desk.set_hidden("all of it", True)
    desk.add(Volume(name="again"))
    measured(desk)
    assert [item.change for item in desk.items] == [*changes, None]
    desk.replace("again", PrincipalAxes(name="axes"))
    measured(desk)
    assert desk.items[-1].change is None


def test_an_outline_that_is_tried_is_not_measured(stream, desk) -> None:
    desk.add(Volume(name="volume"))
    (before,) = measured(desk)
    stream.preview(2, shifted(stream, 2, 5.0), base_revision=0)
    assert measured(desk) == [before]
    kept = stream.end_preview()
    (after,) = measured(desk)
    assert after is before
    assert after.revision == kept.hull.revision


def test_the_latest_hull_wins(stream, desk, monkeypatch) -> None:
    desk.add(Volume(name="volume"))
    measured(desk)
    revisions: list[int] = []
    entered, going_on = threading.Event(), threading.Event()

    def slow(specs, surface, context):
        revisions.append(context.revision)
        entered.set()
        assert going_on.wait(10)
        return measure_all(specs, surface, context)

    monkeypatch.setattr(measured_items, "measure_all", slow)
    first = commit(stream, 1, shifted(stream, 1, 1.0), 0).hull.revision
    assert entered.wait(10)
    assert desk.items[0].result.revision < first  # stands, as what it is, while it is old
    later = [commit(stream, 1, shifted(stream, 1, 1.0), base) for base in (1, 2, 3)]
    going_on.set()
    measured(desk)
    assert revisions == [first, later[-1].hull.revision]


def test_observers_see_what_is_there_and_every_later_state_one_at_a_time(
    stream, desk, wait_for, caplog
) -> None:
    seen: list[tuple] = []

    def fails(_: object) -> None:
        raise RuntimeError("nobody looks")

    desk.observe(fails)
    desk.observe(seen.append)
    wait_for(lambda: seen == [()])
    desk.add(Volume(name="volume"))
    wait_for(lambda: seen[-1] and seen[-1][0].result is not None)
    desk.undo()
    wait_for(lambda: seen[-1] == ())
    desk.redo()
    wait_for(lambda: seen[-1] and seen[-1][0].spec.name == "volume")
    assert "nobody looks" in caplog.text
    with pytest.raises(NothingLeft):
        desk.redo()


def test_lost_ones_say_why_and_key_points_are_found_when_they_come(stream, desk) -> None:
    corner = KeyPoint(name="corner")
    desk.add(Length(name="to the corner", start=corner, end=end([0, 1, 0])))
    desk.add(Volume(name="volume"))
    desk.add(AngleBetween(name="angle", first="volume", second="volume"))
    lost, _, angle = measured(desk)
    assert isinstance(lost, Lost)
    assert 'no key point "corner"; mark it in two or more frames' in lost.reason
    assert '"volume" has no direction' in angle.reason
    assert desk.items[0].observability is None
    desk.set_key_points({"corner": np.zeros(3)})
    assert measured(desk)[0].value > 1
    assert desk.key_points["corner"].tolist() == [0, 0, 0]


def test_another_source_leaves_the_book_but_none_of_its_numbers(stream, desk, wait_for) -> None:
    desk.add(Volume(name="volume"))
    measured(desk)
    stream.load(source(4))
    wait_for(lambda: stream.snapshot.status == "finished")
    (found,) = measured(desk)
    assert found.revision == stream.snapshot.hull.revision
    assert desk.items[0].spec.name == "volume"


def test_intervals_come_once_the_hull_is_quiet_and_never_stand_by_another_hulls_number(
    stream, desk, wait_for
) -> None:
    desk.add(SPAN)
    desk.add(Volume(name="volume"))
    measured(desk)
    desk.start_intervals()
    wait_for(lambda: desk.intervals)
    snapshot, item = stream.snapshot, desk.items[0]
    (wanted,) = measured_intervals(
        voting_views(snapshot),
        SETTINGS.grid(),
        lambda surface: np.array([measure_all([SPAN], surface)[0].value]),
    )
    # Other threads may add numbers up in another order.
    assert (item.interval.low, item.interval.high) == pytest.approx((wanted.low, wanted.high))
    assert item.interval.value == pytest.approx(item.result.value, abs=1e-9)
    for extent, interval in zip(snapshot.hull.extents, desk.intervals.extents, strict=True):
        assert interval.value == pytest.approx(extent.value_m, abs=1e-9)
    assert desk.intervals.volume.value == pytest.approx(snapshot.hull.volume_m3)
    desk.rename("span", "width")
    assert desk.items[0].interval is item.interval
    commit(stream, 3, shifted(stream, 3, 4.0), 0)
    measured(desk)
    after = desk.items[0]
    assert after.interval is None
    assert (after.old_interval, after.old_revision) == (item.interval, snapshot.hull.revision)


def test_intervals_are_given_up_on_request_and_by_the_next_edit(
    stream, desk, wait_for, monkeypatch
) -> None:
    calls: list[str] = []
    entered = threading.Event()

    def endless(*_: object, watch, **__: object) -> None:
        calls.append("began")
        watch.progress(1, 13)
        entered.set()
        while not watch.cancel():
            time.sleep(0.001)
        calls.append("gave up")
        raise measuring_intervals.Cancelled("asked to")

    monkeypatch.setattr(measuring_intervals, "measured_intervals", endless)
    desk.add(Volume(name="volume"))
    desk.start_intervals()
    assert entered.wait(10)
    assert (desk.progress.is_running, desk.progress.done, desk.progress.total) == (True, 1, 13)
    desk.cancel_intervals()
    wait_for(lambda: not desk.progress.is_running)
    assert calls == ["began", "gave up"]
    monkeypatch.setattr(idle_work, "QUIET_S", 0.05)
    time.sleep(0.3)
    assert calls == ["began", "gave up"]  # not again with the same
    entered.clear()
    commit(stream, 1, shifted(stream, 1, 1.0), 0)
    assert entered.wait(10)  # another hull that was quiet
    commit(stream, 1, shifted(stream, 1, 1.0), 1)
    wait_for(lambda: calls.count("gave up") == 2)
    assert desk.intervals is None


def test_why_there_are_no_intervals_is_told(stream, desk, wait_for) -> None:
    for number in range(3, 9):
        stream.edit(lambda analysis, n=number: analysis.set_state(n, "excluded"))
    desk.start_intervals()
    wait_for(lambda: "at least 3 frames" in desk.progress.complaint)
    assert desk.intervals is None
