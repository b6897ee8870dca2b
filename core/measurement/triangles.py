"""Kernels over the triangles of a surface: where a ray meets one, where one is nearest to a point.

Each looks at every triangle and needs nothing built beforehand, so that a hull that changed a
moment ago is picked as quickly as one that stands still: a few milliseconds at 300 000 faces.
"""

from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.hull.threads import InnerLoop

RIM = 1e-9
"""Share of a triangle's width by which it is widened: no ray may slip between two neighbours."""


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def first_hit(
    vertices: Floats, faces: NDArray[np.int32], origin: Floats, unit: Floats
) -> Any:  # pragma: no cover - compiled
    """Return the least distance at which a ray meets a triangle, and the triangle's number.

    The distance is infinite and the number −1 if it meets none.

    Source: Möller and Trumbore, "Fast, minimum storage ray/triangle intersection", 1997.
    """
    nearest, hit = np.inf, -1
    for face in range(len(faces)):
        a, b, c = faces[face, 0], faces[face, 1], faces[face, 2]
        ax, ay, az = vertices[a, 0], vertices[a, 1], vertices[a, 2]
        ux, uy, uz = vertices[b, 0] - ax, vertices[b, 1] - ay, vertices[b, 2] - az
        vx, vy, vz = vertices[c, 0] - ax, vertices[c, 1] - ay, vertices[c, 2] - az
        px = unit[1] * vz - unit[2] * vy
        py = unit[2] * vx - unit[0] * vz
        pz = unit[0] * vy - unit[1] * vx
        scale = ux * px + uy * py + uz * pz
        if scale == 0.0:
            continue
        tx, ty, tz = origin[0] - ax, origin[1] - ay, origin[2] - az
        u = (tx * px + ty * py + tz * pz) / scale
        if u < -RIM or u > 1 + RIM:
            continue
        qx, qy, qz = ty * uz - tz * uy, tz * ux - tx * uz, tx * uy - ty * ux
        v = (unit[0] * qx + unit[1] * qy + unit[2] * qz) / scale
        if v < -RIM or u + v > 1 + RIM:
            continue
        distance = (vx * qx + vy * qy + vz * qz) / scale
        if 0 <= distance < nearest:
            nearest, hit = distance, face
    return nearest, hit


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def nearest_on_triangle(
    vertices: Floats, a: int, b: int, c: int, x: float, y: float, z: float
) -> Any:  # pragma: no cover - compiled
    """Return the squared distance of a triangle's nearest point from (x, y, z), and that point.

    Source: Ericson, "Real-time collision detection", 2005, section 5.1.5, with the edges' cases
    told apart by the barycentric numerators.
    """
    ax, ay, az = vertices[a, 0], vertices[a, 1], vertices[a, 2]
    ux, uy, uz = vertices[b, 0] - ax, vertices[b, 1] - ay, vertices[b, 2] - az
    vx, vy, vz = vertices[c, 0] - ax, vertices[c, 1] - ay, vertices[c, 2] - az
    px, py, pz = x - ax, y - ay, z - az
    d1, d2 = ux * px + uy * py + uz * pz, vx * px + vy * py + vz * pz
    uu, vv = ux * ux + uy * uy + uz * uz, vx * vx + vy * vy + vz * vz
    uv = ux * vx + uy * vy + uz * vz
    # Dot products of both edges with the ways from b and from c.
    d3, d4, d5, d6 = d1 - uu, d2 - uv, d1 - uv, d2 - vv
    va, vb, vc = d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2
    s = t = 0.0
    if d1 <= 0 and d2 <= 0:
        s = t = 0.0
    elif d3 >= 0 and d4 <= d3:
        s = 1.0
    elif d6 >= 0 and d5 <= d6:
        t = 1.0
    elif vc <= 0 and d1 >= 0 and d3 <= 0:
        s = d1 / uu
    elif vb <= 0 and d2 >= 0 and d6 <= 0:
        t = d2 / vv
    elif va <= 0 and d4 >= d3 and d5 >= d6:
        t = (d4 - d3) / ((d4 - d3) + (d5 - d6))
        s = 1 - t
    else:
        whole = va + vb + vc
        s, t = vb / whole, vc / whole
    nx, ny, nz = ax + s * ux + t * vx, ay + s * uy + t * vy, az + s * uz + t * vz
    return (nx - x) ** 2 + (ny - y) ** 2 + (nz - z) ** 2, nx, ny, nz


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def nearest_of_all(
    vertices: Floats, faces: NDArray[np.int32], x: float, y: float, z: float
) -> Any:  # pragma: no cover - compiled
    """Return the number of the triangle nearest to (x, y, z), and its nearest point."""
    best, best_face, best_x, best_y, best_z = np.inf, -1, x, y, z
    for face in range(len(faces)):
        square, nx, ny, nz = nearest_on_triangle(
            vertices, faces[face, 0], faces[face, 1], faces[face, 2], x, y, z
        )
        if square < best:
            best, best_face, best_x, best_y, best_z = square, face, nx, ny, nz
    return best_face, best_x, best_y, best_z
