"""The desk at which measurements are kept, and measured anew on every hull."""

import logging
import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

from app.idle_work import Host
from app.measuring_intervals import (
    Intervals,
    IntervalWork,
    Progress,
    Wanted,
    encoded_alike,
    voting_views,
)
from app.snapshot import Snapshot
from core.analysis.measurement_book import MeasurementBook
from core.analysis.measurement_grades import graded
from core.arrays import Floats
from core.measurement.intervals import Interval
from core.measurement.measuring import MeasuringContext, measure_all
from core.measurement.observability import Grade
from core.measurement.results import Lost, Measurement
from core.measurement.specs import Spec

Observer = Callable[[tuple["Item", ...]], None]

_log = logging.getLogger("radarhull")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Item:
    """A measurement as it stands.

    Attributes:
        spec: how it is measured.
        is_hidden: whether it is left out of the drawing.
        result: on the hull whose revision it names, None until measured.
        interval: of that very value, None while there is none.
        change: of the value against the one on the hull measured before, in its unit; None where
            either is missing.
        observability: how well the views constrain it, None where that is no question.
        old_interval: the interval of the value on an earlier hull, None where there is none or a
            present one; with the revision of that hull.
        old_revision: of that hull.
    """

    spec: Spec
    is_hidden: bool
    result: Measurement | Lost | None
    interval: Interval | None
    change: float | None
    observability: Grade | None = None
    old_interval: Interval | None = None
    old_revision: int = 0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Found:
    """What was found of one entry of the book."""

    result: Measurement | Lost
    observability: Grade | None
    change: float | None


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Job:
    """What is to be measured: the hull of a snapshot by the book and its key points."""

    snapshot: Snapshot
    book: MeasurementBook
    key_points: Mapping[str, Floats]


