"""In which frames directions can be given: where an orbit is known, beyond the target's own."""

import logging
import threading
from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime, timedelta

from skyfield.api import EarthSatellite

from app.snapshot import Snapshot
from app.source import Source
from app.stream import LiveStream
from core.arrays import Floats
from core.geometry.directions import (
    RTN_FROM_LVLH,
    Direction,
    FrameName,
    direction_in_frames,
)

_log = logging.getLogger("radarhull")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Attitude:
    """How the target frame lies.

    Attributes:
        has_orbit: whether it is the local orbital frame, so that RTN is known.
        satellite: its elements, None where they are not known.
        at_utc: when; of the frame on show.
    """

    has_orbit: bool = False
    satellite: EarthSatellite | None = None
    at_utc: datetime | None = None

    @property
    def frames(self) -> tuple[FrameName, ...]:
        """The frames in which directions can be given."""
        if not self.has_orbit:
            return ("target",)
        return ("target", "RTN") if self.satellite is None else ("target", "RTN", "TEME")

    def direction(self, vector: Floats, *, is_undirected: bool) -> Direction:
        """Return a unit vector (3,) of the target frame in all frames that are known."""
        if self.satellite is not None and self.at_utc is not None:
            return direction_in_frames(
                vector,
                satellite=self.satellite,
                at_utc=self.at_utc,
                is_undirected=is_undirected,
            )
        rtn = RTN_FROM_LVLH @ vector if self.has_orbit else None
        return Direction(target=vector, rtn=rtn, is_undirected=is_undirected)


UNKNOWN = Attitude()


class Attitudes:
    """Knows the attitude at the frame on show, once the source's passes have been looked up.

    Looking them up may take a second, and happens once for each source in a thread of its own.
    """

    def __init__(self, stream: LiveStream, tell: Callable[[], None]) -> None:
        """Know the attitudes of what `stream` plays, and call `tell` when they become known."""
        self._stream = stream
        self._tell = tell
        self._lock = threading.Lock()
        self._key = ""
        self._epochs: dict[str, datetime] = {}
        self._thread: threading.Thread | None = None

    def now(self) -> Attitude:
        """Return the attitude at the frame on show; what is not known yet is told as unknown."""
        source = self._stream.source
        with self._lock:
            if source.key != self._key:
                self._key, self._epochs = source.key, {}
                self._thread = threading.Thread(target=self._learn, args=(source,), daemon=True)
                self._thread.start()
            epochs = self._epochs
        return _at(self._stream.snapshot, source, epochs)

    def learned(self, timeout_s: float) -> Attitude:
        """Return the attitude once the passes have been looked up."""
        self.now()
        if self._thread is not None:
            self._thread.join(timeout_s)
        return self.now()

    def _learn(self, source: Source) -> None:
        try:
            passes = source.course()
        except Exception:  # directions stand in the target frame without it
            _log.exception("The passes of %s could not be looked up.", source.name)
            return
        epochs = {
            each.label: datetime.fromisoformat(each.epoch_utc) for each in passes if each.epoch_utc
        }
        with self._lock:
            if source.key == self._key:
                self._epochs = epochs
        self._tell()


def _at(snapshot: Snapshot, source: Source, epochs: dict[str, datetime]) -> Attitude:
    shown = snapshot.shown
    if shown is None or not epochs:
        return UNKNOWN
    epoch = epochs.get(shown.frame.label)
    if epoch is None or source.satellite is None:
        return Attitude(has_orbit=True)
    at_utc = epoch + timedelta(seconds=shown.frame.time_s)
    return Attitude(has_orbit=True, satellite=source.satellite, at_utc=at_utc)
