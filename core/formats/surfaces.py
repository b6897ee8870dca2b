"""Surfaces written for other programs."""

from pathlib import Path

import trimesh

from core.formats.files import checked_output, written_aside
from core.hull.surface import Surface

SUFFIXES = (".glb", ".ply", ".stl")


def write_surface(path: Path, surface: Surface) -> None:
    """Write a surface in metres, target frame, as GLB, PLY or STL by the file's ending.

    An existing file is replaced only once the new one is whole.

    Raises:
        ValueError: another ending, an empty surface, or a folder that cannot be written.
    """
    checked_output(path, SUFFIXES)
    if surface.is_empty:
        raise ValueError("The hull is empty; there is no surface to write.")
    content = surface_bytes(surface, path.suffix.lower())
    with written_aside(path) as aside:
        aside.write_bytes(content)


def surface_bytes(surface: Surface, suffix: str) -> bytes:
    """Return a surface that is not empty as the file that ends in one of SUFFIXES, in metres."""
    mesh = trimesh.Trimesh(surface.vertices_m, surface.faces, process=False)
    return bytes(mesh.export(file_type=suffix[1:]))
