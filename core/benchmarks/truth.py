"""The true hull: the exact intersection of the silhouettes' prisms, by manifold3d.

It shares neither grid nor votes nor mesher with the engine.
"""

from functools import reduce
from typing import Any

import manifold3d
import numpy as np

from core.hull.closed_mesh import Surface
from core.hull.view import View

REACH_M = 20.0
"""Half the length of the prisms; far longer than the body."""


def true_hull(views: tuple[View, ...]) -> Surface:
    """Return the hull of affine views as an exact mesh, target frame."""
    # Opposite views first would be quicker still; in pairs, solids stay small as they are joined.
    solids = [_prism(view) for view in views]
    while len(solids) > 1:
        solids = [reduce(_common, solids[i : i + 2]) for i in range(0, len(solids), 2)]
    mesh = solids[0].to_mesh64()
    return Surface(
        vertices_m=np.asarray(mesh.vert_properties)[:, :3],
        faces=np.asarray(mesh.tri_verts).astype(np.int32),
    )


def _common(one: Any, other: Any) -> Any:
    return one ^ other


def _prism(view: View) -> Any:
    """Return all points in space that a view sees inside its silhouette, ± `REACH_M` deep."""
    matrix = view.projection.matrix
    # CrossSection's y grows where rows fall, so that outer rings run counter-clockwise there.
    rings = [ring[:, ::-1] for ring in view.silhouette.rings]
    section = manifold3d.CrossSection(rings, manifold3d.FillRule.EvenOdd)
    solid = manifold3d.Manifold.extrude(section, 2 * REACH_M).translate((0, 0, -REACH_M))
    image = np.eye(4)
    image[:2] = matrix[::-1]
    image[2, :3] = np.cross(matrix[1, :3], matrix[0, :3])
    image[2, :3] /= np.linalg.norm(image[2, :3])
    return solid.transform(np.linalg.inv(image)[:3])
