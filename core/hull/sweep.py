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

PLANES_AT_ONCE = 8


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
    # Along x one line's rows lie far apart in memory; neighbouring planes' rows lie together.
    depth = 1 if axis == 1 else PLANES_AT_ONCE
    # One row more takes what lies past the last voxel, so that marking needs no test.
    difference = np.zeros((depth, (lines + 1) * places), dtype=volume.dtype)
    running = np.empty((depth, places), dtype=volume.dtype)
    change = np.empty(place.shape[1], dtype=np.int32)
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
        running,
        change,
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
) -> None:  # pragma: no cover - compiled
    """Sweep as many planes at once as `difference` and `running` have room for."""
    lines, places, depth = volume.shape[axis], volume.shape[2], len(running)
    for start in range(first, last, depth):
        planes = min(depth, last - start)
        low, high = lines, 0
        for i in range(planes):
            _change_places(place[0], place[1], start + i, places, change)
            rows = _mark(
                difference[i], lines, places, start + i, crossing, change, flips, offsets, weights
            )
            low, high = min(low, rows[0]), max(high, rows[1])
        running[:] = 0
        for row in range(low, min(high + 1, lines)):
            for i in range(planes):
                x, y = (start + i, row) if axis == 1 else (row, start + i)
                marks = difference[i, row * places : (row + 1) * places]
                if limit == 0:
                    _add_row(volume[x, y], running[i], marks)
                elif _add_row_watching(volume[x, y], running[i], marks, limit):
                    flipped[x] = True
        difference[:, lines * places :] = 0


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _add_row(
    target: NDArray[Any], running: NDArray[Any], difference: NDArray[Any]
) -> None:  # pragma: no cover - compiled
    for place in range(len(running)):
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
    for place in range(len(running)):
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
    plane: int,
    crossing: Floats,
    change: NDArray[np.int32],
    flips: NDArray[np.uint8],
    offsets: NDArray[np.int64],
    weights: NDArray[Any],
) -> tuple[int, int]:  # pragma: no cover - compiled
    """Mark every edge's crossings in one plane; return the first and last row that have any."""
    low, high = float(rows), -1.0
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
                _mark_run(difference, rows, places, base, slope, last, np.int32(places), opposite)
                first, last = np.int32(0), first
                low, high = 0.0, float(rows)
            _mark_run(difference, rows, places, base, slope, first, last, step)
            one, two = base + slope * first, base + slope * (last - 1)
            low, high = min(low, one, two), max(high, one, two)
    return int(max(low, 0.0)), int(min(high, float(rows)))


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
