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
    rows, words = votes.shape[1] + 2, (votes.shape[2] + 2 + 7) // 8
    near = np.zeros((rows, 8 * words), dtype=np.uint8)
    far = np.zeros((rows, 8 * words), dtype=np.uint8)
    index = np.zeros((5, rows, 8 * words), dtype=np.int32)
    flags = np.zeros(8 * words, dtype=np.uint8)
    near_used, far_used = np.zeros(rows, dtype=np.bool_), np.zeros(rows, dtype=np.bool_)
    crossed, faces = np.empty((1024, 4), dtype=np.int32), np.empty((2048, 3), dtype=np.int32)
    _fill_plane(votes, threshold, first, near, near_used)
    count, own, face_count = 0, 0, 0
    crossed = _with_room(crossed, 0, 5 * near.size)
    count = _number_plane(near, near_used, first, index[1], index[3], flags, crossed, count)
    for x in range(first, last):
        turn = (x - first) & 1
        _fill_plane(votes, threshold, x + 1, far, far_used)
        either = near_used | far_used
        crossed = _with_room(crossed, count, count + 3 * near.size)
        near_start, own = (
            own,
            _number_between(near, far, either, x, index[0], flags, crossed, count),
        )
        count = _number_plane(
            far, far_used, x + 1, index[2 - turn], index[4 - turn], flags, crossed, own
        )
        # An edge has at most four cubes around it, and a cube fewer triangles than crossed edges.
        faces = _with_room(faces, face_count, face_count + 4 * (count - near_start))
        face_count = _join(
            near, far, either, index, flags, triangle_table, edge_tables[turn], faces, face_count
        )
        near, far = far, near
        near_used, far_used = far_used, near_used
    return crossed[:own].copy(), faces[:face_count].copy()


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _fill_plane(
    votes: NDArray[Any], threshold: int, x: int, plane: NDArray[np.uint8], used: NDArray[np.bool_]
) -> None:  # pragma: no cover - compiled
    """Write a plane's voxels, 1 inside and 0 outside, with a rim of outside, and its used rows."""
    if x < 0 or x >= votes.shape[0]:
        plane[:] = 0
        used[:] = False
        return
    limit = votes.dtype.type(threshold)
    for y in range(votes.shape[1]):
        used[y + 1] = _fill_row(votes[x, y], limit, plane[y + 1, 1:])


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
def _number_plane(
    plane: NDArray[np.uint8],
    used: NDArray[np.bool_],
    x: int,
    along_y: NDArray[np.int32],
    along_z: NDArray[np.int32],
    flags: NDArray[np.uint8],
    crossed: NDArray[np.int32],
    count: int,
) -> int:  # pragma: no cover - compiled
    """Number the crossed edges within a plane, and return how many there are by now."""
    width = plane.shape[1]
    words = flags.view(np.uint64)
    for y in range(plane.shape[0] - 1):
        if not (used[y] or used[y + 1]):
            continue
        row, above = plane[y], plane[y + 1]
        for z in range(width - 1):
            flags[z] = (row[z] ^ above[z]) | (row[z] ^ row[z + 1]) << 1
        for word in range(len(words)):
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
def _number_between(
    near: NDArray[np.uint8],
    far: NDArray[np.uint8],
    used: NDArray[np.bool_],
    x: int,
    along_x: NDArray[np.int32],
    flags: NDArray[np.uint8],
    crossed: NDArray[np.int32],
    count: int,
) -> int:  # pragma: no cover - compiled
    """Number the crossed edges between two planes, and return how many there are by now."""
    width = near.shape[1]
    words = flags.view(np.uint64)
    for y in range(near.shape[0]):
        if not used[y]:
            continue
        one, other = near[y], far[y]
        for z in range(width):
            flags[z] = one[z] ^ other[z]
        for word in range(len(words)):
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
def _join(
    near: NDArray[np.uint8],
    far: NDArray[np.uint8],
    used: NDArray[np.bool_],
    index: NDArray[np.int32],
    flags: NDArray[np.uint8],
    triangle_table: NDArray[np.int8],
    edge_table: NDArray[np.int8],
    faces: NDArray[np.int32],
    count: int,
) -> int:  # pragma: no cover - compiled
    """Add the triangles of one layer of cubes, and return how many there are by now."""
    width = near.shape[1]
    for y in range(near.shape[0] - 1):
        if not (used[y] or used[y + 1]):
            continue
        a, b, c, d = near[y], near[y + 1], far[y], far[y + 1]
        for z in range(width):
            flags[z] = a[z] | b[z] << 1 | c[z] << 2 | d[z] << 3
        for z in range(width - 1):
            case = flags[z] | flags[z + 1] << 4
            if not 0 < case < 255:
                continue
            for corner in range(3 * triangle_table[case, 0]):
                edge = edge_table[triangle_table[case, 1 + corner]]
                number = index[edge[0], y + edge[1], z + edge[2]]
                faces[count + corner // 3, corner % 3] = number
            count += triangle_table[case, 0]
    flags[:] = 0
    return count
