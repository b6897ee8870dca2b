"""Telling observers of snapshots, without a lock that they or anybody else would wait for."""

import logging
import threading
from collections import deque
from collections.abc import Callable

from app.snapshot import Snapshot

Observer = Callable[[Snapshot], None]

_log = logging.getLogger("radarhull")


class Observers:
    """Calls observers one at a time and in order, from whichever thread finds nobody at it.

    An observer may take its time, and may fail: that is logged, and it is called again for the
    next snapshot.
    """

    def __init__(self) -> None:
        """Start with nobody to call."""
        self._changed = threading.Condition()
        self._observers: tuple[Observer, ...] = ()
        self._due: deque[tuple[Observer, Snapshot]] = deque()
        self._is_calling = False

    def add(self, observer: Observer, snapshot: Snapshot) -> None:
        """Note that `observer` is to see `snapshot` and every later one."""
        with self._changed:
            self._observers = (*self._observers, observer)
            self._due.append((observer, snapshot))

    def note(self, snapshot: Snapshot) -> None:
        """Note that every observer is to see `snapshot`."""
        with self._changed:
            self._due.extend((observer, snapshot) for observer in self._observers)

    def call(self) -> None:
        """Call for all that is noted; returns at once where another thread is at it."""
        with self._changed:
            if self._is_calling:
                return
            self._is_calling = True
        while (due := self._next_due()) is not None:
            _call(*due)

    def dismiss(self, timeout_s: float) -> None:
        """Call nobody any more, and wait for a call that is under way."""
        with self._changed:
            self._observers = ()
            self._due.clear()
            self._changed.wait_for(lambda: not self._is_calling, timeout_s)

    def _next_due(self) -> tuple[Observer, Snapshot] | None:
        with self._changed:
            if self._due:
                return self._due.popleft()
            self._is_calling = False
            self._changed.notify_all()
            return None


def _call(observer: Observer, snapshot: Snapshot) -> None:
    try:
        observer(snapshot)
    except Exception:
        _log.exception("An observer failed at change %d; the others go on.", snapshot.serial)
