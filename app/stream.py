"""The live loop: frames in, snapshots of the shrinking hull out, at the analyst's pace."""

import logging
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import replace

from app.observers import Observer, Observers
from app.playback import Playback
from app.snapshot import Snapshot, Status, record_of
from app.source import Source
from core.frame import Frame
from core.hull.closed_mesh import Surface
from core.hull.simplification import simplified
from core.hull.volume import VoteVolume
from core.reconstruction import ReconstructionSettings, Step, reconstruct

SurfaceOf = Callable[[VoteVolume], Surface]

MOST_IDLE_FACES = 100_000
"""That a browser without a graphics card still turns smoothly."""

_log = logging.getLogger("radarhull")


class LiveStream:
    """Runs a reconstruction in a thread and tells observers of every change.

    The next step is computed while the current one is on screen, and held back until playback
    releases it: stepping is immediate, and nothing changes while paused. Observers are called one
    at a time and in order, and nobody waits for them but the thread that calls them.
    """

    def __init__(
        self,
        source: Source,
        settings: ReconstructionSettings | None = None,
        *,
        playback: Playback | None = None,
        surface_of: SurfaceOf = VoteVolume.surface,
    ) -> None:
        """Prepare to play `source`; nothing runs before `start`."""
        self.source = source
        self.settings = settings or ReconstructionSettings()
        self._playback = playback or Playback()
        self._surface_of = surface_of
        self._tape = _Tape(source.frames)
        self._observers = Observers()
        self._changed = threading.Condition()
        self._stopping = False
        self._thread = threading.Thread(target=self._work, name="live-stream", daemon=True)
        self._snapshot = Snapshot(
            run=1,
            status="preparing" if self._playback.is_playing else "paused",
            speed_hz=self._playback.speed_hz,
        )

    @property
    def snapshot(self) -> Snapshot:
        """What is on show now; never waits, so that an event loop may ask."""
        return self._snapshot

    def observe(self, observer: Observer) -> None:
        """Call `observer` with the present snapshot and with every later one."""
        with self._changing():
            self._observers.add(observer, self._snapshot)

    def start(self) -> None:
        """Start computing and playing."""
        self._thread.start()

    def stop(self, timeout_s: float = 5.0) -> None:
        """End the thread; a frame that is being computed may outlast `timeout_s`."""
        with self._changed:
            self._stopping = True
            self._changed.notify_all()
        self._observers.dismiss(timeout_s)
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
        """Start again from the first frame; frames already received are not asked for again."""
        with self._changing():
            self._playback.restart()
            if self._snapshot.status == "failed":
                self._tape = _Tape(self.source.frames)
            self._publish(
                Snapshot(
                    run=self._snapshot.run + 1,
                    status="preparing",
                    speed_hz=self._playback.speed_hz,
                )
            )

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
        if snapshot.status in ("finished", "failed"):
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
        for step in reconstruct(self._tape.frames(), self.settings, surface_of=self._surface_of):
            if not self._release(run, step):
                return
        if not self.snapshot.records and not self._is_over(run):
            raise ValueError(f"{self.source.name} holds no frames, so there is nothing to carve.")
        self._end(run, "finished")
        # Seconds of work for half a million faces; the whole hull is on show meanwhile.
        self._lighten(run)

    def _lighten(self, run: int) -> None:
        """Give the browser fewer faces to draw, now that no frame will change them."""
        surface = self.snapshot.surface
        if surface is None or len(surface.faces) <= MOST_IDLE_FACES:
            return
        light = simplified(surface, most_faces=MOST_IDLE_FACES)
        with self._changing():
            if not self._is_over(run):
                self._publish(replace(self._snapshot, light=light))

    def _release(self, run: int, step: Step) -> bool:
        """Publish a step once playback lets it; tell whether the run goes on."""
        record = record_of(step)
        with self._changing():
            while not self._is_over(run) and (wait_s := self._playback.wait_s()) != 0:
                self._changed.wait(wait_s)
            if self._is_over(run):
                return False
            self._playback.mark_released()
            snapshot = replace(
                self._snapshot,
                records=(*self._snapshot.records, record),
                surface=step.surface,
            )
            self._publish(replace(snapshot, status=self._status_when_running(snapshot)))
        return True

    def _end(self, run: int, status: Status, message: str = "") -> None:
        with self._changing():
            if not self._is_over(run):
                self._publish(replace(self._snapshot, status=status, message=message))

    def _is_over(self, run: int) -> bool:
        return self._stopping or self._snapshot.run != run

    def _wait_for_restart(self, run: int) -> None:
        with self._changed:
            while not self._is_over(run):
                self._changed.wait()


class _Tape:
    """Remembers the frames of a source, so that playing them again costs nothing.

    A source's failure is remembered too: a generator that has raised looks finished afterwards.
    """

    def __init__(self, factory: Callable[[], Iterable[Frame]]) -> None:
        self._factory = factory
        self._recorded: list[Frame] = []
        self._rest: Iterator[Frame] | None = None
        self._failure: Exception | None = None

    def frames(self) -> Iterator[Frame]:
        """Yield the recorded frames, then what the source has left."""
        yield from self._recorded
        while (frame := self._next()) is not None:
            self._recorded.append(frame)
            yield frame

    def _next(self) -> Frame | None:
        if self._failure is not None:
            raise self._failure
        try:
            if self._rest is None:
                self._rest = iter(self._factory())
            return next(self._rest, None)
        except Exception as failure:
            self._failure = failure
            raise


def _frames_so_far(count: int) -> str:
    return {0: "No frame has arrived yet", 1: "One frame has arrived so far"}.get(
        count, f"{count} frames have arrived so far"
    )
