"""Votes of all views on a window of a few planes x, for hulls too large to store their votes.

Lines along y and along z both lie within a plane x, so each plane is voted on by itself. What lies
before the window along a line is marked at its first voxel; every crossing is the whole grid's, to
the last bit.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.hull.pullback import PulledBack, joined, pulled_back
from core.hull.threads import Compiled, InnerLoop
from core.hull.votes import MOST_BYTE_VIEWS, Voter, Votes

EXCHANGED = [0, 2, 1, 3]
"""Columns of a map from homogeneous voxel indices with y and z exchanged."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Window:
    """A box of voxels.

    Attributes:
        low: (3,) index of its first voxel.
        shape: voxels along x, y, z.
    """

    low: NDArray[np.int64]
    shape: tuple[int, int, int]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PlaneVoter:
    """All views made ready to vote plane by plane.

    Attributes:
        along_y: outlines of the views that see lines along y; planes count along x, places along z.
        along_z: those of the views that look along y; planes count along x, places along y.
        dtype: of the votes.
    """

    along_y: PulledBack
    along_z: PulledBack
    dtype: np.dtype[Any]

    @classmethod
    def of(cls, voters: Iterable[Voter]) -> "PlaneVoter":
        """Return the plane voter of views."""
        chosen = list(voters)
        return cls(
            along_y=_joined([voter.pulled_back(1) for voter in chosen if voter.axis == 1]),
            along_z=_joined([_along_z(voter) for voter in chosen if voter.axis != 1]),
            dtype=np.dtype(np.uint8 if len(chosen) <= MOST_BYTE_VIEWS else np.uint16),
        )

    def votes(self, window: Window) -> Votes:
        """Return the votes (nx, ny, nz) of a window's voxels."""
        votes = np.empty(window.shape, dtype=self.dtype)
        parts = (self.along_y, self.along_z)
        vote_planes(
            votes,
            window.low,
            *[
                (part.place, part.crossing, part.flips, part.offsets, self._weights(part))
                for part in parts
            ],
        )
        return votes

    def _weights(self, part: PulledBack) -> NDArray[Any]:
        return part.weights.astype(self.dtype)


def _along_z(voter: Voter) -> PulledBack:
    outline = voter.outline
    weights = np.ones(len(outline.offsets) - 1, dtype=np.int64)
    exchanged = voter.to_image[:, EXCHANGED]
    return pulled_back(outline.points, outline.offsets, weights, exchanged, 1)


def _joined(parts: list[PulledBack]) -> PulledBack:
    """Return outlines as one, where there are none an empty one."""
    nothing = PulledBack(
        place=np.empty((2, 0)),
        crossing=np.empty((3, 0)),
        flips=np.empty(0, dtype=np.uint8),
        offsets=np.zeros(1, dtype=np.int64),
        weights=np.empty(0, dtype=np.int64),
    )
    return joined(parts or [nothing])


