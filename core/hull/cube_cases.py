"""The 256 ways a surface can pass a cube of eight voxels, derived and not listed.

On each face of the cube, crossings are joined so that each run of inside corners is cut off by
itself. Two cubes that share a face thus join its crossings alike, whatever else they hold, and the
surface is closed. No triangle has a side across a face, or two cubes could share it twice.

Corners are numbered dy + 2 dx + 4 dz, edges as `EDGES` lists them.

Source: Lorensen and Cline, "Marching cubes", 1987, with the face rule of Montani, Scateni and
Scopigno, 1994.
"""

from functools import cache

import numpy as np
from numpy.typing import NDArray

Loop = tuple[int, ...]

AXIS_BITS = (2, 1, 4)
EDGES = [(corner, corner | bit) for bit in AXIS_BITS for corner in range(8) if not corner & bit]
MOST_TRIANGLES = 5


@cache
def triangle_table() -> NDArray[np.int8]:
    """Return (256, 1 + 3 · MOST_TRIANGLES): how many triangles, then their edges' numbers."""
    table = np.zeros((256, 1 + 3 * MOST_TRIANGLES), dtype=np.int8)
    for case in range(256):
        triangles = [t for loop in loops(case) for t in _triangulated(loop)]
        flat = [edge for triangle in triangles for edge in triangle]
        table[case, : 1 + len(flat)] = [len(triangles), *flat]
    return table


@cache
def edge_tables() -> NDArray[np.int8]:
    """Return (2, 12, 3): which index buffer holds each edge's vertex, and its dy and dz there.

    Buffer 0 is for edges along x. Of the buffers 1 and 2 for edges along y, and 3 and 4 along z,
    the first is the near plane's in the first table and the far plane's in the second: planes
    take turns.
    """
    tables = np.zeros((2, 12, 3), dtype=np.int8)
    for turn in range(2):
        for number, (corner, _) in enumerate(EDGES):
            axis, far = number // 4, (corner >> 1 & 1) ^ turn
            tables[turn, number] = 0 if axis == 0 else 2 * axis - 1 + far, corner & 1, corner >> 2
    return tables


@cache
def loops(case: int) -> tuple[Loop, ...]:
    """Return the closed loops of crossed edges, counter-clockwise as seen from outside the hull."""
    follows: dict[int, int] = {}
    for face in _faces():
        follows.update(_face_joins(case, face))
    found: list[Loop] = []
    while follows:
        edge = next(iter(follows))
        loop = []
        while edge in follows:
            loop.append(edge)
            edge = follows.pop(edge)
        found.append(tuple(loop))
    return tuple(found)


def _face_joins(case: int, face: tuple[int, ...]) -> dict[int, int]:
    """Return which crossed edge leads to which on one face, around each run of inside corners."""
    inside = [bool(case >> corner & 1) for corner in face]
    joins: dict[int, int] = {}
    for i in range(4):
        if inside[i] and not inside[i - 1]:
            end = i
            while inside[(end + 1) % 4]:
                end += 1
            joins[_edge(face[i - 1], face[i])] = _edge(face[end % 4], face[(end + 1) % 4])
    return joins


def _edge(one: int, other: int) -> int:
    return EDGES.index((min(one, other), max(one, other)))


@cache
def _faces() -> tuple[tuple[int, ...], ...]:
    """Return each face's corners, counter-clockwise as seen from outside the cube."""
    faces = []
    for axis, bit in enumerate(AXIS_BITS):
        first, second = AXIS_BITS[(axis + 1) % 3], AXIS_BITS[(axis + 2) % 3]
        ring = (0, first, first | second, second)
        faces.append(tuple(corner | bit for corner in ring))
        faces.append(ring[::-1])
    return tuple(faces)


def _triangulated(loop: Loop) -> list[Loop]:
    """Return triangles of a loop without a side across a face of the cube."""
    found = _search(loop)
    if found is None:
        raise ValueError(f"No triangles for the loop {loop}.")
    return found


def _search(loop: Loop) -> list[Loop] | None:
    if len(loop) == 3:
        return [loop]
    for i in range(len(loop)):
        turned = loop[i:] + loop[:i]
        if not _share_face(turned[0], turned[2]):
            rest = _search(turned[:1] + turned[2:])
            if rest is not None:
                return [turned[:3], *rest]
    return None


def _share_face(one: int, other: int) -> bool:
    corners = {*EDGES[one], *EDGES[other]}
    return any(corners <= set(face) for face in _faces())
