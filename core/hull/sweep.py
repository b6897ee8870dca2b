"""The sweep: votes of all views from the crossings of their edges with the grid's lines.

Every edge adds its weight to a difference plane at the first voxel past its crossing with each
line; one running sum down the plane, whole rows at a time, gives the votes of all views.
"""

from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.hull.threads import Compiled, InnerLoop

PLANES_AT_ONCE = (8, 4)
"""Planes swept together, by the lines' axis. An edge's constants are then loaded once for all of
them; and along x, where one line's rows lie far apart in memory, neighbouring planes' rows lie
together."""


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def sweep_planes(
    volume: NDArray[Any],
    axis: int,
    first: int,
    last: int,
    place: Floats,
    crossing: Floats,
    flips: NDArray[np.uint8],
    offsets: NDArray[np.int64],
    weights: NDArray[Any],
    limit: int,
    flipped: NDArray[np.bool_],
) -> None:  # pragma: no cover - compiled
    """Add the polylines' votes to the planes first … last − 1 of `volume` (nx, ny, nz).

    Args:
        volume: votes, unsigned; what wraps on the way is whole again at the end of each line.
        axis: of the lines, 1 or 0; planes count along the other one.
        first: plane to begin with.
        last: plane before which to stop.
        place: as in `PulledBack`, like all that follow.
        crossing: see there.
        flips: see there.
        offsets: see there.
        weights: see there, of the volume's type.
        limit: votes of the volume's type at which a voxel enters or leaves the hull; 0 for none.
        flipped: (nx,) set where a voxel did.
    """
    lines, places = volume.shape[axis], volume.shape[2]
    depth = min(PLANES_AT_ONCE[axis], last - first)
    longest = 0
    for line in range(len(weights)):
        longest = max(longest, offsets[line + 1] - offsets[line])
    # One row more takes what lies past the last voxel, so that marking needs no test.
    difference = np.zeros((depth, (lines + 1) * places), dtype=volume.dtype)
    _sweep_planes(
        volume,
        axis,
        first,
        last,
        place,
        crossing,
        flips,
        offsets,
        weights,
        limit,
        flipped,
        difference,
        np.empty((depth, places), dtype=volume.dtype),
        np.empty((depth, longest), dtype=np.int32),
        np.empty(4),
    )


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _sweep_planes(
    volume: NDArray[Any],
    axis: int,
    first: int,
    last: int,
    place: Floats,
    crossing: Floats,
    flips: NDArray[np.uint8],
    offsets: NDArray[np.int64],
    weights: NDArray[Any],
    limit: int,
    flipped: NDArray[np.bool_],
    difference: NDArray[Any],
    running: NDArray[Any],
    change: NDArray[np.int32],
    window: Floats,
) -> None:  # pragma: no cover - compiled
    """Sweep as many planes at once as `difference` and `running` have room for."""
    lines, places, depth = volume.shape[axis], volume.shape[2], len(running)
    for start in range(first, last, depth):
        planes = min(depth, last - start)
        # Between which rows and places any mark can lie.
        window[0], window[1], window[2], window[3] = lines, -1.0, places, -1.0
        for line in range(len(weights)):
            a, b = offsets[line], offsets[line + 1]
            for i in range(planes):
                _change_places(place[0, a:b], place[1, a:b], start + i, places, change[i])
            _mark(
                difference,
                lines,
                places,
                start,
                planes,
                crossing[:, a:b],
                change,
                flips[a:b],
                weights[line],
            )
            _widen(
                window,
                lines,
                places,
                start,
                start + planes - 1,
                place[:, a:b],
                crossing[:, a:b],
                flips[a:b],
            )
        # A row of margin on both sides is more than rounding can move a mark.
        low, high = int(max(window[0] - 1.0, 0.0)), int(min(window[1] + 2.0, lines - 1.0)) + 1
        left, right = int(max(window[2], 0.0)), int(min(window[3] + 1.0, float(places)))
        running[:] = 0
        for row in range(low, high):
            for i in range(planes):
                x, y = (start + i, row) if axis == 1 else (row, start + i)
                marks = difference[i, row * places + left : row * places + right]
                if limit == 0:
                    _add_row(volume[x, y, left:right], running[i], marks)
                elif _add_row_watching(volume[x, y, left:right], running[i], marks, limit):
                    flipped[x] = True
        difference[:, lines * places :] = 0


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _add_row(
    target: NDArray[Any], running: NDArray[Any], difference: NDArray[Any]
) -> None:  # pragma: no cover - compiled
    for place in range(len(target)):
        total = running[place] + difference[place]
        running[place] = total
        target[place] += total
        difference[place] = 0


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _add_row_watching(
    target: NDArray[Any], running: NDArray[Any], difference: NDArray[Any], limit: int
) -> bool:  # pragma: no cover - compiled
    """Add like `_add_row` and return whether a voxel's votes passed the limit, either way."""
    some = False
    for place in range(len(target)):
        before = target[place] >= limit
        total = running[place] + difference[place]
        running[place] = total
        target[place] += total
        difference[place] = 0
        some |= before != (target[place] >= limit)
    return some


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _change_places(
    base: Floats, shift: Floats, plane: int, places: int, change: NDArray[np.int32]
) -> None:  # pragma: no cover - compiled
    """Write the first place past each point's own; only this form is turned into vectors."""
    for i in range(len(base)):
        at = min(max(base[i] + shift[i] * plane, -1.0), places - 0.5)
        change[i] = np.int32(at + 1.0)


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _mark(
    difference: NDArray[Any],
    rows: int,
    places: int,
    start: int,
    planes: int,
    crossing: Floats,
    change: NDArray[np.int32],
    flips: NDArray[np.uint8],
    enter: Any,
) -> None:  # pragma: no cover - compiled
    """Mark the crossings of one polyline's edges in some planes."""
    leave, top = enter - enter - enter, float(rows)
    for i in range(crossing.shape[1] - 1):
        shift, slope, turned = crossing[1, i], crossing[2, i], flips[i] == 1
        if flips[i] != flips[i + 1]:
            one, other = (leave, enter) if turned else (enter, leave)
            _mark_outside(difference, rows, places, start, planes, crossing, change, i, one, other)
            continue
        for plane in range(planes):
            a, b = change[plane, i], change[plane, i + 1]
            if a != b:
                base = crossing[0, i] + shift * (start + plane) + 1.0
                step = enter if (a > b) != turned else leave
                marks = difference[plane]
                for at in range(min(a, b), max(a, b)):
                    row = np.int32(min(max(base + slope * at, 0.0), top))
                    marks[np.uint32(row) * np.uint32(places) + np.uint32(at)] += step


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _mark_outside(
    difference: NDArray[Any],
    rows: int,
    places: int,
    start: int,
    planes: int,
    crossing: Floats,
    change: NDArray[np.int32],
    i: int,
    step: Any,
    opposite: Any,
) -> None:  # pragma: no cover - compiled
    """Mark edge i where a point at infinity lies on it: lines cross at both ends of the plane."""
    for plane in range(planes):
        a, b = change[plane, i], change[plane, i + 1]
        base = crossing[0, i] + crossing[1, i] * (start + plane) + 1.0
        ends = (np.int32(0), min(a, b), step), (max(a, b), np.int32(places), opposite)
        for first, last, way in ends:
            _mark_run(difference[plane], rows, places, base, crossing[2, i], first, last, way)


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _widen(
    window: Floats,
    rows: int,
    places: int,
    first: int,
    last: int,
    place: Floats,
    crossing: Floats,
    flips: NDArray[np.uint8],
) -> None:  # pragma: no cover - compiled
    """Widen the window by all that one polyline can mark in the planes first … last.

    What an edge marks lies between its two vertices, whose rows and places move evenly from plane
    to plane: the outer planes tell.
    """
    low, high, left, right = window[0], window[1], window[2], window[3]
    edges = crossing.shape[1] - 1
    for vertex in range(edges + 1):
        i = min(vertex, edges - 1)
        if flips[i] != flips[i + 1]:
            low, high, left, right = 0.0, float(rows), -1.0, float(places)
        for plane in (first, last):
            at = place[0, vertex] + place[1, vertex] * plane
            row = crossing[0, i] + crossing[1, i] * plane + crossing[2, i] * at
            low, high = min(low, row), max(high, row)
            left, right = min(left, at), max(right, at)
    window[0], window[1], window[2], window[3] = low, high, left, right


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _mark_run(
    difference: NDArray[Any],
    rows: int,
    places: int,
    base: float,
    slope: float,
    first: int,
    last: int,
    step: int,
) -> None:  # pragma: no cover - compiled
    """Mark one edge's crossings, each a row past its own, with the lines first … last − 1."""
    for at in range(first, last):
        row = np.int32(min(max(base + slope * at, 0.0), float(rows)))
        # Unsigned, or each index would be tested for counting from the end.
        difference[np.uint32(row) * np.uint32(places) + np.uint32(at)] += step
