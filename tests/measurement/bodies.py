"""Bodies of known size, and rigid motions of them, for the tests of measurement."""

import numpy as np
import trimesh
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from core.hull.closed_mesh import Surface

SMALL = st.floats(-5, 5)
TURNS = st.tuples(SMALL, SMALL, SMALL).map(lambda v: Rotation.from_rotvec(np.array(v)))
SHIFTS = st.tuples(SMALL, SMALL, SMALL).map(np.array)
X, Y, Z = np.eye(3)


def surface_of(mesh):
    return Surface(vertices_m=np.asarray(mesh.vertices), faces=np.asarray(mesh.faces))


def moved(surface, turn, shift=(0, 0, 0), scale=1.0):
    return Surface(
        vertices_m=scale * surface.vertices_m @ turn.as_matrix().T + shift, faces=surface.faces
    )


def joined(*surfaces):
    """Return several surfaces as one, none of their vertices shared."""
    starts = np.cumsum([0, *(len(part.vertices_m) for part in surfaces)])
    return Surface(
        vertices_m=np.concatenate([part.vertices_m for part in surfaces]),
        faces=np.concatenate(
            [part.faces + start for part, start in zip(surfaces, starts[:-1], strict=True)]
        ),
    )


def box(sizes=(4.0, 2.0, 1.0), centre=(0, 0, 0), fineness=0):
    mesh = trimesh.creation.box(extents=sizes)
    for _ in range(fineness):
        mesh = mesh.subdivide()
    mesh.apply_translation(centre)
    return surface_of(mesh)


def cylinder(radius=1.0, length=6.0, sections=64):
    """Return a cylinder about x whose side has many rings."""
    heights = np.linspace(-length / 2, length / 2, 25)
    outline = np.array([(0, heights[0]), *((radius, h) for h in heights), (0, heights[-1])])
    mesh = trimesh.creation.revolve(outline, sections=sections)
    mesh.apply_transform(trimesh.geometry.align_vectors([0, 0, 1], [1, 0, 0]))
    return surface_of(mesh)
