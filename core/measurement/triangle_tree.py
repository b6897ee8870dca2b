"""A tree of boxes over a surface's triangles, for questions asked at very many points."""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats, frozen
from core.hull.closed_mesh import Surface
from core.hull.threads import InnerLoop, chunks, in_parallel
from core.measurement.triangles import nearest_on_triangle

LEAF = 4
"""Triangles of the tree's lowest boxes."""

DEEPEST = 64

Numbers = NDArray[np.int64]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TriangleTree:
    """Boxes around ever fewer triangles; box i holds the boxes 2i + 1 and 2i + 2.

    Attributes:
        vertices_m: (vertices, 3) of the surface.
        faces: (faces, 3) sorted along a curve that fills space.
        numbers: (faces,) what each was called in the surface.
        boxes_m: (boxes, 6) lower and upper corners; empty ones are turned inside out.
    """

    vertices_m: Floats
    faces: NDArray[np.int32]
    numbers: Numbers
    boxes_m: Floats

    def nearest_m(self, points_m: Floats) -> tuple[Floats, Numbers]:
        """Return each point's nearest point on the surface, (n, 3), and its face's number, (n,)."""
        points = np.ascontiguousarray(points_m, dtype=np.float64)
        places, hits = np.empty_like(points), np.empty(len(points), dtype=np.int64)

        def work(span: tuple[int, int]) -> None:
            stack = np.empty(DEEPEST, dtype=np.int64)
            _nearest(self.vertices_m, self.faces, self.boxes_m, points, *span, stack, places, hits)

        in_parallel(work, chunks(len(points)))
        return places, self.numbers[hits]

    def windings(self, points_m: Floats) -> Numbers:
        """Return how often the surface winds around each point, (n,): 0 outside of all bodies.

        Bodies that overlap count once each.
        """
        points = np.ascontiguousarray(points_m, dtype=np.float64)
        found = np.zeros(len(points), dtype=np.int64)

        def work(span: tuple[int, int]) -> None:
            stack = np.empty(DEEPEST, dtype=np.int64)
            _wind(self.vertices_m, self.faces, self.boxes_m, points, *span, stack, found)

        in_parallel(work, chunks(len(points)))
        return found


