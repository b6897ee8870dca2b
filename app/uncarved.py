"""Keeping the space that few views have carved away in step with the hull, while somebody looks."""

import logging
import threading
import time
from collections.abc import Callable

from app.snapshot import Snapshot
from core.hull.closed_mesh import Surface
from core.hull.uncarved import uncarved_surface
from core.hull.volume import VoteVolume

QUIET_S = 0.4
"""Without a change of the hull, before it is computed: the hull itself comes first."""

_log = logging.getLogger("radarhull")


class UncarvedWatch:
    """Computes the uncarved space in a thread of its own, only while it is wanted."""

    def __init__(self, volume: Callable[[], VoteVolume], show: Callable[[Surface], None]) -> None:
        """Wait for somebody to want it.

        Args:
            volume: gives the votes as they now are.
            show: is called with each new surface, from the thread.
        """
        self._volume = volume
        self._show = show
        self._changed = threading.Condition()
        self._is_wanted = False
        self._is_stopping = False
        self._hull: tuple[int, int] | None = None
        self._changed_s = 0.0
        self._done: tuple[int, int] | None = None
        self._thread = threading.Thread(target=self._work, name="uncarved", daemon=True)
        self._thread.start()

    def note(self, snapshot: Snapshot) -> None:
        """Take notice of a snapshot; a preview changes nothing, for it has not been kept."""
        if snapshot.hull is not None and snapshot.hull.is_preview:
            return
        hull = None if snapshot.hull is None else (snapshot.run, snapshot.hull.revision)
        with self._changed:
            if hull != self._hull:
                self._hull, self._changed_s = hull, time.monotonic()
                self._changed.notify_all()

    def want(self, is_wanted: bool) -> None:
        """Begin to keep it, or stop."""
        with self._changed:
            if is_wanted and not self._is_wanted:
                self._done = None  # what was shown before has been taken off since
            self._is_wanted = is_wanted
            self._changed.notify_all()

    def stop(self, timeout_s: float = 5.0) -> None:
        """End the thread."""
        with self._changed:
            self._is_stopping = True
            self._changed.notify_all()
        self._thread.join(timeout_s)

    def _work(self) -> None:
        while (hull := self._due()) is not None:
            try:
                self._show(uncarved_surface(self._volume()))
            except Exception:  # the thread must not die silently, nor for good
                _log.exception("The uncarved space could not be computed.")
            with self._changed:
                self._done = hull

    def _due(self) -> tuple[int, int] | None:
        """Wait for a hull that has been quiet, whose uncarved space is wanted; None to end."""
        with self._changed:
            while not self._is_stopping:
                if not self._is_wanted or self._hull in (None, self._done):
                    self._changed.wait()
                elif (left_s := self._changed_s + QUIET_S - time.monotonic()) > 0:
                    self._changed.wait(left_s)
                else:
                    return self._hull
            return None
