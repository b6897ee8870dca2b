"""Compiled meshing of a slab of planes: which grid edges the surface crosses, and its triangles.

A slab's vertices are numbered plane by plane, those of its first plane first. The triangles of its
last layer use the first vertices of the slab after it, whose numbers simply continue; so slabs can
be meshed each alone and laid after one another.
"""

from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

from core.hull.threads import Compiled, InnerLoop


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def mesh_slab(
    votes: NDArray[Any],
    threshold: int,
    first: int,
    last: int,
    triangle_table: NDArray[np.int8],
    edge_tables: NDArray[np.int8],
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:  # pragma: no cover - compiled
    """Return the crossed grid edges and the triangles of the layers first … last − 1.

    Layer x lies between the planes x and x + 1; layers run from −1 to nx − 1, for outside the grid
    nothing is inside.

    Args:
        votes: (nx, ny, nz).
        threshold: votes from which a voxel is inside.
        first: layer to begin with.
        last: layer before which to stop.
        triangle_table: of `cube_cases`.
        edge_tables: of `cube_cases`.

    Returns:
        crossed: (edges, 4) lower end's x, y, z and the axis, plus 4 if the lower end is inside.
        faces: (faces, 3) numbers of crossed edges, counter-clockwise from outside.
    """
    # Rows are read and flagged in words of eight, and one voxel past the last of them.
    rows, width = votes.shape[1] + 2, 8 * ((votes.shape[2] + 2 + 7) // 8 + 1)
    near, far = np.zeros((rows, width), dtype=np.uint8), np.zeros((rows, width), dtype=np.uint8)
    near_spans, far_spans = np.empty((rows, 2), dtype=np.int32), np.empty((rows, 2), dtype=np.int32)
    # Read only where it was written: at crossed edges.
    index = np.empty((5, rows, width), dtype=np.int32)
    flags = np.zeros((2, width), dtype=np.uint8)
    crossed, faces = np.empty((1024, 4), dtype=np.int32), np.empty((2048, 3), dtype=np.int32)
    _fill_plane(votes, threshold, first, near, near_spans)
    count, own, face_count = 0, 0, 0
    crossed = _with_room(crossed, 0, 5 * near.size)
    count = _number_plane(near, near_spans, first, index[1], index[3], flags[0], crossed, count)
    for x in range(first, last):
        turn = (x - first) & 1
        _fill_plane(votes, threshold, x + 1, far, far_spans)
        _widen(near_spans, far_spans)
        crossed = _with_room(crossed, count, count + 3 * near.size)
        near_start, own = (
            own,
            _number_between(near, far, near_spans, x, index[0], flags[0], crossed, count),
        )
        count = _number_plane(
            far, far_spans, x + 1, index[2 - turn], index[4 - turn], flags[0], crossed, own
        )
        # An edge has at most four cubes around it, and a cube fewer triangles than crossed edges.
        faces = _with_room(faces, face_count, face_count + 4 * (count - near_start))
        face_count = _join(
            near,
            far,
            near_spans,
            index,
            flags,
            triangle_table,
            edge_tables[turn],
            faces,
            face_count,
        )
        near, far = far, near
        near_spans, far_spans = far_spans, near_spans
    return crossed[:own].copy(), faces[:face_count].copy()


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _fill_plane(
    votes: NDArray[Any],
    threshold: int,
    x: int,
    plane: NDArray[np.uint8],
    spans: NDArray[np.int32],
) -> None:  # pragma: no cover - compiled
    """Write a plane's voxels, 1 inside and 0 outside, with a rim of outside, and each row's span.

    A span is the first voxel inside and the one past the last; an empty row has (width, 0).
    """
    spans[:, 0], spans[:, 1] = plane.shape[1], 0
    if x < 0 or x >= votes.shape[0]:
        plane[:] = 0
        return
    limit = votes.dtype.type(threshold)
    for y in range(votes.shape[1]):
        row = plane[y + 1]
        if not _fill_row(votes[x, y], limit, row[1:]):
            continue
        low, high = 1, votes.shape[2]
        while row[low] == 0:
            low += 1
        while row[high] == 0:
            high -= 1
        spans[y + 1, 0], spans[y + 1, 1] = low, high + 1


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _fill_row(
    votes: NDArray[Any], limit: int, row: NDArray[np.uint8]
) -> bool:  # pragma: no cover - compiled
    some = False
    for z in range(len(votes)):
        inside = votes[z] >= limit
        row[z] = inside
        some |= inside
    return some


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _widen(
    spans: NDArray[np.int32], others: NDArray[np.int32]
) -> None:  # pragma: no cover - compiled
    """Widen each row's span by another's."""
    for y in range(len(spans)):
        spans[y, 0] = min(spans[y, 0], others[y, 0])
        spans[y, 1] = max(spans[y, 1], others[y, 1])


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _words(spans: NDArray[np.int32], y: int) -> tuple[int, int]:  # pragma: no cover - compiled
    """Return the first and past-the-last word that cross into two rows' spans; none if empty."""
    low, high = min(spans[y, 0], spans[y + 1, 0]), max(spans[y, 1], spans[y + 1, 1])
    return ((low - 1) >> 3, (high + 7) >> 3) if high > 0 else (0, 0)


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _flag_plane(
    row: NDArray[np.uint8],
    following: NDArray[np.uint8],
    above: NDArray[np.uint8],
    flags: NDArray[np.uint8],
) -> None:  # pragma: no cover - compiled
    # Only loops that count from 0 to an array's end are turned into vectors, here and below.
    for z in range(len(flags)):
        flags[z] = (row[z] ^ above[z]) | (row[z] ^ following[z]) << 1


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _number_plane(
    plane: NDArray[np.uint8],
    spans: NDArray[np.int32],
    x: int,
    along_y: NDArray[np.int32],
    along_z: NDArray[np.int32],
    flags: NDArray[np.uint8],
    crossed: NDArray[np.int32],
    count: int,
) -> int:  # pragma: no cover - compiled
    """Number the crossed edges within a plane, and return how many there are by now."""
    words = flags.view(np.uint64)
    for y in range(plane.shape[0] - 1):
        first, last = _words(spans, y)
        row, above = plane[y], plane[y + 1]
        start, end = 8 * first, 8 * last
        _flag_plane(row[start:end], row[start + 1 : end + 1], above[start:end], flags[start:end])
        for word in range(first, last):
            if words[word] == 0:
                continue
            for z in range(8 * word, 8 * word + 8):
                if flags[z] & 1:
                    along_y[y, z] = count
                    _cross(crossed, count, x, y - 1, z - 1, 1 + 4 * row[z])
                    count += 1
                if flags[z] & 2:
                    along_z[y, z] = count
                    _cross(crossed, count, x, y - 1, z - 1, 2 + 4 * row[z])
                    count += 1
    return count


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _flag_between(
    one: NDArray[np.uint8], other: NDArray[np.uint8], flags: NDArray[np.uint8]
) -> None:  # pragma: no cover - compiled
    for z in range(len(flags)):
        flags[z] = one[z] ^ other[z]


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _number_between(
    near: NDArray[np.uint8],
    far: NDArray[np.uint8],
    spans: NDArray[np.int32],
    x: int,
    along_x: NDArray[np.int32],
    flags: NDArray[np.uint8],
    crossed: NDArray[np.int32],
    count: int,
) -> int:  # pragma: no cover - compiled
    """Number the crossed edges between two planes, and return how many there are by now."""
    words = flags.view(np.uint64)
    for y in range(near.shape[0]):
        first, last = min(spans[y, 0], spans[y, 1]) >> 3, (spans[y, 1] + 7) >> 3
        one, other = near[y], far[y]
        start, end = 8 * first, 8 * last
        _flag_between(one[start:end], other[start:end], flags[start:end])
        for word in range(first, last):
            if words[word] == 0:
                continue
            for z in range(8 * word, 8 * word + 8):
                if flags[z]:
                    along_x[y, z] = count
                    _cross(crossed, count, x, y - 1, z - 1, 4 * one[z])
                    count += 1
    return count


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _cross(
    crossed: NDArray[np.int32], number: int, x: int, y: int, z: int, code: int
) -> None:  # pragma: no cover - compiled
    crossed[number, 0], crossed[number, 1] = x, y
    crossed[number, 2], crossed[number, 3] = z, code


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def _with_room(
    rows: NDArray[Any], used: int, needed: int
) -> NDArray[Any]:  # pragma: no cover - compiled
    if needed <= len(rows):
        return rows
    larger = np.empty((max(needed, 2 * len(rows)), rows.shape[1]), dtype=rows.dtype)
    larger[:used] = rows[:used]
    return larger


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _flag_sides(
    a: NDArray[np.uint8],
    b: NDArray[np.uint8],
    c: NDArray[np.uint8],
    d: NDArray[np.uint8],
    sides: NDArray[np.uint8],
) -> None:  # pragma: no cover - compiled
    for z in range(len(sides)):
        sides[z] = a[z] | b[z] << 1 | c[z] << 2 | d[z] << 3


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _flag_cases(
    sides: NDArray[np.uint8], cases: NDArray[np.uint8]
) -> None:  # pragma: no cover - compiled
    for z in range(len(cases)):
        cases[z] = sides[z] | sides[z + 1] << 4


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _join(
    near: NDArray[np.uint8],
    far: NDArray[np.uint8],
    spans: NDArray[np.int32],
    index: NDArray[np.int32],
    flags: NDArray[np.uint8],
    triangle_table: NDArray[np.int8],
    edge_table: NDArray[np.int8],
    faces: NDArray[np.int32],
    count: int,
) -> int:  # pragma: no cover - compiled
    """Add the triangles of one layer of cubes, and return how many there are by now."""
    sides, cases = flags[0], flags[1]
    words = cases.view(np.uint64)
    for y in range(near.shape[0] - 1):
        first, last = _words(spans, y)
        start, end = 8 * first, 8 * last
        _flag_sides(
            near[y, start : end + 1],
            near[y + 1, start : end + 1],
            far[y, start : end + 1],
            far[y + 1, start : end + 1],
            sides[start : end + 1],
        )
        _flag_cases(sides[start : end + 1], cases[start:end])
        for word in range(first, last):
            # Eight cubes wholly outside, or wholly inside.
            if words[word] + np.uint64(1) <= np.uint64(1):
                continue
            for z in range(8 * word, 8 * word + 8):
                case = cases[z]
                for corner in range(3 * triangle_table[case, 0]):
                    edge = edge_table[triangle_table[case, 1 + corner]]
                    number = index[edge[0], y + edge[1], z + edge[2]]
                    faces[count + corner // 3, corner % 3] = number
                count += triangle_table[case, 0]
    return count
