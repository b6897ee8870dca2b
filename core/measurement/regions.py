"""Regions of a surface that a fit rests on, found again on every new hull."""

from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from core.arrays import Floats
from core.hull.closed_mesh import Surface
from core.measurement.anchors import AnchorLost, check_length, freeze_points, nearest_within
from core.measurement.parts import Faces, part_of_face

Growth = Literal["flat", "smooth"]


@dataclass(frozen=True, slots=True, kw_only=True)
class WholeSurface:
    """All of the surface."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ConnectedPart:
    """The connected part nearest to a point.

    Attributes:
        near_m: (3,) target frame.
        reach_m: from further away no part counts as what was picked.
    """

    near_m: Floats
    reach_m: float = 1.0

    def __post_init__(self) -> None:
        freeze_points(self, "near_m")
        check_length(self, "reach_m")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Ball:
    """The faces whose middles lie within a radius of a point.

    Attributes:
        near_m: (3,) target frame.
        radius_m: of the ball.
    """

    near_m: Floats
    radius_m: float

    def __post_init__(self) -> None:
        freeze_points(self, "near_m")
        check_length(self, "radius_m")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Patch:
    """The faces around the surface point nearest to a given one, grown while they go on evenly.

    Attributes:
        near_m: (3,) target frame; the nearest face is the seed.
        angle_rad: "flat": between a face's normal and the seed's, "smooth": between those of two
            neighbours. Normals are averaged over each face's neighbours first.
        growth: "flat" for a plane, "smooth" for a cylinder's side.
        reach_m: from further away the surface no longer counts as what was picked.
        radius_m: the patch ends that far from `near_m`; None for no end.
    """

    near_m: Floats
    angle_rad: float
    growth: Growth = "flat"
    reach_m: float = 1.0
    radius_m: float | None = None

    def __post_init__(self) -> None:
        freeze_points(self, "near_m")
        check_length(self, "reach_m")
        if self.radius_m is not None:
            check_length(self, "radius_m")
        object.__setattr__(self, "angle_rad", float(self.angle_rad))
        if not 0 < self.angle_rad <= np.pi:
            raise ValueError(f"Patch's angle lies above 0 and up to π, got {self.angle_rad} rad.")
        if self.growth not in ("flat", "smooth"):
            raise ValueError(f'A patch grows "flat" or "smooth", not "{self.growth}".')


Region = WholeSurface | ConnectedPart | Ball | Patch


def faces_of(region: Region, surface: Surface) -> Faces | AnchorLost:
    """Return the numbers of a region's faces on a surface, at least one, or why it has none."""
    if surface.is_empty:
        return AnchorLost(reason="The hull is empty, so nothing can be picked on it.")
    if isinstance(region, WholeSurface):
        return np.arange(len(surface.faces))
    if isinstance(region, Ball):
        return _in_ball(region, surface)
    found = nearest_within(surface, region.near_m, region.reach_m)
    if isinstance(found, AnchorLost):
        return found
    _, face = found
    return (
        _patch(region, surface, face) if isinstance(region, Patch) else part_of_face(surface, face)
    )


def _in_ball(region: Ball, surface: Surface) -> Faces | AnchorLost:
    inside = np.flatnonzero(_within(surface, region.near_m, region.radius_m))
    if not len(inside):
        return AnchorLost(
            reason=f"No face of the hull lies within {region.radius_m:g} m of the picked point; "
            "pick it again or take a larger radius."
        )
    return inside


def _within(surface: Surface, centre_m: Floats, radius_m: float) -> NDArray[np.bool_]:
    middle = surface.vertices_m[surface.faces].mean(axis=1)
    within: NDArray[np.bool_] = np.linalg.norm(middle - centre_m, axis=1) <= radius_m
    return within


def _patch(region: Patch, surface: Surface, seed: int) -> Faces:
    normals = even_normals(surface)
    allowed = np.ones(len(surface.faces), dtype=np.bool_)
    if region.growth == "flat":
        allowed &= normals @ normals[seed] >= np.cos(region.angle_rad)
    if region.radius_m is not None:
        allowed &= _within(surface, region.near_m, region.radius_m)
    allowed[seed] = True
    first, second = neighbours(surface).T
    joined = allowed[first] & allowed[second]
    if region.growth == "smooth":
        cosine = np.einsum("ij,ij->i", normals[first], normals[second])
        joined &= cosine >= np.cos(region.angle_rad)
    pairs = first[joined], second[joined]
    links = coo_array((np.ones(len(pairs[0]), dtype=np.bool_), pairs), shape=(len(allowed),) * 2)
    _, labels = connected_components(links, directed=False)
    return np.flatnonzero(labels == labels[seed])


@lru_cache(maxsize=4)
def neighbours(surface: Surface) -> NDArray[np.int64]:
    """Return the pairs of faces that share an edge, (pairs, 2)."""
    faces = surface.faces.astype(np.int64)
    edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    key = edges[:, 0] * len(surface.vertices_m) + edges[:, 1]
    order = np.argsort(key, kind="stable")
    same = key[order][1:] == key[order][:-1]
    owner = order % len(faces)
    pairs: NDArray[np.int64] = np.stack([owner[:-1][same], owner[1:][same]], axis=1)
    pairs.flags.writeable = False
    return pairs


def area_vectors_m2(surface: Surface, faces: Faces | None = None) -> Floats:
    """Return each face's outward normal times its area, (faces, 3) in m²."""
    chosen = surface.faces if faces is None else surface.faces[faces]
    a, b, c = (surface.vertices_m[chosen[:, corner]] for corner in range(3))
    vectors: Floats = np.cross(b - a, c - a) / 2
    return vectors


@lru_cache(maxsize=4)
def even_normals(surface: Surface) -> Floats:
    """Return each face's unit normal, averaged over all faces that it touches, (faces, 3).

    Marching cubes leaves slivers whose own normals mean little.
    """
    vectors = area_vectors_m2(surface)
    at_vertices = np.zeros_like(surface.vertices_m)
    for corner in range(3):
        np.add.at(at_vertices, surface.faces[:, corner], vectors)
    summed = at_vertices[surface.faces].sum(axis=1)
    length = np.linalg.norm(summed, axis=1, keepdims=True)
    normals: Floats = summed / np.where(length > 0, length, 1.0)
    normals.flags.writeable = False
    return normals
