import threading
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
import pytest

from app import idle_work
from app import stream as stream_module
from app.facts import state_facts
from app.playback import Playback
from app.snapshot import Snapshot
from app.source import Source
from app.stream import LiveStream
from core.analysis.analysis import Analysis
from core.frame import Frame
from core.silhouettes.silhouette import Silhouette
from tests.app.synthetic import SETTINGS, frames, source


@pytest.fixture
def start() -> Iterator[Callable[..., LiveStream]]:
    """Return a function that starts a stream; all are stopped at the end."""
    started: list[LiveStream] = []
    before = set(threading.enumerate())

    def start_one(from_source: Source | None = None, *, playing: bool = True) -> LiveStream:
        stream = LiveStream(
            from_source or source(4),
            SETTINGS,
            playback=Playback(speed_hz=None, is_playing=playing),
        )
        started.append(stream)
        stream.start()
        return stream

    yield start_one
    for stream in started:
        stream.stop()
    # The pool of the hull's kernels is the process' own and stays.
    left = {thread for thread in threading.enumerate() if not thread.name.startswith("hull_")}
    assert left <= before


def test_plays_every_frame_and_keeps_the_latest_hull(start, wait_for) -> None:
    stream = start()
    wait_for(lambda: stream.snapshot.status == "finished")
    snapshot = stream.snapshot
    assert [record.number for record in snapshot.records] == [1, 2, 3, 4]
    assert snapshot.shown is snapshot.records[-1]
    assert snapshot.hull is snapshot.records[-1].hull
    assert len(snapshot.surface.vertices_m) == snapshot.hull.vertex_count
    volumes = [record.hull.volume_m3 for record in snapshot.records]
    assert volumes == sorted(volumes, reverse=True)


def test_a_hull_of_many_faces_is_drawn_lightly_once_no_frame_comes(
    start, wait_for, monkeypatch
) -> None:
    monkeypatch.setattr(idle_work, "MOST_IDLE_FACES", 1000)
    stream = start()
    seen: list[Snapshot] = []
    stream.observe(seen.append)
    wait_for(lambda: stream.snapshot.light is not None)
    snapshot = stream.snapshot
    assert len(snapshot.drawn.faces) <= 1000 < len(snapshot.surface.faces)
    assert snapshot.hull.face_count == len(snapshot.surface.faces)
    facts = state_facts(snapshot, stream.source)["light"]
    assert facts == {"faces": len(snapshot.drawn.faces), "error_m": snapshot.light.error_m}
    assert 0 < facts["error_m"] < SETTINGS.spacing_m
    assert snapshot.status == "finished"
    assert all(state.light is None for state in seen if state.status != "finished")


def test_a_hull_of_few_faces_is_drawn_as_it_is(start, wait_for) -> None:
    stream = start()
    wait_for(lambda: stream.snapshot.status == "finished")
    assert stream.snapshot.light is None
    assert stream.snapshot.drawn is stream.snapshot.surface
    assert state_facts(stream.snapshot, stream.source)["light"] is None


def test_observers_see_each_frame_once_and_in_order(start, wait_for) -> None:
    stream = start(playing=False)
    seen: list[Snapshot] = []
    stream.observe(seen.append)
    stream.play()
    wait_for(lambda: stream.snapshot.status == "finished")
    counts = [len(snapshot.records) for snapshot in seen]
    assert counts == sorted(counts)
    assert set(counts) == {0, 1, 2, 3, 4}
    serials = [snapshot.serial for snapshot in seen]
    assert serials == sorted(set(serials))


def test_nothing_appears_while_paused_and_one_frame_per_step(start, wait_for) -> None:
    stream = start(playing=False)
    stream.step()
    wait_for(lambda: len(stream.snapshot.records) == 1)
    threading.Event().wait(0.3)  # time in which a second frame would have been computed
    assert len(stream.snapshot.records) == 1
    assert stream.snapshot.status == "paused"
    stream.step()
    wait_for(lambda: len(stream.snapshot.records) == 2)


