"""How far surfaces lie apart, by a geometry library and not by the engine."""

import numpy as np
import trimesh

from core.arrays import Floats
from core.hull.closed_mesh import Surface


def distances_m(points_m: Floats, surface: Surface) -> Floats:
    """Return the distance (points,) of each point to the nearest point of a surface."""
    mesh = trimesh.Trimesh(surface.vertices_m, surface.faces, process=False)
    _, distance, _ = trimesh.proximity.closest_point(mesh, points_m)
    found: Floats = np.asarray(distance)
    return found


def sampled_points(surface: Surface, count: int, seed: int = 1) -> Floats:
    """Return points (count, 3) spread evenly over a surface."""
    mesh = trimesh.Trimesh(surface.vertices_m, surface.faces, process=False)
    points, _ = trimesh.sample.sample_surface(mesh, count, seed=seed)
    found: Floats = np.asarray(points)
    return found
