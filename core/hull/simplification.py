"""Level of detail: a hull's surface with fewer faces, and how far that is from the whole one."""

from dataclasses import dataclass

import fast_simplification
import numpy as np
import trimesh

from core.arrays import Floats
from core.hull.closed_mesh import Surface

FEWEST_FACES = 4
"""Of a tetrahedron; nothing smaller encloses anything."""

AGGRESSIVENESS = (3.0, 5.0)
"""Tried in turn until few enough faces are left: the gentler, the better the shape, but the sooner
it stops. At 7, the library's default, a satellite's whole body has been seen to vanish."""

SAMPLES_PER_FACE = 2
SEED = 1
SEARCHED_AT_ONCE = 500
RAY_REACH = 2.0
"""How far off, in sides of a face, rays start."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Simplified:
    """A surface with fewer faces.

    Attributes:
        surface: for display; lengths are measured on the whole one.
        error_m: greatest distance of a checked point of either surface from the other one, 0
            where nothing was taken away. Checked are the vertices of both, and on average
            `SAMPLES_PER_FACE` points a face, spread evenly, of both.
        is_closed: whether every edge still has two faces.
        whole_faces: how many faces there were.
    """

    surface: Surface
    error_m: float
    is_closed: bool
    whole_faces: int


def simplified(
    surface: Surface, *, most_faces: int | None = None, tolerance_m: float | None = None
) -> Simplified:
    """Return a surface with fewer faces, with either limit, and what that costs.

    Args:
        surface: the whole one.
        most_faces: faces to keep at most. More are kept where the surface cannot be simplified
            that far without losing its shape.
        tolerance_m: error to stay within, halving the faces for as long as that goes.

    Raises:
        ValueError: neither or both limits, fewer than 4 faces, or no tolerance above 0.

    Source: Garland and Heckbert, "Surface simplification using quadric error metrics", 1997, as
    in fast-simplification.
    """
    if (most_faces is None) == (tolerance_m is None):
        raise ValueError("Give either the most faces to keep or the tolerance in metres.")
    if most_faces is not None:
        if most_faces < FEWEST_FACES:
            raise ValueError(
                f"A closed surface has at least {FEWEST_FACES} faces; asked for {most_faces}."
            )
        return _with_faces(surface, most_faces)
    if not (tolerance_m is not None and np.isfinite(tolerance_m) and tolerance_m > 0):
        raise ValueError(f"The tolerance must be a positive length in metres, got {tolerance_m}.")
    return _within(surface, tolerance_m)


def _within(surface: Surface, tolerance_m: float) -> Simplified:
    """Return the last of ever coarser surfaces that keeps the tolerance."""
    best = _whole(surface)
    while not best.surface.is_empty:
        coarser = _with_faces(surface, max(FEWEST_FACES, len(best.surface.faces) // 2))
        is_fewer = len(coarser.surface.faces) < len(best.surface.faces)
        if not is_fewer or coarser.error_m > tolerance_m:
            break
        best = coarser
    return best


def _with_faces(surface: Surface, most_faces: int) -> Simplified:
    if len(surface.faces) <= most_faces:
        return _whole(surface)
    coarse = _collapsed(surface, most_faces)
    if coarse.is_empty or len(coarse.faces) >= len(surface.faces):
        return _whole(surface)
    return Simplified(
        surface=coarse,
        error_m=max(_farthest_m(coarse, surface), _farthest_m(surface, coarse)),
        is_closed=_is_closed(coarse),
        whole_faces=len(surface.faces),
    )


def _collapsed(surface: Surface, most_faces: int) -> Surface:
    """Return the surface after the gentlest edge collapses that leave few enough faces.

    Where none does, the gentlest are all that the shape bears.
    """
    tried: list[Surface] = []
    for aggressiveness in AGGRESSIVENESS:
        vertices, faces = fast_simplification.simplify(
            np.array(surface.vertices_m),
            np.array(surface.faces),
            target_count=most_faces,
            agg=aggressiveness,
        )
        tried.append(Surface(vertices_m=vertices, faces=faces))
        if len(faces) <= most_faces:
            return tried[-1]
    return tried[0]


def _whole(surface: Surface) -> Simplified:
    return Simplified(
        surface=surface,
        error_m=0.0,
        is_closed=_is_closed(surface),
        whole_faces=len(surface.faces),
    )


def _is_closed(surface: Surface) -> bool:
    return bool(_mesh(surface).is_watertight)


def _farthest_m(surface: Surface, other: Surface) -> float:
    """Return how far the farthest checked point of a surface is from the other one.

    Rays along the normals give most points' bounds at once; the nearest points are searched for,
    worst bounds first, until no bound left exceeds what was found.
    """
    points, normals = _checked_points(surface)
    mesh = _mesh(other)
    bounds_m = _distance_bounds_m(points, normals, mesh)
    order = np.argsort(-bounds_m)
    farthest_m = 0.0
    for start in range(0, len(order), SEARCHED_AT_ONCE):
        batch = order[start : start + SEARCHED_AT_ONCE]
        if bounds_m[batch[0]] <= farthest_m:
            break
        _, distances_m, _ = trimesh.proximity.closest_point(mesh, points[batch])
        farthest_m = max(farthest_m, float(distances_m.max()))
    return farthest_m


def _distance_bounds_m(points: Floats, normals: Floats, mesh: trimesh.Trimesh) -> Floats:
    """Return (points,) no less than each point's distance from a mesh, infinite where unknown."""
    reach_m = RAY_REACH * np.sqrt(mesh.area / len(mesh.faces))
    bounds_m = np.full(len(points), np.inf)
    for side in (-1.0, 1.0):
        # From a little way off: a ray that starts on a face may miss it.
        places, rays, _ = mesh.ray.intersects_location(
            points + side * reach_m * normals, -side * normals, multiple_hits=False
        )
        found_m = np.linalg.norm(places - points[rays], axis=1)
        bounds_m[rays] = np.minimum(bounds_m[rays], found_m)
    return bounds_m


def _checked_points(surface: Surface) -> tuple[Floats, Floats]:
    """Return the vertices and points spread evenly, (points, 3), and unit normals there."""
    mesh = _mesh(surface)
    used = np.unique(surface.faces)
    count = SAMPLES_PER_FACE * len(surface.faces)
    spread, on = trimesh.sample.sample_surface(mesh, count, seed=SEED)
    points = np.concatenate([surface.vertices_m[used], np.asarray(spread)])
    return points, np.concatenate([mesh.vertex_normals[used], mesh.face_normals[on]])


def _mesh(surface: Surface) -> trimesh.Trimesh:
    return trimesh.Trimesh(surface.vertices_m, surface.faces, process=False)