def test_an_earlier_frame_is_shown_while_the_hull_stays_the_latest(start, wait_for) -> None:
    stream = start()
    wait_for(lambda: stream.snapshot.status == "finished")
    stream.choose(2)
    assert stream.snapshot.shown.number == 2
    assert stream.snapshot.hull.frames == 4
    stream.choose(4)
    assert stream.snapshot.chosen is None


@pytest.mark.parametrize("number", [0, -1, 5])
def test_frames_that_are_not_there_cannot_be_shown(start, wait_for, number: int) -> None:
    stream = start()
    wait_for(lambda: stream.snapshot.status == "finished")
    with pytest.raises(ValueError, match=rf"4 frames have arrived so far; frame {number} cannot"):
        stream.choose(number)


def test_restart_asks_the_source_for_nothing_again(start, wait_for) -> None:
    asked = []

    def counted() -> Iterator[Frame]:
        for frame in frames(3):
            asked.append(frame)
            yield frame

    stream = start(Source(name="counted", frames=counted))
    wait_for(lambda: stream.snapshot.status == "finished")
    first = stream.snapshot
    stream.restart()
    wait_for(lambda: stream.snapshot.run == 2 and stream.snapshot.status == "finished")
    assert len(asked) == 3
    again = stream.snapshot
    assert [r.hull.volume_m3 for r in again.records] == [r.hull.volume_m3 for r in first.records]


def test_restart_in_the_middle_goes_on_with_the_rest(start, wait_for) -> None:
    stream = start(playing=False)
    stream.step()
    wait_for(lambda: len(stream.snapshot.records) == 1)
    stream.restart()
    wait_for(lambda: stream.snapshot.status == "finished")
    assert [record.frame.time_s for record in stream.snapshot.records] == [0, 6, 12, 18]


def test_a_failing_source_gives_one_sentence_and_restart_tries_again(start, wait_for) -> None:
    attempts = []

    def breaks_first() -> Iterator[Frame]:
        attempts.append(True)
        yield from frames(2)
        if len(attempts) == 1:
            raise ValueError("The echoes of frame 3 hold NaN.")

    stream = start(Source(name="breaking", frames=breaks_first))
    wait_for(lambda: stream.snapshot.status == "failed")
    assert stream.snapshot.message == "The echoes of frame 3 hold NaN."
    assert len(stream.snapshot.records) == 2
    stream.restart()
    wait_for(lambda: stream.snapshot.status == "finished")
    assert stream.snapshot.message == ""


def test_a_source_without_frames_is_a_failure_that_says_so(start, wait_for) -> None:
    stream = start(Source(name="an empty pass", frames=tuple))
    wait_for(lambda: stream.snapshot.status == "failed")
    assert stream.snapshot.message.startswith("an empty pass holds no frames")


def test_a_failure_during_a_restart_is_not_taken_for_the_end(start, wait_for) -> None:
    asked, restarted = threading.Event(), threading.Event()

    def breaks() -> Iterator[Frame]:
        yield from frames(2)
        asked.set()
        restarted.wait(20)
        raise ValueError("The echoes of frame 3 hold NaN.")

    stream = start(Source(name="breaking", frames=breaks))
    assert asked.wait(20)
    stream.restart()
    restarted.set()
    wait_for(lambda: stream.snapshot.status in ("finished", "failed"))
    assert stream.snapshot.run == 2
    assert (stream.snapshot.status, stream.snapshot.message) == (
        "failed",
        "The echoes of frame 3 hold NaN.",
    )
    assert len(stream.snapshot.records) == 2


def test_an_observer_that_fails_stops_nobody(start, wait_for, caplog) -> None:
    def fails(snapshot: Snapshot) -> None:
        raise RuntimeError("no such node in the scene")

    stream = start(playing=False)
    seen: list[Snapshot] = []
    stream.observe(fails)
    stream.observe(seen.append)
    stream.play()
    wait_for(lambda: stream.snapshot.status == "finished")
    stream.restart()
    wait_for(lambda: stream.snapshot.run == 2 and stream.snapshot.status == "finished")
    wait_for(lambda: seen[-1] is stream.snapshot)
    assert "no such node in the scene" in caplog.text