@lru_cache(maxsize=4)
def tree_of(surface: Surface) -> TriangleTree:
    """Return the tree over a surface's triangles, kept while the surface is among the last used.

    Raises:
        ValueError: the surface is empty.

    Source: Lauterbach et al., "Fast BVH construction on GPUs", 2009: triangles in Morton order.
    """
    if surface.is_empty:
        raise ValueError("The surface is empty, so there is no distance from it.")
    order = _morton_order(surface.vertices_m[surface.faces].mean(axis=1))
    faces = frozen(surface.faces[order], np.int32, (None, 3), "Faces")
    leaves = 1 << (max(1, -(-len(faces) // LEAF)) - 1).bit_length()
    corners = surface.vertices_m[faces]
    level = np.full((leaves * LEAF, 6), np.inf)
    level[:, 3:] = -np.inf
    level[: len(faces), :3], level[: len(faces), 3:] = corners.min(axis=1), corners.max(axis=1)
    levels = [_merged(level, LEAF)]
    while len(levels[0]) > 1:
        levels.insert(0, _merged(levels[0], 2))
    boxes = np.concatenate(levels)
    boxes.flags.writeable = False
    return TriangleTree(vertices_m=surface.vertices_m, faces=faces, numbers=order, boxes_m=boxes)


def _merged(boxes: Floats, by: int) -> Floats:
    grouped = boxes.reshape(-1, by, 6)
    merged: Floats = np.concatenate(
        [grouped[:, :, :3].min(axis=1), grouped[:, :, 3:].max(axis=1)], axis=1
    )
    return merged


def _morton_order(points: Floats) -> Numbers:
    """Return the order of points along a curve that keeps neighbours together."""
    lower, size = points.min(axis=0), max(float(np.ptp(points, axis=0).max()), 1e-300)
    place = np.minimum((points - lower) / size * 1024, 1023).astype(np.int64)
    code = np.zeros(len(points), dtype=np.int64)
    for bit in range(10):
        for axis in range(3):
            code |= ((place[:, axis] >> bit) & 1) << (3 * bit + axis)
    return np.argsort(code, kind="stable")


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _box_distance(
    boxes: Floats, box: int, x: float, y: float, z: float
) -> Any:  # pragma: no cover - compiled
    """Return the squared distance of a box from a point, infinite for an empty one."""
    if boxes[box, 0] > boxes[box, 3]:
        return np.inf
    dx = max(boxes[box, 0] - x, 0.0, x - boxes[box, 3])
    dy = max(boxes[box, 1] - y, 0.0, y - boxes[box, 4])
    dz = max(boxes[box, 2] - z, 0.0, z - boxes[box, 5])
    return dx * dx + dy * dy + dz * dz


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _nearest(
    vertices: Floats,
    faces: NDArray[np.int32],
    boxes: Floats,
    points: Floats,
    first: int,
    last: int,
    stack: Numbers,
    places: Floats,
    hits: Numbers,
) -> None:  # pragma: no cover - compiled
    inner = len(boxes) // 2
    for i in range(first, last):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        best, depth = np.inf, 1
        stack[0] = 0
        while depth > 0:
            depth -= 1
            box = stack[depth]
            if _box_distance(boxes, box, x, y, z) >= best:
                continue
            if box < inner:
                left = _box_distance(boxes, 2 * box + 1, x, y, z)
                right = _box_distance(boxes, 2 * box + 2, x, y, z)
                # The nearer one comes off the stack first.
                stack[depth] = 2 * box + 2 if left <= right else 2 * box + 1
                stack[depth + 1] = 2 * box + 1 if left <= right else 2 * box + 2
                depth += 2
                continue
            start = (box - inner) * LEAF
            for face in range(start, min(start + LEAF, len(faces))):
                square, nx, ny, nz = nearest_on_triangle(
                    vertices, faces[face, 0], faces[face, 1], faces[face, 2], x, y, z
                )
                if square < best:
                    best, hits[i] = square, face
                    places[i, 0], places[i, 1], places[i, 2] = nx, ny, nz


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _beside(
    vertices: Floats, a: int, b: int, x: float, y: float
) -> Any:  # pragma: no cover - compiled
    """Whether a ray along +x in the plane of x and y crosses an edge, the same from both sides."""
    if (vertices[a, 1] > y) == (vertices[b, 1] > y):
        return False
    if vertices[a, 1] > vertices[b, 1]:
        a, b = b, a
    ax, ay, bx, by = vertices[a, 0], vertices[a, 1], vertices[b, 0], vertices[b, 1]
    return (bx - ax) * (y - ay) > (x - ax) * (by - ay)


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _above(
    vertices: Floats, a: int, b: int, c: int, x: float, y: float, z: float
) -> Any:  # pragma: no cover - compiled
    """Return by how much a triangle above a point adds to the windings around it: −1, 0 or 1."""
    held = _beside(vertices, a, b, x, y) != _beside(vertices, b, c, x, y)
    if held == _beside(vertices, c, a, x, y):
        return 0
    ax, ay, az = vertices[a, 0], vertices[a, 1], vertices[a, 2]
    ux, uy, uz = vertices[b, 0] - ax, vertices[b, 1] - ay, vertices[b, 2] - az
    vx, vy, vz = vertices[c, 0] - ax, vertices[c, 1] - ay, vertices[c, 2] - az
    nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    height = nx * (x - ax) + ny * (y - ay) + nz * (z - az)
    if nz > 0 and height < 0:
        return 1
    return -1 if nz < 0 and height > 0 else 0


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _wind(
    vertices: Floats,
    faces: NDArray[np.int32],
    boxes: Floats,
    points: Floats,
    first: int,
    last: int,
    stack: Numbers,
    found: Numbers,
) -> None:  # pragma: no cover - compiled
    inner = len(boxes) // 2
    for i in range(first, last):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        depth = 1
        stack[0] = 0
        while depth > 0:
            depth -= 1
            box = stack[depth]
            if not (boxes[box, 0] <= x <= boxes[box, 3] and boxes[box, 1] <= y <= boxes[box, 4]):
                continue
            if boxes[box, 5] < z:
                continue
            if box < inner:
                stack[depth], stack[depth + 1] = 2 * box + 1, 2 * box + 2
                depth += 2
                continue
            start = (box - inner) * LEAF
            for face in range(start, min(start + LEAF, len(faces))):
                found[i] += _above(
                    vertices, faces[face, 0], faces[face, 1], faces[face, 2], x, y, z
                )
