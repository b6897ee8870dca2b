"""A target's surface as flat facets, and how much of each the radar lights."""

from dataclasses import dataclass

import numpy as np
import trimesh
from numpy.typing import NDArray

from core.arrays import Floats, frozen
from core.radar.scatterers import SURFACE_OFFSET_M
from core.targets import Target

MOST_PIECES = 4_000_000
"""Pieces beyond which a surface is refused: a gigabyte of corners, rays and shares."""

_QUARTERS = np.array([[4, 1, 1], [1, 4, 1], [1, 1, 4], [2, 2, 2]]) / 6
"""Centres of a triangle's four equal quarters, as weights of its corners."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Facets:
    """Flat triangles on a target's surface.

    Attributes:
        corners_m: (facets, 3, 3), corner by corner in the target frame, anticlockwise from outside.
        normal: (facets, 3) outward unit normals.
        share: (facets,) of each that is lit.
    """

    corners_m: Floats
    normal: Floats
    share: Floats

    def __post_init__(self) -> None:
        corners = frozen(self.corners_m, np.float64, (None, 3, 3), "Facet corners")
        normal = frozen(self.normal, np.float64, (len(corners), 3), "Facet normals")
        share = frozen(self.share, np.float64, (len(corners),), "Lit shares")
        for name, value in (("corners_m", corners), ("normal", normal), ("share", share)):
            object.__setattr__(self, name, value)

    def __len__(self) -> int:
        """Return the number of facets."""
        return len(self.corners_m)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ShadedSurface:
    """A target's triangles, and pieces of them small enough for each to be lit or dark.

    Attributes:
        mesh: the triangles, and what shades them.
        piece_corners_m: (pieces, 3, 3), those of a triangle after each other.
        face: (pieces,) the triangle of the mesh that each is cut from, growing.
    """

    mesh: trimesh.Trimesh
    piece_corners_m: Floats
    face: NDArray[np.int64]

    def lit_facets(self, line_of_sight: Floats) -> Facets:
        """Return what the radar lights from one direction.

        Each quarter of a piece counts as lit if it faces the radar and its centre's ray gets
        there. A triangle that is lit all over comes whole: one facet instead of its pieces.

        Args:
            line_of_sight: (3,) unit vector from radar to target, target frame.
        """
        normals: Floats = self.mesh.face_normals
        share = self._lit_share(line_of_sight, normals[self.face])
        faces, first = np.unique(self.face, return_index=True)
        all_lit = np.minimum.reduceat(share, first) == 1
        cut = ~np.isin(self.face, faces[all_lit]) & (share > 0)
        return Facets(
            corners_m=np.concatenate(
                [self.mesh.triangles[faces[all_lit]], self.piece_corners_m[cut]]
            ),
            normal=np.concatenate([normals[faces[all_lit]], normals[self.face[cut]]]),
            share=np.concatenate([np.ones(np.count_nonzero(all_lit)), share[cut]]),
        )

    def _lit_share(self, line_of_sight: Floats, normal: Floats) -> Floats:
        share = np.zeros(len(self.face))
        facing = np.flatnonzero(normal @ line_of_sight < 0)
        centres = np.einsum("qc,fcx->fqx", _QUARTERS, self.piece_corners_m[facing])
        origins = (centres + SURFACE_OFFSET_M * normal[facing, None]).reshape(-1, 3)
        toward_radar = np.broadcast_to(-line_of_sight, origins.shape)
        shaded = self.mesh.ray.intersects_any(origins, toward_radar)
        share[facing] = 1 - shaded.reshape(-1, len(_QUARTERS)).mean(axis=1)
        return share


def shaded_surface(target: Target, *, longest_edge_m: float) -> ShadedSurface:
    """Cut a target's surface into pieces small enough for each to be lit or dark.

    A piece whose longest edge is too long is halved across it, as often as it takes. Where
    neighbours meet no corner needs to match: the surface integral is the same however it is cut.

    Args:
        target: the body.
        longest_edge_m: that a piece may have.

    Raises:
        ValueError: the target has no surface, no positive length is given, or there would be more
            than four million pieces.
    """
    mesh = target.mesh()
    if len(mesh.faces) == 0 or not mesh.area > 0:
        raise ValueError(f"{target.name} has no surface to reflect; load a mesh with faces.")
    if not (np.isfinite(longest_edge_m) and longest_edge_m > 0):
        raise ValueError(f"A facet's longest edge must be positive metres, got {longest_edge_m}.")
    # No piece is larger than an equilateral triangle, so that hopeless cases end at once.
    fewest = mesh.area / (np.sqrt(3) / 4 * longest_edge_m**2)
    face = np.flatnonzero(mesh.area_faces > 0)
    corners = mesh.triangles[face]
    while max(len(corners), fewest) <= MOST_PIECES:
        edges = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
        long = edges.max(axis=1) > longest_edge_m
        if not long.any():
            order = np.argsort(face, kind="stable")
            return ShadedSurface(mesh=mesh, piece_corners_m=corners[order], face=face[order])
        corners = np.concatenate([corners[~long], _halved(corners[long], edges[long])])
        face = np.concatenate([face[~long], face[long], face[long]])
    raise ValueError(
        f"Edges of at most {longest_edge_m} m would cut {target.name} into more than "
        f"{MOST_PIECES:,} pieces; allow longer ones."
    )


def _halved(corners: Floats, edges: Floats) -> Floats:
    """Return both halves of triangles (n, 3, 3) cut across their longest edges, (2 n, 3, 3)."""
    first = np.argmax(edges, axis=1)
    each = np.arange(len(corners))
    start, end, top = (corners[each, (first + step) % 3] for step in range(3))
    middle = (start + end) / 2
    halves = [np.stack([start, middle, top], axis=1), np.stack([middle, end, top], axis=1)]
    return np.concatenate(halves)