def test_nobody_waits_for_an_observer_that_takes_its_time(start, wait_for) -> None:
    entered, leave = threading.Event(), threading.Event()

    def is_slow(snapshot: Snapshot) -> None:
        if snapshot.records:
            entered.set()
            leave.wait(20)

    stream = start(playing=False)
    stream.observe(is_slow)
    stream.step()
    assert entered.wait(20)
    asking = threading.Thread(target=lambda: (stream.pause(), stream.snapshot))
    asking.start()
    asking.join(5)
    still_waits = asking.is_alive()
    leave.set()
    asking.join(20)
    assert not still_waits


def shifted(stream: LiveStream, number: int, rows: float) -> Silhouette:
    silhouette = stream.snapshot.records[number - 1].silhouette
    return replace(silhouette, rings=tuple(ring + [rows, 0.0] for ring in silhouette.rings))  # noqa: RUF005


def commit(stream: LiveStream, number: int, silhouette: Silhouette, base_revision: int) -> Snapshot:
    return stream.edit(
        lambda analysis: analysis.commit(
            number, silhouette, tool="move", base_revision=base_revision
        )
    )


def test_an_edit_changes_the_hull_its_frame_and_nothing_else(start, wait_for) -> None:
    stream = start()
    wait_for(lambda: stream.snapshot.status == "finished")
    before = stream.snapshot
    after = commit(stream, 2, shifted(stream, 2, 4.0), 0)
    assert after is stream.snapshot
    assert after.hull.revision > before.hull.revision
    assert len(after.surface.vertices_m) == after.hull.vertex_count
    assert after.hull.volume_m3 < before.hull.volume_m3
    assert after.status == "finished"
    assert 0 < after.latency_ms < 20_000
    assert after.records[1].silhouette is not before.records[1].silhouette
    assert [after.records[n] for n in (0, 2, 3)] == [before.records[n] for n in (0, 2, 3)]
    undone = stream.edit(lambda analysis: analysis.undo(2, base_revision=1))
    assert undone.hull.volume_m3 == before.hull.volume_m3
    assert undone.records[1].analysed.history.revision == 2


def test_an_edit_does_not_wait_for_the_frame_that_is_being_imaged(start, wait_for) -> None:
    asked, go_on = threading.Event(), threading.Event()

    def slow() -> Iterator[Frame]:
        first, second, third = frames(3)
        yield from (first, second)
        asked.set()
        go_on.wait(20)
        yield third

    stream = start(Source(name="slow", frames=slow))
    wait_for(lambda: len(stream.snapshot.records) == 2)
    assert asked.wait(20)
    edited = commit(stream, 1, shifted(stream, 1, 2.0), 0)
    assert (len(edited.records), edited.hull.voting) == (2, 2)
    go_on.set()
    wait_for(lambda: stream.snapshot.status == "finished")
    assert stream.snapshot.records[0].analysed.history.revision == 1
    assert stream.snapshot.hull.voting == 3


def test_a_replay_keeps_edited_outlines_and_states(start, wait_for) -> None:
    stream = start()
    wait_for(lambda: stream.snapshot.status == "finished")
    commit(stream, 2, shifted(stream, 2, 4.0), 0)
    edited = stream.edit(lambda analysis: analysis.set_state(3, "excluded"))
    stream.restart()
    wait_for(lambda: stream.snapshot.run == 2 and stream.snapshot.status == "finished")
    again = stream.snapshot
    assert again.hull.volume_m3 == edited.hull.volume_m3
    assert again.hull.revision > edited.hull.revision
    assert [r.analysed.state for r in again.records] == ["todo", "todo", "excluded", "todo"]
    assert again.records[1].silhouette is edited.records[1].silhouette
    assert again.records[1].analysed.history.can_undo