Outlines = tuple[Floats, Floats, NDArray[np.uint8], NDArray[np.int64], NDArray[Any]]


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def vote_planes(
    votes: NDArray[Any], low: NDArray[np.int64], along_y: Outlines, along_z: Outlines
) -> None:  # pragma: no cover - compiled
    """Write the votes of all views on a window.

    Args:
        votes: (nx, ny, nz) of an unsigned type, overwritten.
        low: (3,) index of its first voxel in the grid.
        along_y: place, crossing, flips, offsets and weights as in `PulledBack`, the weights of the
            votes' type; lines along y.
        along_z: the same for lines along z.
    """
    rows, places = votes.shape[1], votes.shape[2]
    # One more along the lines takes what lies past the last voxel.
    marks_y = np.zeros((rows + 1) * places, dtype=votes.dtype)
    marks_z = np.zeros(rows * (places + 1), dtype=votes.dtype)
    running = np.empty(places, dtype=votes.dtype)
    change = np.empty(max(along_y[0].shape[1], along_z[0].shape[1]), dtype=np.int32)
    _vote_planes(votes, low, along_y, along_z, marks_y, marks_z, running, change)


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _vote_planes(
    votes: NDArray[Any],
    low: NDArray[np.int64],
    along_y: Outlines,
    along_z: Outlines,
    marks_y: NDArray[Any],
    marks_z: NDArray[Any],
    running: NDArray[Any],
    change: NDArray[np.int32],
) -> None:  # pragma: no cover - compiled
    """Vote plane by plane; what comes after the outlines is room to work in."""
    planes, rows, places = votes.shape
    for x in range(planes):
        plane = low[0] + x
        _mark(marks_y, along_y, plane, low[1], rows, places, low[2], places, 1, change)
        _mark(marks_z, along_z, plane, low[2], places, 1, low[1], rows, places + 1, change)
        running[:] = 0
        for y in range(rows):
            _sum_down(votes[x, y], running, marks_y[y * places : (y + 1) * places])
            if len(along_z[4]) > 0:
                _sum_along(votes[x, y], marks_z[y * (places + 1) : (y + 1) * (places + 1)])
        marks_y[rows * places :] = 0


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _sum_down(
    votes: NDArray[Any], running: NDArray[Any], marks: NDArray[Any]
) -> None:  # pragma: no cover - compiled
    """Write one row of the running sums along y."""
    for z in range(len(running)):
        total = running[z] + marks[z]
        running[z] = total
        votes[z] = total
        marks[z] = 0


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _sum_along(votes: NDArray[Any], marks: NDArray[Any]) -> None:  # pragma: no cover - compiled
    """Add one row's running sum along z."""
    total = 0
    for z in range(len(votes)):
        total += marks[z]
        votes[z] += total
    marks[:] = 0


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _mark(
    marks: NDArray[Any],
    outlines: Outlines,
    plane: int,
    first_row: int,
    rows: int,
    row_step: int,
    first_place: int,
    places: int,
    place_step: int,
    change: NDArray[np.int32],
) -> None:  # pragma: no cover - compiled
    """Mark every edge's crossings in one plane, each a row past its own, within the window."""
    place, crossing, flips, offsets, weights = outlines
    _change_places(place[0], place[1], plane, first_place, places, change)
    end = np.int32(first_place + places)
    for line in range(len(weights)):
        enter = weights[line]
        leave = enter - enter - enter
        for i in range(offsets[line], offsets[line + 1] - 1):
            a, b = change[i], change[i + 1]
            mixed = flips[i] != flips[i + 1]
            if a == b and not mixed:
                continue
            base, slope = crossing[0, i] + crossing[1, i] * plane + 1.0, crossing[2, i]
            first, last = min(a, b), max(a, b)
            step = enter if (a > b) != (flips[i] == 1) else leave
            if mixed:
                # A point at infinity lies between the two: lines cross at both ends of the plane.
                step = enter if flips[i + 1] == 1 else leave
                opposite = leave if flips[i + 1] == 1 else enter
                _mark_run(
                    marks,
                    first_row,
                    rows,
                    row_step,
                    first_place,
                    place_step,
                    base,
                    slope,
                    last,
                    end,
                    opposite,
                )
                first, last = np.int32(first_place), first
            _mark_run(
                marks,
                first_row,
                rows,
                row_step,
                first_place,
                place_step,
                base,
                slope,
                first,
                last,
                step,
            )


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _change_places(
    base: Floats,
    shift: Floats,
    plane: int,
    first_place: int,
    places: int,
    change: NDArray[np.int32],
) -> None:  # pragma: no cover - compiled
    """Write the first place past each point's own, the window's first or end where beyond it."""
    least, most = first_place - 1.0, first_place + places - 0.5
    for i in range(len(base)):
        change[i] = np.int32(min(max(base[i] + shift[i] * plane, least), most) + 1.0)


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _mark_run(
    marks: NDArray[Any],
    first_row: int,
    rows: int,
    row_step: int,
    first_place: int,
    place_step: int,
    base: float,
    slope: float,
    first: int,
    last: int,
    step: int,
) -> None:  # pragma: no cover - compiled
    """Mark one edge's crossings with the lines first … last − 1."""
    least, most = float(first_row), float(first_row + rows)
    if min(base + slope * first, base + slope * (last - 1)) >= most:
        return
    for at in range(first, last):
        row = np.int64(min(max(base + slope * at, least), most)) - first_row
        # Unsigned, or each index would be tested for counting from the end.
        marks[np.uint64(row * row_step + (at - first_place) * place_step)] += step
