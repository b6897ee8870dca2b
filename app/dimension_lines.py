"""Where a length is drawn that would run inside the hull: beside it, as on a drawing of parts."""

import numpy as np

from core.arrays import Floats
from core.hull.closed_mesh import Surface
from core.measurement.triangles import first_hit

DIRECTIONS = 16
"""In which a line may be moved aside, evenly around it."""

CLEARANCE_SHARE = 0.04
"""Between the hull and a line beside it, in lengths of the line."""

NEAR_SHARE = 0.02
"""Half the width of the strip of hull that a line must clear, in lengths of the line."""


def step_aside_m(surface: Surface, start_m: Floats, end_m: Floats) -> Floats:
    """Return by what (3,) a line is moved across itself to lie outside a hull, zero if it does.

    It goes the shortest way of `DIRECTIONS` that clears the hull between its ends.

    Args:
        surface: of the hull, of faces that are small against the line.
        start_m: (3,) of the line, target frame.
        end_m: (3,) of the line, another point.
    """
    if not is_hidden(surface, start_m, end_m):
        return np.zeros(3)
    length_m = float(np.linalg.norm(end_m - start_m))
    along = (end_m - start_m) / length_m
    across = _across(along)
    beside = surface.vertices_m - start_m
    height = beside @ along
    places = beside[(height >= 0) & (height <= length_m)] @ across.T
    turns = 2 * np.pi * np.arange(DIRECTIONS) / DIRECTIONS
    ways = np.column_stack([np.cos(turns), np.sin(turns)])
    reach = np.array([_reach_m(places, way, NEAR_SHARE * length_m) for way in ways])
    best = int(np.argmin(reach))
    step: Floats = (reach[best] + CLEARANCE_SHARE * length_m) * ways[best] @ across
    return step


def is_hidden(surface: Surface, start_m: Floats, end_m: Floats) -> bool:
    """Tell whether a line between two points of a hull runs inside it, or through it."""
    length_m = float(np.linalg.norm(end_m - start_m))
    along = (end_m - start_m) / length_m
    margin_m = 0.01 * length_m
    vertices, faces = surface.vertices_m, surface.faces
    distance_m, _ = first_hit(vertices, faces, start_m + margin_m * along, along)
    if distance_m < length_m - 2 * margin_m:
        return True
    side = _across(along)[0]
    _, face = first_hit(vertices, faces, (start_m + end_m) / 2, side)
    if face < 0:
        return False
    a, b, c = vertices[faces[face]]
    return bool(np.cross(b - a, c - a) @ side > 0)


def _reach_m(places: Floats, way: Floats, near_m: float) -> float:
    """Return how far a body reaches along a way in the plane, in the strip around it."""
    aside = places @ np.array([-way[1], way[0]])
    strip = places[np.abs(aside) <= near_m]
    return max(0.0, float((strip @ way).max())) if len(strip) else 0.0


def _across(along: Floats) -> Floats:
    """Return two unit vectors (2, 3) across a unit vector and each other."""
    helper = np.eye(3)[int(np.argmin(np.abs(along)))]
    first = np.cross(along, helper)
    first /= np.linalg.norm(first)
    return np.array([first, np.cross(along, first)])
