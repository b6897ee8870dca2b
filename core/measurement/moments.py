"""Kernels that go once over a surface's faces: a body's moments, and which faces hang together."""

from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.hull.threads import InnerLoop


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def add_moments(
    vertices: Floats, faces: NDArray[np.int32], x: float, y: float, z: float, sums: Floats
) -> Any:  # pragma: no cover - compiled
    """Add a closed body's moments about (x, y, z) to `sums`.

    Of every tetrahedron between a face (a, b, c) and that point, v being six times its volume and
    t = a + b + c: v, v t, and v (a aᵀ + b bᵀ + c cᵀ + t tᵀ) as xx, xy, xz, yy, yz, zz.
    """
    for face in range(len(faces)):
        a, b, c = faces[face, 0], faces[face, 1], faces[face, 2]
        ax, ay, az = vertices[a, 0] - x, vertices[a, 1] - y, vertices[a, 2] - z
        bx, by, bz = vertices[b, 0] - x, vertices[b, 1] - y, vertices[b, 2] - z
        cx, cy, cz = vertices[c, 0] - x, vertices[c, 1] - y, vertices[c, 2] - z
        v = (
            ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
        )  # fmt: skip
        tx, ty, tz = ax + bx + cx, ay + by + cy, az + bz + cz
        sums[0] += v
        sums[1] += v * tx
        sums[2] += v * ty
        sums[3] += v * tz
        sums[4] += v * (ax * ax + bx * bx + cx * cx + tx * tx)
        sums[5] += v * (ax * ay + bx * by + cx * cy + tx * ty)
        sums[6] += v * (ax * az + bx * bz + cx * cz + tx * tz)
        sums[7] += v * (ay * ay + by * by + cy * cy + ty * ty)
        sums[8] += v * (ay * az + by * bz + cy * cz + ty * tz)
        sums[9] += v * (az * az + bz * bz + cz * cz + tz * tz)


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def join_vertices(
    faces: NDArray[np.int32], parents: NDArray[np.int32], labels: NDArray[np.int32]
) -> Any:  # pragma: no cover - compiled
    """Fill `labels` with the connected part of every face, numbered as their first faces come.

    `parents` starts as (vertices,) numbers 0, 1, 2 …, and becomes −1 − part at every part's root.

    Source: Galler and Fischer, "An improved equivalence algorithm", 1964, with halved paths.
    """
    for face in range(len(faces)):
        first = faces[face, 0]
        for corner in range(1, 3):
            other = faces[face, corner]
            while parents[first] != first:
                parents[first] = parents[parents[first]]
                first = parents[first]
            while parents[other] != other:
                parents[other] = parents[parents[other]]
                other = parents[other]
            if other < first:
                parents[first] = other
            else:
                parents[other] = first
    count = 0
    for face in range(len(faces)):
        root = faces[face, 0]
        while parents[root] >= 0 and parents[root] != root:
            root = parents[root]
        if parents[root] == root:
            parents[root] = -1 - count
            count += 1
        labels[face] = -1 - parents[root]
