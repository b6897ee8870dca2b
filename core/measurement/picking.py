"""Where a ray meets a surface, and which point of it lies nearest to another."""

import numpy as np

from core.arrays import Floats
from core.hull.closed_mesh import Surface
from core.measurement.triangles import first_hit, nearest_of_all


def first_hit_m(surface: Surface, origin_m: Floats, direction: Floats) -> Floats | None:
    """Return the (3,) point at which a ray first meets the surface, target frame; None for a miss.

    Both sides of a face are met. The ray begins at its origin: what lies behind it is not seen.

    Args:
        surface: to pick on.
        origin_m: (3,) target frame.
        direction: (3,) target frame, of any length above zero.
    """
    unit = direction / np.linalg.norm(direction)
    distance_m, face = first_hit(surface.vertices_m, surface.faces, origin_m, unit)
    return None if face < 0 else origin_m + distance_m * unit


def nearest_point_m(surface: Surface, point_m: Floats) -> tuple[Floats, int]:
    """Return the (3,) point of a surface nearest to a point, target frame, and its face's number.

    Args:
        surface: not empty.
        point_m: (3,) target frame.
    """
    x, y, z = map(float, point_m)
    face, *nearest = nearest_of_all(surface.vertices_m, surface.faces, x, y, z)
    return np.array(nearest), int(face)


def points_within_m(surface: Surface, centre_m: Floats, radius_m: float) -> Floats:
    """Return what of a surface's edges a ball holds: vertices, and where edges leave it, (n, 3).

    Args:
        surface: of any size.
        centre_m: (3,) of the ball, target frame.
        radius_m: of the ball.
    """
    beside = surface.vertices_m - centre_m
    inside = np.einsum("ij,ij->i", beside, beside) <= radius_m**2
    # Corner by corner: NumPy reduces rows of three several times as slowly.
    a, b, c = (inside[surface.faces[:, corner]] for corner in range(3))
    touched = surface.faces[(a | b | c) & ~(a & b & c)]
    edges = np.concatenate([touched[:, [i, j]] for i in range(3) for j in range(3) if i != j])
    edges = edges[inside[edges[:, 0]] & ~inside[edges[:, 1]]]
    start, step = beside[edges[:, 0]], beside[edges[:, 1]] - beside[edges[:, 0]]
    squared, half = np.einsum("ij,ij->i", step, step), np.einsum("ij,ij->i", start, step)
    rest = np.maximum(radius_m**2 - np.einsum("ij,ij->i", start, start), 0)
    share = (np.sqrt(half**2 + squared * rest) - half) / squared
    points: Floats = np.concatenate(
        [surface.vertices_m[inside], centre_m + start + share[:, None] * step]
    )
    return points
