"""Meshes of targets: GLB (Draco-compressed too), PLY, OBJ and STL."""

import io
from pathlib import Path

import numpy as np
import trimesh
from numpy.typing import NDArray

from core.arrays import Floats, frozen

MESH_SUFFIXES = (".glb", ".ply", ".obj", ".stl")

DRACO_EXTENSION = b"KHR_draco_mesh_compression"
"""What a GLB file names where its meshes are compressed."""


def read_mesh(path: Path, *, unit_m: float = 1.0) -> trimesh.Trimesh:
    """Read all meshes of a file as one, in metres, along the file's own axes.

    Equal vertices are merged. Materials, and other files that this one points to, are not read.

    Args:
        path: a file of one of MESH_SUFFIXES.
        unit_m: length of the file's unit; the formats do not say it reliably.

    Raises:
        ValueError: another kind of file, one that cannot be read or holds no triangles, vertices
            that are NaN or infinite, faces without their vertices, or a unit that is no length.
    """
    if not (np.isfinite(unit_m) and unit_m > 0):
        raise ValueError(f"The mesh's unit must be a positive length in metres, got {unit_m}.")
    content = _content(path)
    vertices, faces = _joined(_loaded(path, content))
    if len(vertices) == 0 or len(faces) == 0:
        raise ValueError(
            f"{path.name} gives {len(vertices)} vertices and {len(faces)} faces; a mesh of "
            f"triangles is needed.{_draco_hint(content)}"
        )
    vertices = frozen(vertices, np.float64, (None, 3), f"Vertices of {path.name}")
    if not np.any(np.ptp(vertices, axis=0)):
        raise ValueError(f"All {len(vertices)} vertices of {path.name} lie on one point.")
    if int(faces.min()) < 0 or int(faces.max()) >= len(vertices):
        raise ValueError(
            f"{path.name} has faces with vertex numbers from {faces.min()} to {faces.max()} for "
            f"{len(vertices)} vertices; is it cut off?"
        )
    return trimesh.Trimesh(vertices=vertices * unit_m, faces=faces)


def _content(path: Path) -> bytes:
    if path.suffix.lower() not in MESH_SUFFIXES:
        raise ValueError(
            f'A mesh file ends in {", ".join(MESH_SUFFIXES)}; got "{path.name}". Convert it first.'
        )
    if not path.is_file():
        raise ValueError(f"There is no mesh file {path}.")
    return path.read_bytes()


def _loaded(path: Path, content: bytes) -> list[trimesh.Trimesh]:
    """Return the file's triangle meshes, each moved to its place in the scene."""
    try:
        # From memory, so that nothing beside this file is ever opened.
        loaded = trimesh.load(io.BytesIO(content), file_type=path.suffix[1:].lower(), process=False)
        parts = loaded.dump() if isinstance(loaded, trimesh.Scene) else [loaded]
    except Exception as error:  # trimesh raises what its parsers happen to meet
        raise ValueError(
            f"{path.name} is no {path.suffix[1:].upper()} file that trimesh can read: "
            f"{type(error).__name__}: {error}.{_draco_hint(content)}"
        ) from error
    meshes = [part for part in parts if isinstance(part, trimesh.Trimesh)]
    empty = [mesh for mesh in meshes if _is_empty(mesh)]
    if empty and DRACO_EXTENSION in content:
        raise ValueError(
            f"{len(empty)} of {len(meshes)} meshes of {path.name} came without vertices."
            f"{_draco_hint(content)}"
        )
    return meshes


def _is_empty(mesh: trimesh.Trimesh) -> bool:
    """Whether a mesh has no vertices, or trimesh's placeholders, which all lie on one point."""
    return len(mesh.vertices) == 0 or not np.any(np.ptp(mesh.vertices, axis=0))


def _joined(meshes: list[trimesh.Trimesh]) -> tuple[Floats, NDArray[np.int64]]:
    vertices = [np.asarray(mesh.vertices, dtype=np.float64).reshape(-1, 3) for mesh in meshes]
    starts = np.cumsum([0, *(len(part) for part in vertices)])
    faces = [
        np.asarray(mesh.faces, dtype=np.int64).reshape(-1, 3) + start
        for mesh, start in zip(meshes, starts[:-1], strict=True)
    ]
    return (
        np.concatenate([np.empty((0, 3)), *vertices]),
        np.concatenate([np.empty((0, 3), dtype=np.int64), *faces]),
    )


def _draco_hint(content: bytes) -> str:
    if DRACO_EXTENSION not in content:
        return ""
    return (
        " It is compressed with Draco, and its decoder gave nothing; "
        "install it (pip install DracoPy) or export the mesh uncompressed."
    )