class MeasurementDesk:
    """Keeps the book of measurements, and measures each new hull in a thread of its own.

    The latest hull wins: one that came and went while another was being measured is passed over.
    What is being tried out (a preview) is not measured. Observers are called from that thread, one
    after another.
    """

    def __init__(self, host: Host) -> None:
        """Measure the hulls of `host`; nothing runs before `start`."""
        self._host = host
        self._changed = threading.Condition()
        self._book = MeasurementBook()
        self._key_points: Mapping[str, Floats] = MappingProxyType({})
        self._snapshot: Snapshot | None = None
        self._run = 0
        self._found: dict[int, _Found] = {}
        self._done: _Job | None = None
        self._serial = 0
        self._told = 0
        self._observers: list[Observer] = []
        self._newcomers: list[Observer] = []
        self._is_stopping = False
        self._intervals = IntervalWork(host, self._wanted, self._touch)
        self._thread = threading.Thread(target=self._work, name="measuring", daemon=True)

    @property
    def book(self) -> MeasurementBook:
        """What is to be measured."""
        return self._book

    @property
    def items(self) -> tuple[Item, ...]:
        """All measurements in their order, as they stand now."""
        with self._changed:
            found, entries = self._found, self._book.entries
        intervals = self._intervals.found
        return tuple(
            _with_interval(
                Item(
                    spec=entry.spec,
                    is_hidden=entry.is_hidden,
                    result=None if (one := found.get(entry.key)) is None else one.result,
                    interval=None,
                    change=None if one is None else one.change,
                    observability=None if one is None else one.observability,
                ),
                entry.key,
                intervals,
            )
            for entry in entries
        )

    @property
    def serial(self) -> int:
        """Grows with every change of what the desk shows."""
        return self._serial

    @property
    def revision(self) -> int | None:
        """Of the hull that was measured last, None before one."""
        done = self._done
        return None if done is None or done.snapshot.hull is None else done.snapshot.hull.revision

    @property
    def progress(self) -> Progress:
        """How far the intervals are."""
        return self._intervals.progress

    @property
    def intervals(self) -> Intervals | None:
        """The intervals that were stated last, of which hull they tell."""
        return self._intervals.found

    @property
    def key_points(self) -> Mapping[str, Floats]:
        """(3,) places of key points by name, target frame."""
        return self._key_points

    def set_key_points(self, places: Mapping[str, Floats]) -> None:
        """Let key points lie elsewhere; what refers to them is measured anew."""
        with self._changed:
            self._key_points = MappingProxyType(dict(places))
            self._changed.notify_all()
        self._intervals.look()

    def observe(self, observer: Observer) -> None:
        """Call `observer` with the present items and with all later ones."""
        with self._changed:
            self._newcomers.append(observer)
            self._changed.notify_all()

    def note(self, snapshot: Snapshot) -> None:
        """Take notice of a snapshot; one of a hull that is only tried out changes nothing."""
        hull = snapshot.hull
        if hull is not None and hull.is_preview:
            return
        with self._changed:
            if snapshot.run != self._run or hull is None:
                if self._found:
                    self._serial += 1
                self._run, self._found, self._done = snapshot.run, {}, None
            is_known = self._snapshot is not None and self._snapshot.hull is hull
            if not is_known:
                self._snapshot = None if hull is None else snapshot
            self._changed.notify_all()

    def add(self, spec: Spec) -> None:
        """Measure something more.

        Raises:
            ValueError: a name that is taken, or a reference to none.
        """
        self._turn(lambda book: book.added((spec,)))

    def take_in(self, specs: Sequence[Spec]) -> None:
        """Measure all that a file asks for and is not measured yet: all of it or nothing.

        Raises:
            ValueError: something else has such a name.
        """
        self._turn(lambda book: book.taken_in(specs, encoded_alike))

    def replace(self, name: str, spec: Spec) -> None:
        """Measure something else in the place of what has that name.

        Raises:
            ValueError: there is no such name, or the new one is taken.
        """
        self._turn(lambda book: book.replaced(name, spec))

    def remove(self, name: str, *, along: bool = False) -> None:
        """Measure something no more; `along` takes with it what is computed from it.

        Raises:
            ValueError: there is no such name, or others are computed from it and may not go along.
        """
        self._turn(lambda book: book.removed(name, along=along))

    def rename(self, name: str, new: str) -> None:
        """Call a measurement otherwise; what is computed from it follows.

        Raises:
            ValueError: there is no such name, or the new one is taken.
        """
        self._turn(lambda book: book.renamed(name, new))

    def set_note(self, name: str, note: str) -> None:
        """Write another note to a measurement.

        Raises:
            ValueError: there is no such name.
        """
        self._turn(lambda book: book.noted(name, note))

    def set_hidden(self, name: str, hidden: bool) -> None:
        """Leave a measurement out of the drawing, or draw it again.

        Raises:
            ValueError: there is no such name.
        """
        self._turn(lambda book: book.hidden(name, hidden))

    def undo(self) -> None:
        """Take the last change of the book back.

        Raises:
            NothingLeft: there is none.
        """
        self._turn(MeasurementBook.undone)

    def redo(self) -> None:
        """Make the change again that was taken back last.

        Raises:
            NothingLeft: there is none.
        """
        self._turn(MeasurementBook.redone)

    def clear(self) -> None:
        """Measure nothing any more; undo takes it back."""
        self._turn(MeasurementBook.cleared)

    def turn(self, change: Callable[[MeasurementBook], MeasurementBook]) -> None:
        """Change the book by several steps at once, or, if one of them raises, not at all."""
        self._turn(change)

    def free_name(self, stem: str) -> str:
        """Return a name that nothing has yet, such as "length 3"."""
        return self._book.free_name(stem)

    def start_intervals(self) -> None:
        """State intervals now, without waiting for quiet."""
        self._intervals.ask()

    def cancel_intervals(self) -> None:
        """Give up the intervals that are being computed, until hull or book is another."""
        self._intervals.cancel()

    def start(self) -> None:
        """Start measuring."""
        self._thread.start()
        self._intervals.start()

    def stop(self, timeout_s: float = 5.0) -> None:
        """End the threads; a hull that is being measured may outlast `timeout_s`."""
        with self._changed:
            self._is_stopping = True
            self._changed.notify_all()
        self._intervals.stop(timeout_s)
        if self._thread.is_alive():
            self._thread.join(timeout_s)

    def wait(self, timeout_s: float) -> bool:
        """Wait until everything is measured on the present hull; tell whether it is."""
        with self._changed:
            return self._changed.wait_for(lambda: self._due() is None, timeout_s)

    def _turn(self, change: Callable[[MeasurementBook], MeasurementBook]) -> None:
        with self._changed:
            self._book = change(self._book)
            self._serial += 1
            self._changed.notify_all()
        self._intervals.look()

    def _touch(self) -> None:
        with self._changed:
            self._serial += 1
            self._changed.notify_all()

    def _wanted(self) -> Wanted:
        with self._changed:
            keys = tuple(entry.key for entry in self._book.entries)
            return Wanted(keys=keys, specs=self._book.specs, key_points=self._key_points)

    def _due(self) -> _Job | None:
        """Return what is to be measured, None if it has been; under the lock."""
        if self._snapshot is None:
            return None
        job = _Job(snapshot=self._snapshot, book=self._book, key_points=self._key_points)
        done = self._done
        is_done = (
            done is not None
            and done.snapshot.hull is job.snapshot.hull
            and done.book.entries is job.book.entries
            and done.key_points is job.key_points
        )
        return None if is_done else job

    def _work(self) -> None:
        while (act := self._next()) is not None:
            act()

    def _next(self) -> Callable[[], None] | None:
        """Wait for something to measure or to tell; None at the end."""
        with self._changed:
            while not self._is_stopping:
                if (job := self._due()) is not None:
                    return lambda: self._measure(job)
                if self._newcomers or self._told != self._serial:
                    return self._tell
                self._changed.wait()
            return None

    def _measure(self, job: _Job) -> None:
        try:
            found = _measured(job)
        except Exception:  # the thread must not die silently, nor for good
            _log.exception("The hull could not be measured.")
            found = {}
        with self._changed:
            if self._run == job.snapshot.run:
                before = self._found
                self._found = {key: _since(before.get(key), one) for key, one in found.items()}
                self._done = job
            self._serial += 1
            self._changed.notify_all()

    def _tell(self) -> None:
        with self._changed:
            serial, fresh = self._serial, self._newcomers
            due = [*self._observers, *fresh] if self._told != serial else list(fresh)
            self._observers, self._newcomers, self._told = [*self._observers, *fresh], [], serial
        items = self.items
        for observer in due:
            try:
                observer(items)
            except Exception:
                _log.exception("An observer of measurements failed; the others go on.")


