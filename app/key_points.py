"""Key points beside the live loop: their marks, and where the frames so far put them."""

import threading
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

from app.snapshot import Snapshot
from core.analysis.key_point_marks import KeyPointBook
from core.analysis.key_point_places import PlacedPoint, placed_points
from core.arrays import Floats
from core.geometry.projection import Projection


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class KeyPointState:
    """Key points at one moment, consistent in itself.

    Attributes:
        book: their marks.
        projections: of the frames that have come, by number, registered where they are.
        points: what both give.
    """

    book: KeyPointBook
    projections: Mapping[int, Projection]
    points: tuple[PlacedPoint, ...]

    @property
    def places_m(self) -> dict[str, Floats]:
        """(3,) by name, target frame, of the points that have a place."""
        return {p.name: p.place.position_m for p in self.points if p.place is not None}

    @property
    def covariances_m2(self) -> dict[str, Floats]:
        """(3, 3) of those places, by name."""
        return {p.name: p.place.covariance_m2 for p in self.points if p.place is not None}


Observer = Callable[[KeyPointState], None]


class KeyPoints:
    """Keeps the marks of a live loop's key points, and their places up to date.

    Safe to use from any thread: changes and news of frames come one at a time, and reading waits
    for nobody. The marks outlive a replay; those of another source are forgotten.
    """

    def __init__(self, source_key: Callable[[], str]) -> None:
        """Keep no mark yet; `source_key` tells one source of frames from another."""
        self._source_key = source_key
        self._marked_source = source_key()
        self._lock = threading.Lock()
        self._observers: list[Observer] = []
        self._state = KeyPointState(
            book=KeyPointBook(), projections=MappingProxyType({}), points=()
        )

    @property
    def state(self) -> KeyPointState:
        """The key points now."""
        return self._state

    def observe(self, observer: Observer) -> None:
        """Call `observer` with the present state and every later one; it must not change them."""
        with self._lock:
            self._observers.append(observer)
            observer(self._state)

    def note(self, snapshot: Snapshot) -> None:
        """Take notice of which frames have come, and of how they project."""
        projections = {record.number: record.frame.projection for record in snapshot.records}
        with self._lock:
            book, key = self._state.book, self._source_key()
            if key != self._marked_source:
                self._marked_source = key
                forgotten = KeyPointBook(sigma_px=book.sigma_px)
                book = replace(forgotten, revision=book.revision + 1)
            if book is not self._state.book or projections != self._state.projections:
                self._place(book, MappingProxyType(projections))

    def change(self, operation: Callable[[KeyPointBook], KeyPointBook]) -> KeyPointState:
        """Let `operation` make another book of the present one, and return what that gives.

        What `operation` raises is raised here, and then nothing has changed.
        """
        with self._lock:
            book = operation(self._state.book)
            if book is not self._state.book:
                self._place(book, self._state.projections)
            return self._state

    def _place(self, book: KeyPointBook, projections: Mapping[int, Projection]) -> None:
        points = placed_points(book, projections)
        self._state = KeyPointState(book=book, projections=projections, points=points)
        for observer in self._observers:
            observer(self._state)
