"""The hull in the colours of its distances from the reference, as viser takes coloured meshes."""

from typing import Any

import numpy as np
import trimesh
from numpy.typing import NDArray

from app.reference import Compared
from app.surface_node import lifted

DISTANCE_LIFT_M = 0.02
"""By which the coloured hull lies outside the hull, which would else shine through."""


def coloured_glb(compared: Compared) -> bytes:
    """Return a hull in the colours of its distances as a GLB file."""
    shown = lifted(compared.surface, DISTANCE_LIFT_M)
    mesh = trimesh.Trimesh(
        shown.vertices_m, shown.faces, vertex_colors=_linear(compared.colours()), process=False
    )
    content: bytes = trimesh.exchange.gltf.export_glb(
        trimesh.Scene(mesh), include_normals=True, tree_postprocessor=_make_dull
    )
    return content


def _linear(colours: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Return colours of screens (sRGB) as glTF has those of vertices, in proportion to light.

    Source: IEC 61966-2-1, the inverse transfer function.
    """
    shares = colours / 255.0
    light = np.where(shares <= 0.04045, shares / 12.92, ((shares + 0.055) / 1.055) ** 2.4)
    encoded: NDArray[np.uint8] = np.round(255 * light).astype(np.uint8)
    return encoded


def _make_dull(tree: dict[str, Any]) -> None:
    """Give a glTF tree's meshes a material; without one they are of metal, and nearly black."""
    dull = {"metallicFactor": 0.0, "roughnessFactor": 1.0}
    tree["materials"] = [{"pbrMetallicRoughness": dull, "doubleSided": True}]
    for mesh in tree["meshes"]:
        for primitive in mesh["primitives"]:
            primitive["material"] = 0
