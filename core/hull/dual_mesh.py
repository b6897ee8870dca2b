"""Compiled dual contouring of a slab: a vertex for each sheet in a cube, a quad at each grid edge.

The crossed edges of all slabs come in the order in which `mesh_slab` numbers them: those within
plane x, then those between the planes x and x + 1. Layer x of cubes meets three such groups in a
row, and no other one.
"""

from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.hull.threads import Compiled, InnerLoop

SUMS = 13
"""Of a sheet's crossings: their number, the three sums of their places relative to the cube, the
six of the products of their normals, and the three of their normals times their distances."""


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def sheet_vertices(
    crossed: NDArray[np.int32],
    places: Floats,
    normals: Floats,
    groups: NDArray[np.int64],
    votes: NDArray[Any],
    threshold: int,
    first: int,
    last: int,
    sheets: NDArray[np.int8],
    twice_passed: NDArray[np.int8],
    regularisation: float,
    around: NDArray[np.int32],
) -> Floats:  # pragma: no cover - compiled
    """Return a vertex (vertices, 3) in voxel indices for each sheet in layers first … last − 1.

    Args:
        crossed: (edges, 4) of the whole surface, as `mesh_slab` returns them.
        places: (edges, 3) where they are crossed, in voxel indices.
        normals: (edges, 3) unit normals of the hull's boundary there, of either sign.
        groups: (2 planes + 4,) where each group of edges starts: those within plane x at
            2 (x + 1), those past it at 2 (x + 1) + 1.
        votes: (nx, ny, nz).
        threshold: votes from which a voxel is inside.
        first: layer to begin with.
        last: layer before which to stop.
        sheets: `sheet_table`.
        twice_passed: `twice_passed_table`.
        regularisation: how much a vertex is drawn to the mean of its crossings.
        around: (edges, 4) the number, in this slab, of the sheet in each cube around an edge;
            written for the cubes of these layers.
    """
    shape = (votes.shape[1] + 1, votes.shape[2] + 1)
    most = 0
    for x in range(first, last):
        most = max(most, groups[2 * x + 5] - groups[2 * x + 2])
    # A loop has three edges at least and an edge four cubes.
    room = 4 * most // 3 + 4
    all_edges = groups[2 * last + 3] - groups[2 * first + 2]
    vertices = np.empty((4 * all_edges // 3 + 4, 3))
    count = _layers(
        crossed,
        places,
        normals,
        groups,
        votes,
        threshold,
        first,
        last,
        sheets,
        twice_passed,
        regularisation,
        around,
        np.full(shape, -1, dtype=np.int32),
        np.zeros(shape, dtype=np.int16),
        np.zeros((room, SUMS)),
        np.zeros((room, 3), dtype=np.int32),
        vertices,
    )
    return vertices[:count].copy()


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _layers(
    crossed: NDArray[np.int32],
    places: Floats,
    normals: Floats,
    groups: NDArray[np.int64],
    votes: NDArray[Any],
    threshold: int,
    first: int,
    last: int,
    sheets: NDArray[np.int8],
    twice_passed: NDArray[np.int8],
    regularisation: float,
    around: NDArray[np.int32],
    starts: NDArray[np.int32],
    cases: NDArray[np.int16],
    sums: Floats,
    cubes: NDArray[np.int32],
    vertices: Floats,
) -> int:  # pragma: no cover - compiled
    """Write vertices and return how many; `starts` to `cubes` are room to work in.

    `starts` holds the first vertex of each cube of a layer; older numbers are other layers'.
    """
    count = 0
    for x in range(first, last):
        before = count
        for group in range(3):
            for i in range(groups[2 * x + 2 + group], groups[2 * x + 3 + group]):
                axis = crossed[i, 3] & 3
                for rank in range(4):
                    dx, dy, dz = _step(axis, rank)
                    # Of an edge within a plane two cubes are in this layer, two in another one.
                    if dx != group >> 1:
                        continue
                    y, z = crossed[i, 1] - dy, crossed[i, 2] - dz
                    if starts[y + 1, z + 1] < before:
                        case = _sheet_case(votes, threshold, x, y, z, twice_passed)
                        cases[y + 1, z + 1], starts[y + 1, z + 1] = case, count
                        for row in range(count - before, count - before + sheets[case, 12]):
                            sums[row] = 0
                            cubes[row, 0], cubes[row, 1], cubes[row, 2] = x, y, z
                        count += sheets[case, 12]
                    sheet = sheets[cases[y + 1, z + 1], 4 * axis + rank]
                    around[i, rank] = starts[y + 1, z + 1] + sheet
                    _add(sums[around[i, rank] - before], places[i], normals[i], x, y, z)
        for number in range(before, count):
            row = number - before
            _solve(sums[row], cubes[row], votes.shape, regularisation, vertices[number])
    return count


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _case(
    votes: NDArray[Any], threshold: int, x: int, y: int, z: int
) -> int:  # pragma: no cover - compiled
    """Return which corners of a cube are inside, as `cube_cases` numbers them."""
    case = 0
    for corner in range(8):
        i, j, k = x + (corner >> 1 & 1), y + (corner & 1), z + (corner >> 2)
        if 0 <= i < votes.shape[0] and 0 <= j < votes.shape[1] and 0 <= k < votes.shape[2]:
            case |= (votes[i, j, k] >= threshold) << corner
    return case


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _sheet_case(
    votes: NDArray[Any],
    threshold: int,
    x: int,
    y: int,
    z: int,
    twice_passed: NDArray[np.int8],
) -> Any:  # pragma: no cover - compiled
    """Return the row of the sheet table: the other one if both cubes pass their face twice."""
    case = _case(votes, threshold, x, y, z)
    face = twice_passed[case]
    if face < 0:
        return case
    axis, step = face >> 1, 2 * (face & 1) - 1
    across = _case(
        votes, threshold, x + step * (axis == 0), y + step * (axis == 1), z + step * (axis == 2)
    )
    return case + 256 * (twice_passed[across] == face ^ 1)


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _step(axis: int, rank: int) -> tuple[int, int, int]:  # pragma: no cover - compiled
    """Return where a grid edge lies in the cube in which it is the axis' edge of this rank."""
    if axis == 0:
        return 0, rank & 1, rank >> 1
    if axis == 1:
        return rank & 1, 0, rank >> 1
    return rank >> 1, rank & 1, 0


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _add(
    sums: Floats, place: Floats, normal: Floats, x: int, y: int, z: int
) -> None:  # pragma: no cover - compiled
    px, py, pz = place[0] - x, place[1] - y, place[2] - z
    a, b, c = normal[0], normal[1], normal[2]
    distance = a * px + b * py + c * pz
    sums[0] += 1
    sums[1] += px
    sums[2] += py
    sums[3] += pz
    sums[4] += a * a
    sums[5] += a * b
    sums[6] += a * c
    sums[7] += b * b
    sums[8] += b * c
    sums[9] += c * c
    sums[10] += a * distance
    sums[11] += b * distance
    sums[12] += c * distance


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _solve(
    sums: Floats,
    cube: NDArray[np.int32],
    shape: tuple[int, int, int],
    regularisation: float,
    vertex: Floats,
) -> None:  # pragma: no cover - compiled
    """Write where Σ (n · (v − p))² + λ |v − m|² is least, by the adjugate.

    The products of normals with a whole λ on their diagonal never are near singular. The vertex
    stays in its cube, and no more than half a voxel past the grid's end.
    """
    r = regularisation
    xx, yy, zz = sums[4] + r, sums[7] + r, sums[9] + r
    xy, xz, yz = sums[5], sums[6], sums[8]
    axx, ayy, azz = yy * zz - yz * yz, xx * zz - xz * xz, xx * yy - xy * xy
    axy, axz, ayz = xz * yz - xy * zz, xy * yz - xz * yy, xy * xz - xx * yz
    scale = 1 / (xx * axx + xy * axy + xz * axz)
    mx, my, mz = sums[1] / sums[0], sums[2] / sums[0], sums[3] / sums[0]
    bx, by, bz = sums[10] + r * mx, sums[11] + r * my, sums[12] + r * mz
    vertex[0] = cube[0] + (axx * bx + axy * by + axz * bz) * scale
    vertex[1] = cube[1] + (axy * bx + ayy * by + ayz * bz) * scale
    vertex[2] = cube[2] + (axz * bx + ayz * by + azz * bz) * scale
    for axis in range(3):
        vertex[axis] = max(vertex[axis], cube[axis], -0.5)
        vertex[axis] = min(vertex[axis], cube[axis] + 1, shape[axis] - 0.5)


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def swept_normals(
    crossed: NDArray[np.int32],
    causes: NDArray[np.int32],
    to_image: Floats,
    points: Floats,
    normals: Floats,
) -> None:  # pragma: no cover - compiled
    """Write the unit normal (edges, 3) of the plane that each causing outline edge sweeps.

    The image line through the edge, applied to the map to the image, is that plane: for an affine
    view it lies along the viewing direction, for a perspective one it passes the camera. At the
    grid's end it is the end's own.
    """
    for i in range(len(crossed)):
        view, at = causes[i, 0], causes[i, 1]
        if view < 0:
            for axis in range(3):
                normals[i, axis] = axis == (crossed[i, 3] & 3)
            continue
        a, b = points[at, 1] - points[at + 1, 1], points[at + 1, 0] - points[at, 0]
        c = -(a * points[at, 0] + b * points[at, 1])
        square = 0.0
        for axis in range(3):
            along = a * to_image[view, 0, axis] + b * to_image[view, 1, axis]
            normals[i, axis] = along + c * to_image[view, 2, axis]
            square += normals[i, axis] ** 2
        for axis in range(3):
            normals[i, axis] /= np.sqrt(square)


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def joined_faces(
    crossed: NDArray[np.int32],
    places: Floats,
    around: NDArray[np.int32],
    bases: NDArray[np.int64],
    vertices: Floats,
    first: int,
    last: int,
    faces: NDArray[np.int32],
) -> None:  # pragma: no cover - compiled
    """Write two triangles (2 edges, 3) for the four sheets around each of some crossed edges.

    A quad is cut along the diagonal that passes nearer the crossing, which lies on the hull.

    Args:
        crossed: (edges, 4) of the whole surface.
        places: (edges, 3) where they are crossed, in voxel indices.
        around: as `sheet_vertices` writes it, numbers within a slab.
        bases: (layers + 1,) the first vertex of the slab of layer x at x + 1.
        vertices: (vertices, 3) of the whole surface, in voxel indices.
        first: edge to begin with.
        last: edge before which to stop.
        faces: (2 edges, 3) counter-clockwise from outside.
    """
    quad = np.empty(4, dtype=np.int64)
    for i in range(first, last):
        axis, lower_inside = crossed[i, 3] & 3, crossed[i, 3] >> 2
        for turn in range(4):
            # Counter-clockwise from the upper end: the other two axes' lower and upper cubes.
            at = turn if lower_inside else 3 - turn
            rank = (3, 2, 0, 1)[at] if axis == 0 else (3, 1, 0, 2)[at]
            quad[turn] = bases[crossed[i, 0] - _step(axis, rank)[0] + 1] + around[i, rank]
        one = _from_segment(places[i], vertices[quad[0]], vertices[quad[2]])
        other = _from_segment(places[i], vertices[quad[1]], vertices[quad[3]])
        shift = 0 if one <= other else 1
        a, b, c, d = quad[shift], quad[1 + shift], quad[2 + shift], quad[(3 + shift) & 3]
        faces[2 * i, 0], faces[2 * i, 1], faces[2 * i, 2] = a, b, c
        faces[2 * i + 1, 0], faces[2 * i + 1, 1], faces[2 * i + 1, 2] = a, c, d


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _from_segment(
    place: Floats, tail: Floats, head: Floats
) -> float:  # pragma: no cover - compiled
    """Return the squared distance of a place from the segment from tail to head."""
    along, square = 0.0, 0.0
    for axis in range(3):
        step = head[axis] - tail[axis]
        along += (place[axis] - tail[axis]) * step
        square += step * step
    part = min(max(along / square, 0.0), 1.0) if square > 0 else 0.0
    distance = 0.0
    for axis in range(3):
        off = tail[axis] + part * (head[axis] - tail[axis]) - place[axis]
        distance += off * off
    return distance
