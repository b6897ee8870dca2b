"""What may wait until nobody changes a hull: residuals, parts' places, a surface light to draw."""

import logging
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Protocol

from app.snapshot import HullResiduals, PartPlace, Snapshot
from core.analysis.hulls import PartHull
from core.hull.casting import Cancelled, Watch
from core.hull.simplification import simplified
from core.hull.volume import VoteVolume
from core.measurement.components import place_in_whole
from core.measurement.residuals import Outlined, hull_residuals

MOST_IDLE_FACES = 100_000
"""That a browser without a graphics card still turns smoothly."""

QUIET_S = 3.0
"""Without a change, before idle work begins: an analyst at work needs the processors."""

_log = logging.getLogger("radarhull")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Settled:
    """A snapshot together with the votes of its hull, which may change as soon as it is taken."""

    snapshot: Snapshot
    volume: VoteVolume


class Host(Protocol):
    """Whoever has a hull, and wants idle work done on it."""

    @property
    def snapshot(self) -> Snapshot:
        """What is on show now; never waits."""

    @property
    def changed(self) -> threading.Condition:
        """Told of every change of the snapshot."""

    @property
    def edits_asked(self) -> int:
        """How many edits and previews have been asked for, those under way included."""

    def settled(self) -> Settled:
        """Return snapshot and volume as they belong together; waits for a change under way."""

    def add_found(self, seen: Snapshot, add: Callable[[Snapshot], Snapshot]) -> None:
        """Show what was found of the hull of the snapshot `seen`, unless there is another now."""


class IdleWork:
    """Does in a thread of its own what is due once a hull has been quiet for a while.

    Nothing waits for it: it works on surfaces and outlines that never change, reads votes in parts,
    and gives up between two frames as soon as an edit is asked for.
    """

    def __init__(self, host: Host) -> None:
        """Prepare to work for `host`; nothing runs before `start`."""
        self._host = host
        self._is_stopping = False
        self._done: set[str] = set()
        self._jobs = {
            "light surface": self._lighten,
            "places of parts": self._place,
            "residuals": self._compare,
        }
        self._seen = host.snapshot
        self._asked = 0
        self._quiet_since_s = time.monotonic()
        self._thread = threading.Thread(target=self._work, name="idle-work", daemon=True)

    def start(self) -> None:
        """Start waiting for quiet."""
        self._thread.start()

    def stop(self, timeout_s: float) -> None:
        """End the thread; a surface that is being simplified may outlast `timeout_s`."""
        with self._host.changed:
            self._is_stopping = True
            self._host.changed.notify_all()
        if self._thread.is_alive():
            self._thread.join(timeout_s)

    def _work(self) -> None:
        while (job := self._next_job()) is not None:
            name, work = job
            settled = self._host.settled()
            if settled.snapshot.hull is not self._seen.hull:
                continue
            try:
                work(settled)
            except Cancelled:
                continue
            except Exception:  # the hull stands without it
                _log.exception("The %s could not be computed.", name)
            self._done.add(name)

    def _next_job(self) -> tuple[str, Callable[[Settled], None]] | None:
        """Wait for a hull with work to do that stays for a while; None at the end."""
        with self._host.changed:
            while not self._is_stopping:
                self._look(self._host.snapshot)
                name = self._due(self._seen)
                left_s = self._quiet_since_s + QUIET_S - time.monotonic()
                if name is not None and left_s <= 0:
                    return name, self._jobs[name]
                self._host.changed.wait(None if name is None else left_s)
            return None

    def _look(self, shown: Snapshot) -> None:
        """Begin to wait anew where there is another hull or status, or somebody asks for one."""
        is_other = shown.hull is not self._seen.hull or _parts(shown) != _parts(self._seen)
        is_other = is_other or shown.status != self._seen.status
        asked = self._host.edits_asked
        if is_other:
            self._done = set()
        if is_other or asked != self._asked:
            self._quiet_since_s = time.monotonic()
        self._seen, self._asked = shown, asked

    def _due(self, shown: Snapshot) -> str | None:
        """Name what is to be done for a hull, None if nothing."""
        hull = shown.hull
        if hull is None or shown.is_preview or shown.status not in ("paused", "finished"):
            return None
        is_old = shown.residuals is None or shown.residuals.revision != hull.revision
        due = {
            "light surface": _is_heavy(shown),
            "places of parts": bool(_unplaced(shown)),
            "residuals": is_old,
        }
        return next(
            (name for name, is_due in due.items() if is_due and name not in self._done), None
        )

    def _lighten(self, settled: Settled) -> None:
        """Give the browser fewer faces to draw."""
        surface = settled.snapshot.surface
        if surface is not None:
            light = simplified(surface, most_faces=MOST_IDLE_FACES)
            self._host.add_found(settled.snapshot, lambda now: replace(now, light=light))

    def _place(self, settled: Settled) -> None:
        """Tell where the parts are in the whole."""
        snapshot = settled.snapshot
        if snapshot.hull is None or snapshot.surface is None:
            return
        places = dict(snapshot.places)
        for part in _unplaced(snapshot):
            places[part.label] = PartPlace(
                revision=part.hull.revision,
                whole_revision=snapshot.hull.revision,
                place=place_in_whole(part.surface, snapshot.surface),
            )
        self._host.add_found(snapshot, lambda now: replace(now, places=places))

    def _compare(self, settled: Settled) -> None:
        """Tell of each frame what it causes and what it suffers."""
        snapshot, volume = settled.snapshot, settled.volume
        hull, surface = snapshot.hull, snapshot.surface
        if hull is None or surface is None or hull.is_preview:
            return
        outlines = [Outlined(frame=r.frame, silhouette=r.silhouette) for r in snapshot.records]
        found = hull_residuals(volume, surface, outlines, Watch(cancel=self._is_disturbed))
        residuals = HullResiduals(revision=hull.revision, frames=found)
        self._host.add_found(snapshot, lambda now: replace(now, residuals=residuals))

    def _is_disturbed(self) -> bool:
        """Tell whether what is being done is in somebody's way, or of a hull that is no more."""
        is_asked = self._host.edits_asked != self._asked
        return self._is_stopping or is_asked or self._host.snapshot.hull is not self._seen.hull


def _parts(shown: Snapshot) -> list[int]:
    """Return the revisions of the parts' hulls; no two ever share one."""
    return [part.hull.revision for part in shown.parts]


def _unplaced(shown: Snapshot) -> list[PartHull]:
    """Return the parts whose place can be measured and is not known yet."""
    whole = shown.hull
    if whole is None:
        return []
    return [p for p in shown.parts if p.has_place_in(whole) and shown.place_of(p) is None]


def _is_heavy(shown: Snapshot) -> bool:
    is_large = shown.surface is not None and len(shown.surface.faces) > MOST_IDLE_FACES
    return is_large and shown.light is None
