"""Stating the intervals of measurements in the background, once nobody changes the hull."""

import logging
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from app import idle_work
from app.idle_work import Host
from app.snapshot import Snapshot
from core.arrays import Floats
from core.formats.measurement_fields import encoded
from core.hull.casting import Cancelled, Watch
from core.hull.closed_mesh import Surface
from core.hull.view import View
from core.measurement.axis_order import all_like, order_along
from core.measurement.intervals import Interval, measured_intervals
from core.measurement.lines import LineMeasurement, principal_lines
from core.measurement.measuring import measure_all
from core.measurement.measuring_job import MeasuringContext
from core.measurement.results import Measurement
from core.measurement.specs import Spec
from core.reconstruction import LINE_NAMES

_log = logging.getLogger("radarhull")

HULL_NUMBERS = 7
"""Three extents, three principal lines and the volume, which every hull has."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Wanted:
    """What is to be measured on resampled hulls, besides the hull's own numbers."""

    keys: tuple[int, ...]
    specs: tuple[Spec, ...]
    key_points: Mapping[str, Floats]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Intervals:
    """Intervals of one hull's numbers.

    Attributes:
        revision: of the hull.
        by_key: those of the book's measurements.
        extents: along x, y, z.
        lines: of the principal lines, longest first.
        volume: of the enclosed volume.
        key_points: with which they were measured.
    """

    revision: int
    by_key: Mapping[int, Interval]
    extents: tuple[Interval, ...]
    lines: tuple[Interval, ...]
    volume: Interval
    key_points: Mapping[str, Floats]


@dataclass(frozen=True, slots=True, kw_only=True)
class Progress:
    """How far the computation is.

    Attributes:
        is_running: whether it runs now.
        done, total: hulls measured so far, and to be measured.
        complaint: why there are no intervals of the present hull, empty if there are or will be.
    """

    is_running: bool = False
    done: int = 0
    total: int = 0
    complaint: str = ""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Job:
    snapshot: Snapshot
    wanted: Wanted
    revision: int
    asked: int

    def is_of(self, other: "_Job | None") -> bool:
        """Whether another job would find the same."""
        return (
            other is not None
            and self.revision == other.revision
            and self.wanted.keys == other.wanted.keys
            and self.wanted.key_points is other.wanted.key_points
        )


