"""The live loop: frames in, edits in, snapshots of the hull out, at the analyst's pace."""

import logging
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace

from app.idle_work import IdleWork, Settled
from app.observers import Observer, Observers
from app.playback import Playback
from app.snapshot import Record, Snapshot, Status
from app.source import NO_SOURCE, Source
from app.tape import Take, Tape
from core.analysis.analysis import Analysis
from core.hull.closed_mesh import Surface
from core.hull.volume import VoteVolume
from core.reconstruction import ReconstructionSettings
from core.silhouettes.silhouette import Silhouette

SurfaceOf = Callable[[VoteVolume], Surface]

PREVIEW_LASTS_S = 10.0
"""Without news of it; a page that was closed in the middle of a stroke never takes it back."""

_log = logging.getLogger("radarhull")


class LiveStream:
    """Runs an analysis, frame by frame in a thread and edit by edit, and tells observers.

    The next frame is imaged and outlined while the current one is on screen, and held back until
    playback releases it: stepping is immediate, and nothing appears while paused. Frames and edits
    change the analysis one at a time; imaging holds no lock, so that edits never wait for it.
    Observers are called one at a time and in order, and nobody waits for them but the thread that
    calls them.
    """

    def __init__(
        self,
        source: Source,
        settings: ReconstructionSettings | None = None,
        *,
        playback: Playback | None = None,
        surface_of: SurfaceOf = VoteVolume.surface,
    ) -> None:
        """Prepare to play `source`; nothing runs before `start`.

        Raises:
            ValueError: a grid too large.
        """
        self.source = source
        self.also_told: dict[str, Callable[[], object]] = {}
        """What others tell beside the snapshot, as JSON values, by its name in the state."""
        self._playback = playback or Playback()
        self._surface_of = surface_of
        self._analysis = Analysis(settings, surface_of=surface_of)
        self._records: tuple[Record, ...] = ()
        self._tape = self._new_tape()
        self._observers = Observers()
        # The analysis changes under the first lock, the snapshot under the second, which may be
        # taken while the first is held, never the other way round.
        self._working = threading.Lock()
        self._changed = threading.Condition()
        self._ticket = 0
        self._preview_end: threading.Timer | None = None
        self._stopping = False
        self._thread = threading.Thread(target=self._work, name="live-stream", daemon=True)
        self._snapshot = Snapshot(
            run=1,
            status=self._first_status(),
            speed_hz=self._playback.speed_hz,
            settings=self._analysis.settings,
        )
        self._idle_work = IdleWork(self)

    @property
    def changed(self) -> threading.Condition:
        """Told of every change of the snapshot."""
        return self._changed

    @property
    def snapshot(self) -> Snapshot:
        """What is on show now; never waits, so that an event loop may ask."""
        return self._snapshot

    @property
    def volume(self) -> VoteVolume:
        """The votes of the kept outlines; to be read only, under its lock."""
        return self._analysis.volume

    @property
    def edits_asked(self) -> int:
        """How many edits and previews have been asked for, those under way included."""
        return self._ticket

    def observe(self, observer: Observer) -> None:
        """Call `observer` with the present snapshot and with every later one."""
        with self._changing():
            self._observers.add(observer, self._snapshot)

    def start(self) -> None:
        """Start computing and playing."""
        self._thread.start()
        self._idle_work.start()

    def stop(self, timeout_s: float = 5.0) -> None:
        """End the thread; a frame that is being computed may outlast `timeout_s`."""
        with self._changed:
            self._stopping = True
            self._changed.notify_all()
        self._forget_preview_end()
        if self._preview_end is not None:
            self._preview_end.join(timeout_s)
        self._observers.dismiss(timeout_s)
        self._idle_work.stop(timeout_s)
        if self._thread.is_alive():
            self._thread.join(timeout_s)

    def play(self) -> None:
        """Let frames appear at the set speed, and follow them."""
        self._command(self._playback.play, follows=True)

    def pause(self) -> None:
        """Let nothing appear until told."""
        self._command(self._playback.pause)

    def step(self) -> None:
        """Let one more frame appear, and show it."""
        self._command(self._playback.step, follows=True)

    def set_speed(self, speed_hz: float | None) -> None:
        """Set the frames per second; None is as fast as they are computed."""
        self._command(lambda: self._playback.set_speed(speed_hz))

    def restart(self) -> None:
        """Start again from the first frame; the source is not asked again for what it gave.

        Frames come back with their edited outlines and states: a replay loses no work.
        """
        with self._working:
            self._analysis.rewind()
            if self._snapshot.status == "failed":
                self._tape = self._new_tape()
            self._begin_run()
        self._observers.call()

    def load(self, source: Source) -> None:
        """Play another source from its first frame, carved as this one.

        The frames of this one, their edits and their states are gone.
        """
        with self._working:
            self.source = source
            self._analysis = Analysis(
                self._analysis.settings,
                surface_of=self._surface_of,
                revision=self._analysis.revision + 1,
            )
            self._tape = self._new_tape()
            self._begin_run()
        self._observers.call()

    def _begin_run(self) -> None:
        """Show no frame yet; whoever calls holds the analysis's lock."""
        self._records = ()
        with self._changed:
            self._playback.restart()
            self._publish(
                Snapshot(
                    run=self._snapshot.run + 1,
                    status=self._first_status(),
                    speed_hz=self._playback.speed_hz,
                    settings=self._analysis.settings,
                    latency_ms=self._snapshot.latency_ms,
                )
            )
            self._changed.notify_all()

    def _first_status(self) -> Status:
        if self.source is NO_SOURCE:
            return "empty"
        return "preparing" if self._playback.is_playing else "paused"

    def edit(self, operation: Callable[[Analysis], object]) -> Snapshot:
        """Let `operation` change the analysis, and return the snapshot with the hull after it.

        It waits for no frame that is being imaged. What `operation` raises is raised here, and
        then it has changed nothing. Previews that still wait are dropped.
        """
        arrived_s = time.perf_counter()
        self._next_ticket()
        with self._working:
            operation(self._analysis)
            snapshot = self._show_analysis(edited_s=arrived_s)
        self._forget_preview_end()
        self._observers.call()
        return snapshot

    def preview(self, number: int, silhouette: Silhouette, *, base_revision: int) -> Snapshot:
        """Show the hull as it would be with another outline of a frame; the latest wins.

        Raises:
            StaleRevision: the frame's outline has changed since `base_revision`.
            ValueError: there is no such frame, or an outline that cannot vote.
        """
        ticket = self._next_ticket()
        with self._working:
            if ticket != self._ticket:
                return self._snapshot  # another came while this one waited
            self._analysis.preview(number, silhouette, base_revision=base_revision)
            snapshot = self._show_analysis()
            self._expect_preview_end()
        self._observers.call()
        return snapshot

    def end_preview(self) -> Snapshot:
        """Show the hull itself again."""
        self._next_ticket()
        with self._working:
            if self._snapshot.hull is None or not self._snapshot.hull.is_preview:
                return self._snapshot
            self._analysis.end_preview()
            snapshot = self._show_analysis()
        self._forget_preview_end()
        self._observers.call()
        return snapshot

    def settled(self) -> Settled:
        """Return snapshot and votes as they belong together; waits for a change under way."""
        with self._working:
            return Settled(snapshot=self._snapshot, volume=self._analysis.volume)

    def add_found(self, seen: Snapshot, add: Callable[[Snapshot], Snapshot]) -> None:
        """Show what was found of the hull of the snapshot `seen`, unless there is another now."""
        with self._changing():
            if self._snapshot.hull is seen.hull:
                self._publish(add(self._snapshot))

    def choose(self, number: int | None) -> None:
        """Show frame `number` (from 1) while the hull stays the latest; None follows the latest.

        Raises:
            ValueError: there is no such frame yet.
        """
        with self._changing():
            received = len(self._snapshot.records)
            if number is not None and not 1 <= number <= received:
                raise ValueError(f"{_frames_so_far(received)}; frame {number} cannot be shown.")
            self._publish(replace(self._snapshot, chosen=None if number == received else number))

    def _command(self, change: Callable[[], None], *, follows: bool = False) -> None:
        with self._changing():
            change()
            before = self._snapshot
            after = replace(
                before,
                speed_hz=self._playback.speed_hz,
                chosen=None if follows else before.chosen,
            )
            self._publish(replace(after, status=self._status_when_running(after)))

    def _status_when_running(self, snapshot: Snapshot) -> Status:
        if snapshot.status in ("empty", "finished", "failed"):
            return snapshot.status
        if not self._playback.is_playing:
            return "paused"
        return "playing" if snapshot.records else "preparing"

    @contextmanager
    def _changing(self) -> Iterator[None]:
        """Hold the lock for a change, and tell observers of it once others may have the lock."""
        with self._changed:
            yield
            self._changed.notify_all()
        self._observers.call()

    def _publish(self, snapshot: Snapshot) -> None:
        self._snapshot = replace(snapshot, serial=self._snapshot.serial + 1)
        self._observers.note(self._snapshot)

    def _work(self) -> None:
        while not self._stopping:
            run = self.snapshot.run
            try:
                self._play_through(run)
            except ValueError as error:
                self._end(run, "failed", str(error))
            except Exception as error:  # the thread must not die silently
                _log.exception("The live loop failed.")
                self._end(run, "failed", f"{type(error).__name__} while reconstructing: {error}")
            self._wait_for_restart(run)

    def _play_through(self, run: int) -> None:
        if self.source is NO_SOURCE:
            return
        for take in self._tape.takes():
            if not (self._is_released(run) and self._take_in(run, take)):
                return
        if not self.snapshot.records and not self._is_over(run):
            raise ValueError(f"{self.source.name} holds no frames, so there is nothing to carve.")
        self._end(run, "finished")

    def _is_released(self, run: int) -> bool:
        """Wait until playback lets the next frame appear; tell whether the run goes on."""
        with self._changed:
            while not self._is_over(run) and (wait_s := self._playback.wait_s()) != 0:
                self._changed.wait(wait_s)
            if not self._is_over(run):
                self._playback.mark_released()
            return not self._is_over(run)

    def _take_in(self, run: int, take: Take) -> bool:
        """Receive a frame and show the hull after it; tell whether the run goes on."""
        with self._working:
            if self._is_over(run):
                return False
            outline = take.outline_by(self._analysis.settings.extraction)
            self._analysis.receive(take.frame, outline)
            self._show_analysis()
        self._observers.call()
        return True

    def _show_analysis(self, *, edited_s: float | None = None) -> Snapshot:
        """Publish the analysis as it stands; whoever calls holds its lock."""
        hull, surface = self._analysis.hull, self._analysis.surface
        self._records = _records(self._records, self._analysis)
        latency_ms = None if edited_s is None else 1e3 * (time.perf_counter() - edited_s)
        with self._changed:
            before = self._snapshot
            after = replace(
                before,
                settings=self._analysis.settings,
                records=self._records,
                hull=hull if self._records else None,
                surface=surface if self._records else None,
                light=before.light if surface is before.surface else None,
                latency_ms=before.latency_ms if latency_ms is None else latency_ms,
            )
            self._publish(replace(after, status=self._status_when_running(after)))
            self._changed.notify_all()
            return self._snapshot

    def _next_ticket(self) -> int:
        """Return the number of an edit or preview; a preview is dropped once there is a later."""
        with self._changed:
            self._ticket += 1
            return self._ticket

    def _expect_preview_end(self) -> None:
        self._forget_preview_end()
        self._preview_end = threading.Timer(PREVIEW_LASTS_S, self.end_preview)
        self._preview_end.daemon = True
        self._preview_end.start()

    def _forget_preview_end(self) -> None:
        if self._preview_end is not None:
            self._preview_end.cancel()

    def _end(self, run: int, status: Status, message: str = "") -> None:
        with self._changing():
            if not self._is_over(run):
                self._publish(replace(self._snapshot, status=status, message=message))

    def _is_over(self, run: int) -> bool:
        return self._stopping or self._snapshot.run != run

    def _wait_for_restart(self, run: int) -> None:
        with self._changed:
            self._changed.wait_for(lambda: self._is_over(run))

    def _new_tape(self) -> Tape:
        return Tape(self.source.frames, self._analysis.settings.extraction)


def _records(known: tuple[Record, ...], analysis: Analysis) -> tuple[Record, ...]:
    """Return one record per frame, the known ones themselves where nothing has changed."""
    records = [
        record if record.analysed is frame else replace(record, analysed=frame)
        for record, frame in zip(known, analysis.frames, strict=False)
    ]
    records += [
        Record(analysed=frame, hull=analysis.hull) for frame in analysis.frames[len(known) :]
    ]
    return tuple(records)


def _frames_so_far(count: int) -> str:
    return {0: "No frame has arrived yet", 1: "One frame has arrived so far"}.get(
        count, f"{count} frames have arrived so far"
    )
