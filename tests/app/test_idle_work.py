import threading
import time
from collections.abc import Callable, Iterator

import pytest

from app import idle_work
from app.facts import state_facts
from app.playback import Playback
from app.stream import LiveStream
from core.analysis.analysis import Analysis
from core.hull.casting import Watch
from core.measurement.residuals import Outlined, hull_residuals
from tests.app.synthetic import SETTINGS, source
from tests.app.test_stream import commit, shifted


@pytest.fixture
def stream(monkeypatch, wait_for: Callable[..., object]) -> Iterator[LiveStream]:
    """A stream of five frames, all received, in whose quiet idle work begins soon."""
    monkeypatch.setattr(idle_work, "QUIET_S", 0.2)
    before = set(threading.enumerate())
    stream = LiveStream(source(5), SETTINGS, playback=Playback(speed_hz=None))
    stream.start()
    wait_for(lambda: stream.snapshot.status == "finished")
    yield stream
    stream.stop()
    left = set(threading.enumerate()) - before
    assert not any(thread.name == "idle-work" for thread in left)


def test_residuals_come_once_the_hull_is_quiet_and_are_those_of_its_frames(
    stream, wait_for
) -> None:
    residuals = wait_for(lambda: stream.snapshot.residuals)
    snapshot, volume = stream.snapshot, stream.settled().volume
    assert residuals.revision == snapshot.hull.revision
    outlines = [Outlined(frame=r.frame, silhouette=r.silhouette) for r in snapshot.records]
    assert residuals.frames == hull_residuals(volume, snapshot.surface, outlines)
    facts = state_facts(snapshot, stream.source)["residuals"]
    assert facts["revision"] == snapshot.hull.revision
    assert [frame["number"] for frame in facts["frames"]] == [1, 2, 3, 4, 5]
    assert all(frame["suffers_m2"] <= frame["outline_m2"] for frame in facts["frames"])


def test_residuals_stay_until_those_of_the_edited_hull_come_and_point_to_its_frame(
    stream, wait_for
) -> None:
    before = wait_for(lambda: stream.snapshot.residuals)
    edited = commit(stream, 3, shifted(stream, 3, 8.0), 0)
    assert edited.residuals is before
    assert edited.residuals.revision < edited.hull.revision
    wait_for(lambda: stream.snapshot.residuals.revision == edited.hull.revision)
    after = stream.snapshot.residuals.frames
    pairs = list(zip(after, before.frames, strict=True))
    assert max(pairs, key=lambda pair: pair[0].causes_m3 - pair[1].causes_m3)[0].number == 3
    assert sum(one.suffers_m2 for one in after) > sum(one.suffers_m2 for one in before.frames)


def test_nothing_is_computed_while_an_outline_is_tried_or_frames_come(stream, wait_for) -> None:
    before = wait_for(lambda: stream.snapshot.residuals)
    shown = stream.preview(2, shifted(stream, 2, 5.0), base_revision=0)
    time.sleep(0.5)
    assert stream.snapshot is shown
    assert shown.residuals is before
    after = stream.end_preview()
    wait_for(lambda: stream.snapshot.residuals.revision == after.hull.revision)
    assert stream.snapshot.residuals.frames == before.frames
    assert stream.snapshot.records[0].analysed.state == "todo"
    reviewed = stream.edit(lambda analysis: analysis.set_state(1, "ok"))
    assert reviewed.residuals.revision == reviewed.hull.revision


def test_an_edit_ends_the_work_on_the_hull_before_and_waits_for_none_of_it(
    stream, wait_for, monkeypatch
) -> None:
    wait_for(lambda: stream.snapshot.residuals)
    entered, cancelled = threading.Event(), threading.Event()

    def endless(volume: object, surface: object, outlines: object, watch: Watch) -> None:
        entered.set()
        while not watch.cancel():
            time.sleep(0.001)
        cancelled.set()
        raise idle_work.Cancelled("another hull")

    monkeypatch.setattr(idle_work, "hull_residuals", endless)
    first = commit(stream, 1, shifted(stream, 1, 1.0), 0)
    assert entered.wait(10)

    def waits_for_the_processor(analysis: Analysis) -> None:
        assert cancelled.wait(10)
        analysis.undo(1, base_revision=1)

    second = stream.edit(waits_for_the_processor)
    assert second.hull.revision > first.hull.revision
    monkeypatch.undo()
    monkeypatch.setattr(idle_work, "QUIET_S", 0.2)
    wait_for(lambda: stream.snapshot.residuals.revision == second.hull.revision)


def test_work_that_fails_is_logged_and_not_tried_again_on_the_same_hull(
    stream, wait_for, monkeypatch, caplog
) -> None:
    wait_for(lambda: stream.snapshot.residuals)
    tries = []

    def fails(*_: object) -> None:
        tries.append(True)
        raise RuntimeError("no such frame")

    monkeypatch.setattr(idle_work, "hull_residuals", fails)
    commit(stream, 1, shifted(stream, 1, 1.0), 0)
    wait_for(lambda: "no such frame" in caplog.text)
    time.sleep(0.4)
    assert len(tries) == 1