def test_a_preview_is_marked_until_it_is_taken_back_or_committed(start, wait_for) -> None:
    stream = start()
    wait_for(lambda: stream.snapshot.status == "finished")
    before = stream.snapshot
    shown = stream.preview(1, shifted(stream, 1, 3.0), base_revision=0)
    assert shown.hull.is_preview
    assert shown.records == before.records
    back = stream.end_preview()
    assert not back.hull.is_preview
    assert back.hull is before.hull
    assert stream.end_preview() is back
    for _ in range(3):
        stream.preview(1, shifted(stream, 1, 3.0), base_revision=0)
    kept = commit(stream, 1, shifted(stream, 1, 3.0), 0)
    assert not kept.hull.is_preview
    assert kept.hull.revision == before.hull.revision + 1


def test_a_preview_without_news_ends(start, wait_for, monkeypatch) -> None:
    monkeypatch.setattr(stream_module, "PREVIEW_LASTS_S", 0.2)
    stream = start()
    wait_for(lambda: stream.snapshot.status == "finished")
    stream.preview(1, shifted(stream, 1, 3.0), base_revision=0)
    wait_for(lambda: not stream.snapshot.hull.is_preview)


def test_of_previews_that_wait_only_the_latest_is_carved(start, wait_for) -> None:
    stream = start()
    wait_for(lambda: stream.snapshot.status == "finished")
    seen: list[Snapshot] = []
    entered, leave = threading.Event(), threading.Event()

    def blocks(analysis: Analysis) -> None:
        entered.set()
        leave.wait(20)

    outlines = [shifted(stream, 1, float(rows)) for rows in range(1, 6)]
    working = [threading.Thread(target=stream.edit, args=[blocks])]
    working[0].start()
    assert entered.wait(20)
    stream.observe(seen.append)
    for outline in outlines:
        tickets = stream._ticket
        one = threading.Thread(
            target=stream.preview, args=[1, outline], kwargs={"base_revision": 0}
        )
        working.append(one)
        one.start()
        wait_for(lambda before=tickets: stream._ticket > before)
    leave.set()
    for thread in working:
        thread.join(20)
    assert sum(s.hull.is_preview for s in seen) == 1
    expected = Analysis(SETTINGS)
    for record in stream.snapshot.records:
        expected.receive(record.frame, record.silhouette)
    expected.preview(1, outlines[-1], base_revision=0)
    assert stream.snapshot.hull.volume_m3 == expected.hull.volume_m3


def test_edits_from_many_threads_leave_the_hull_of_their_outlines(start, wait_for) -> None:
    stream = start(source(4), playing=True)
    wait_for(lambda: stream.snapshot.status == "finished")

    def nudge(number: int) -> None:
        for revision in range(5):
            commit(stream, number, shifted(stream, number, 0.5), revision)

    threads = [threading.Thread(target=nudge, args=[number]) for number in (1, 2, 3, 4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(20)
    snapshot = stream.snapshot
    assert [r.analysed.history.revision for r in snapshot.records] == [5] * 4
    fresh = Analysis(SETTINGS)
    for record in snapshot.records:
        fresh.receive(record.frame, record.silhouette)
    assert np.array_equal(snapshot.surface.vertices_m, fresh.surface.vertices_m)
    assert np.array_equal(snapshot.surface.faces, fresh.surface.faces)


def test_a_large_hull_is_drawn_lightly_again_after_an_edit(start, wait_for, monkeypatch) -> None:
    monkeypatch.setattr(idle_work, "MOST_IDLE_FACES", 1000)
    monkeypatch.setattr(idle_work, "QUIET_S", 0.2)
    stream = start()
    wait_for(lambda: stream.snapshot.light is not None)
    edited = commit(stream, 1, shifted(stream, 1, 1.0), 0)
    assert edited.light is None
    assert edited.drawn is edited.surface
    wait_for(lambda: stream.snapshot.light is not None)
    assert stream.snapshot.surface is edited.surface