def _measured(job: _Job) -> dict[int, _Found]:
    """Measure a hull by every entry of the book, by their keys."""
    snapshot, entries, specs = job.snapshot, job.book.entries, job.book.specs
    hull, surface = snapshot.hull, snapshot.surface
    if hull is None or surface is None or not entries:
        return {}
    context = MeasuringContext(
        revision=hull.revision, threshold=hull.threshold, key_points=job.key_points
    )
    results = measure_all(specs, surface, context)
    grades = graded(results, specs, voting_views(snapshot), snapshot.settings.grid(), hull.extents)
    return {
        entry.key: _Found(result=result, observability=grade, change=None)
        for entry, result, grade in zip(entries, results, grades, strict=True)
    }


def _since(before: _Found | None, now: _Found) -> _Found:
    """Return what was found with its change against what was found on the hull before."""
    if before is None or isinstance(before.result, Lost) or isinstance(now.result, Lost):
        return now
    if before.result.revision == now.result.revision:
        return replace(now, change=before.change)
    return replace(now, change=now.result.value - before.result.value)


def _with_interval(item: Item, key: int, intervals: Intervals | None) -> Item:
    """Return an item with its interval if that is of its very value, else as an old one."""
    interval = None if intervals is None else intervals.by_key.get(key)
    if intervals is None or interval is None:
        return item
    if isinstance(item.result, Measurement) and item.result.revision == intervals.revision:
        return replace(item, interval=interval)
    return replace(item, old_interval=interval, old_revision=intervals.revision)
