"""Marks of key points: which corner was seen where in which frames, and the way back."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from core.analysis.history import NothingLeft

Place = tuple[float, float]
"""(row, column) in a frame's pixels."""

Marks = Mapping[str, Mapping[int, Place]]
"""Of each key point by name, its place in each frame by number; no name is without a mark."""

NO_MARKS: Marks = MappingProxyType({})

LONGEST_NAME = 40
"""Characters, that a name still fits beside its cross in the picture."""

MOST_POINTS = 200
"""Of one book: each is placed anew with every change of the frames' projections."""

MOST_STEPS = 1000
"""That can be taken back; older ones are forgotten."""

FIRST_SIGMA_PX = 1.0
"""Standard deviation of a mark's row or column unless the analyst says another: in a radar frame,
whose pixels are about as fine as its resolution, a corner is marked to about one."""

LEAST_SIGMA_PX, MOST_SIGMA_PX = 0.01, 100.0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class KeyPointBook:
    """Key points' marks, as they are and as they were; every change gives another book.

    Attributes:
        versions: oldest first; those past `position` have been taken back.
        position: of the present one.
        sigma_px: standard deviation of a mark's row or column, as the analyst judges it; it is no
            part of the history.
        revision: grows with every change, undo and redo.
    """

    versions: tuple[Marks, ...] = (NO_MARKS,)
    position: int = 0
    sigma_px: float = FIRST_SIGMA_PX
    revision: int = 0

    @property
    def marks(self) -> Marks:
        """The present marks; points in the order in which they were first marked."""
        return self.versions[self.position]

    @property
    def can_undo(self) -> bool:
        """Whether there is a change to take back."""
        return self.position > 0

    @property
    def can_redo(self) -> bool:
        """Whether a change that was taken back can be made again."""
        return self.position < len(self.versions) - 1

    def marked(self, name: str, frame: int, place: Place) -> "KeyPointBook":
        """Return the book with a point marked in a frame, for the first time or anew.

        Args:
            name: of the point; one that is not in the book yet begins a point.
            frame: its number, from 1.
            place: (row, column) of the corner in its pixels.

        Raises:
            ValueError: a name that is none, a frame below 1, a place that is not finite, or too
                many points.
        """
        name = checked_name(name)
        if frame < 1:
            raise ValueError(f"Frames are numbered from 1; {name} cannot be marked in {frame}.")
        row, column = (float(value) for value in place)
        if not np.isfinite([row, column]).all():
            raise ValueError(f"A mark needs a finite row and column, got ({row}, {column}).")
        if name not in self.marks and len(self.marks) == MOST_POINTS:
            raise ValueError(
                f"There are {MOST_POINTS} key points, which is the most; delete one first."
            )
        point = {**self.marks.get(name, {}), frame: (row, column)}
        return self._with({**self.marks, name: _by_frame(point)})

    def without_mark(self, name: str, frame: int) -> "KeyPointBook":
        """Return the book without a point's mark in a frame; the point goes with its last mark.

        Raises:
            ValueError: there is no such point, or it is not marked in that frame.
        """
        point = dict(self._point(name))
        if frame not in point:
            raise ValueError(f"{name} is not marked in frame {frame}.")
        del point[frame]
        return self._with({**self.marks, name: _by_frame(point)}) if point else self.without(name)

    def without(self, name: str) -> "KeyPointBook":
        """Return the book without a point.

        Raises:
            ValueError: there is no such point.
        """
        self._point(name)
        return self._with({key: marks for key, marks in self.marks.items() if key != name})

    def renamed(self, name: str, new_name: str) -> "KeyPointBook":
        """Return the book with another name for a point, in its place.

        Raises:
            ValueError: there is no such point, the new name is another's, or it is none.
        """
        self._point(name)
        new_name = checked_name(new_name)
        if new_name == name:
            return self
        if new_name in self.marks:
            raise ValueError(f'There is a key point "{new_name}" already; take another name.')
        renamed = {(new_name if key == name else key): m for key, m in self.marks.items()}
        return self._with(renamed)

    def with_sigma_px(self, sigma_px: float) -> "KeyPointBook":
        """Return the book with another judgement of how exactly corners are marked.

        Raises:
            ValueError: a standard deviation that no analyst has.
        """
        if not LEAST_SIGMA_PX <= sigma_px <= MOST_SIGMA_PX:
            raise ValueError(
                f"A mark's standard deviation lies between {LEAST_SIGMA_PX:g} and "
                f"{MOST_SIGMA_PX:g} px; got {sigma_px:g}."
            )
        return replace(self, sigma_px=float(sigma_px), revision=self.revision + 1)

    def undone(self) -> "KeyPointBook":
        """Return the book one change back.

        Raises:
            NothingLeft: there is none.
        """
        if not self.can_undo:
            raise NothingLeft("There is no change of key points to take back.")
        return replace(self, position=self.position - 1, revision=self.revision + 1)

    def redone(self) -> "KeyPointBook":
        """Return the book one change forward again.

        Raises:
            NothingLeft: there is none.
        """
        if not self.can_redo:
            raise NothingLeft("There is no change of key points to make again.")
        return replace(self, position=self.position + 1, revision=self.revision + 1)

    def _point(self, name: str) -> Mapping[int, Place]:
        if name not in self.marks:
            raise ValueError(f'There is no key point "{name}".')
        return self.marks[name]

    def _with(self, marks: Mapping[str, Mapping[int, Place]]) -> "KeyPointBook":
        kept = self.versions[max(0, self.position + 1 - MOST_STEPS) : self.position + 1]
        versions = (*kept, MappingProxyType(dict(marks)))
        return replace(
            self, versions=versions, position=len(versions) - 1, revision=self.revision + 1
        )


def checked_name(text: str) -> str:
    """Return a key point's name with its white space made single.

    Raises:
        ValueError: an empty or too long name, or one that cannot be printed.
    """
    name = " ".join(text.split())
    if not 1 <= len(name) <= LONGEST_NAME or not name.isprintable():
        raise ValueError(
            f"A key point's name has 1 to {LONGEST_NAME} printable characters; this one has "
            f"{len(name)}."
        )
    return name


def _by_frame(point: Mapping[int, Place]) -> Mapping[int, Place]:
    return MappingProxyType(dict(sorted(point.items())))
