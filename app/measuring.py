"""The desk at which measurements are kept, and measured anew on every hull."""

import logging
import threading
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType

import numpy as np

from app.idle_work import Host
from app.measured_items import Found, Item, Job, measured, since, with_interval, with_marks
from app.measuring_intervals import (
    Intervals,
    IntervalWork,
    Progress,
    Wanted,
    encoded_alike,
)
from app.snapshot import Snapshot
from core.analysis.measurement_book import MeasurementBook
from core.arrays import Floats
from core.measurement.specs import Spec

Observer = Callable[[tuple["Item", ...]], None]

_log = logging.getLogger("radarhull")


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
        self._covariances_m2: Mapping[str, Floats] = MappingProxyType({})
        self._snapshot: Snapshot | None = None
        self._run = 0
        self._found: dict[int, Found] = {}
        self._done: Job | None = None
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
        items = (
            with_interval(
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
        founds = (found.get(entry.key) for entry in entries)
        return tuple(with_marks(*pair) for pair in zip(items, founds, strict=True))

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

    def set_key_points(
        self, places: Mapping[str, Floats], covariances_m2: Mapping[str, Floats] | None = None
    ) -> None:
        """Let key points lie elsewhere; what refers to them is measured anew.

        Args:
            places: (3,) of each by name, target frame.
            covariances_m2: (3, 3) of each place; one without is taken to be exact.
        """
        covariances_m2 = covariances_m2 or {}
        with self._changed:
            if _are_same(places, self._key_points) and _are_same(
                covariances_m2, self._covariances_m2
            ):
                return
            self._key_points = MappingProxyType(dict(places))
            self._covariances_m2 = MappingProxyType(dict(covariances_m2))
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

    def _due(self) -> Job | None:
        """Return what is to be measured, None if it has been; under the lock."""
        if self._snapshot is None:
            return None
        job = Job(
            snapshot=self._snapshot,
            book=self._book,
            key_points=self._key_points,
            covariances_m2=self._covariances_m2,
        )
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

    def _measure(self, job: Job) -> None:
        try:
            found = measured(job)
        except Exception:  # the thread must not die silently, nor for good
            _log.exception("The hull could not be measured.")
            found = {}
        with self._changed:
            if self._run == job.snapshot.run:
                before = self._found
                self._found = {key: since(before.get(key), one) for key, one in found.items()}
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


def _are_same(one: Mapping[str, Floats], other: Mapping[str, Floats]) -> bool:
    return one.keys() == other.keys() and all(
        np.array_equal(value, other[name]) for name, value in one.items()
    )