class IntervalWork:
    """Measures the hulls of resampled outlines in a thread of its own.

    It waits until a hull has been quiet, and gives up between two hulls as soon as an edit is
    asked for, another hull comes or other things are to be measured.
    """

    def __init__(self, host: Host, wanted: Callable[[], Wanted], tell: Callable[[], None]) -> None:
        """Prepare to work; nothing runs before `start`.

        Args:
            host: has the hull.
            wanted: says what is to be measured now.
            tell: is called after every change of `progress` or `found`.
        """
        self._host = host
        self._wanted = wanted
        self._tell = tell
        self._is_stopping = False
        self._is_urgent = False
        self._is_cancelled = False
        self._seen: _Job | None = None
        self._given_up: _Job | None = None
        self._quiet_since_s = time.monotonic()
        self._found: Intervals | None = None
        self._progress = Progress()
        self._thread = threading.Thread(target=self._work, name="intervals", daemon=True)

    @property
    def found(self) -> Intervals | None:
        """The intervals stated last, None before any."""
        return self._found

    @property
    def progress(self) -> Progress:
        """How far the computation is."""
        return self._progress

    def start(self) -> None:
        """Start waiting for quiet."""
        self._thread.start()

    def stop(self, timeout_s: float) -> None:
        """End the thread; a hull that is being carved may outlast `timeout_s`."""
        with self._host.changed:
            self._is_stopping = True
            self._host.changed.notify_all()
        if self._thread.is_alive():
            self._thread.join(timeout_s)

    def look(self) -> None:
        """Look anew at what is wanted."""
        with self._host.changed:
            self._host.changed.notify_all()

    def ask(self) -> None:
        """Begin at once, also with what had been given up."""
        with self._host.changed:
            self._is_urgent, self._given_up = True, None
            self._host.changed.notify_all()

    def cancel(self) -> None:
        """Give up what is being computed, and do not begin again with the same."""
        with self._host.changed:
            self._is_urgent, self._is_cancelled = False, True
            self._given_up = self._seen
            self._host.changed.notify_all()

    def _work(self) -> None:
        while (job := self._next_job()) is not None:
            complaint, found = "", None
            try:
                found = self._stated(job)
            except Cancelled:
                pass
            except ValueError as error:
                complaint = str(error)
            except Exception:  # the numbers stand without them
                _log.exception("The intervals could not be computed.")
                complaint = "The intervals could not be computed; the server's log says why."
            self._end(job, found, complaint)

    def _next_job(self) -> _Job | None:
        """Wait for a hull without intervals that stays for a while; None at the end."""
        with self._host.changed:
            while (job := self._due_now()) is None:
                if self._is_stopping:
                    return None
            self._is_urgent = self._is_cancelled = False
            self._progress = Progress(is_running=True)
        self._tell()
        return job

    def _due_now(self) -> _Job | None:
        """Return what is to be done now; where it is nothing, or not yet, wait a while first."""
        job = self._look(self._host.snapshot, self._wanted())
        left_s = self._quiet_since_s + idle_work.QUIET_S - time.monotonic()
        if self._is_stopping or (job is not None and (self._is_urgent or left_s <= 0)):
            return None if self._is_stopping else job
        self._host.changed.wait(None if job is None else left_s)
        return None

    def _look(self, shown: Snapshot, wanted: Wanted) -> _Job | None:
        """Return what is to be done, None if nothing; waits anew where something is other."""
        hull = shown.hull
        job = _Job(
            snapshot=shown,
            wanted=wanted,
            revision=-1 if hull is None else hull.revision,
            asked=self._host.edits_asked,
        )
        if not job.is_of(self._seen) or self._seen is None or job.asked != self._seen.asked:
            self._quiet_since_s = time.monotonic()
            self._progress = replace(self._progress, complaint="")
            self._seen = job
        if hull is None or hull.is_preview or shown.status not in ("paused", "finished"):
            return None
        if shown.surface is None or shown.surface.is_empty or job.is_of(self._given_up):
            return None
        return None if self._has(job) else job

    def _has(self, job: _Job) -> bool:
        found = self._found
        return (
            found is not None
            and found.revision == job.revision
            and found.key_points is job.wanted.key_points
            and set(job.wanted.keys) <= set(found.by_key)
        )

    def _stated(self, job: _Job) -> Intervals:
        settings, wanted = job.snapshot.settings, job.wanted
        found = measured_intervals(
            voting_views(job.snapshot),
            settings.grid(),
            _numbers_like(job.snapshot.surface, wanted),
            tolerated_misses=settings.tolerated_misses,
            watch=Watch(progress=self._note, cancel=lambda: self._is_disturbed(job)),
        )
        own, mine = found[:HULL_NUMBERS], found[HULL_NUMBERS:]
        return Intervals(
            revision=job.revision,
            by_key=dict(zip(wanted.keys, mine, strict=True)),
            extents=own[:3],
            lines=own[3:6],
            volume=own[6],
            key_points=wanted.key_points,
        )

    def _note(self, done: int, total: int) -> None:
        self._progress = Progress(is_running=True, done=done, total=total)
        self._tell()

    def _is_disturbed(self, job: _Job) -> bool:
        is_asked = self._host.edits_asked != job.asked
        is_other = self._host.snapshot.hull is not job.snapshot.hull
        if self._is_stopping or self._is_cancelled or is_asked or is_other:
            return True
        wanted = self._wanted()
        return wanted.keys != job.wanted.keys or wanted.key_points is not job.wanted.key_points

    def _end(self, job: _Job, found: Intervals | None, complaint: str) -> None:
        with self._host.changed:
            self._found = found or self._found
            if complaint:
                self._given_up = job
            self._is_cancelled = False
            self._progress = Progress(complaint=complaint)
        self._tell()


def voting_views(snapshot: Snapshot) -> tuple[View, ...]:
    """Return the views of all frames that vote, as they vote."""
    ballots = (record.analysed for record in snapshot.records if record.analysed.votes)
    return tuple(frame.ballot.view for frame in ballots if frame.ballot.view is not None)


def encoded_alike(one: Spec, other: Spec) -> bool:
    """Whether two specs are written the same."""
    return encoded(one) == encoded(other)


def _numbers_like(shown: Surface | None, wanted: Wanted) -> Callable[[Surface], Floats]:
    """Return what reads the numbers of a hull, its axes in the order that the shown hull has."""
    if shown is None:
        raise ValueError("There is no hull yet, so it has no numbers to state intervals of.")
    context = MeasuringContext(key_points=wanted.key_points)
    references = measure_all(wanted.specs, shown, context)
    axes = _line_directions(principal_lines(shown, LINE_NAMES))

    def numbers(surface: Surface) -> Floats:
        extents = np.ptp(surface.vertices_m, axis=0)
        lines = principal_lines(surface, LINE_NAMES)
        lengths = [lines[number].length_m for number in order_along(_line_directions(lines), axes)]
        results = all_like(measure_all(wanted.specs, surface, context), references)
        values = [each.value if isinstance(each, Measurement) else np.nan for each in results]
        return np.array([*extents, *lengths, surface.volume_m3(), *values])

    return numbers


def _line_directions(lines: Sequence[LineMeasurement]) -> Floats:
    return np.array([line.direction for line in lines])
