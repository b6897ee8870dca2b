"""A surface in viser's scene that changes without being made anew."""

import numpy as np
import viser

from app.layers import COMPONENT_COLOURS, Colour
from core.hull.surface import Surface

EDGES_SCALE = 1.001
"""Lifts edges off the faces that they bound, a centimetre at ten metres, or they would flicker."""


class SurfaceNode:
    """A mesh in the scene, made when there is first something to show, then updated."""

    def __init__(
        self,
        server: viser.ViserServer,
        name: str,
        *,
        colour: Colour = COMPONENT_COLOURS[0],
        opacity: float | None = None,
        wireframe: bool = False,
    ) -> None:
        """Show nothing yet.

        Args:
            server: whose scene it is.
            name: of its node.
            colour: of all its faces.
            opacity: below 1 lets what is behind it through, None is opaque.
            wireframe: whether it shows the triangles' edges only.
        """
        self._server = server
        self._name = name
        self._colour = colour
        self._opacity = opacity
        self._wireframe = wireframe
        self._shown: Surface | None = None
        self._mesh: viser.MeshHandle | None = None

    @property
    def mesh(self) -> viser.MeshHandle | None:
        """The node, None before there was anything to show."""
        return self._mesh

    def colour(self, colour: Colour) -> None:
        """Give it another colour."""
        if colour == self._colour:
            return
        self._colour = colour
        if self._mesh is not None:
            self._mesh.color = colour

    def fade(self, opacity: float | None) -> None:
        """Let what is behind it through, or make it opaque again with None."""
        if opacity == self._opacity:
            return
        self._opacity = opacity
        if self._mesh is not None:
            self._mesh.opacity = opacity

    def show(self, surface: Surface | None) -> None:
        """Show a surface, or hide it where there is none; call within one `server.atomic()`.

        Vertices without their faces would be drawn as a tangle.
        """
        if surface is self._shown:
            return
        self._shown = surface
        if surface is None or surface.is_empty:
            if self._mesh is not None:
                self._mesh.visible = False
        elif self._mesh is None:
            self._mesh = self._made(surface)
        else:
            self._mesh.vertices = surface.vertices_m.astype(np.float32)
            self._mesh.faces = surface.faces.astype(np.uint32)
            self._mesh.visible = True

    def _made(self, surface: Surface) -> viser.MeshHandle:
        return self._server.scene.add_mesh_simple(
            self._name,
            vertices=surface.vertices_m,
            faces=surface.faces,
            color=self._colour,
            opacity=self._opacity,
            wireframe=self._wireframe,
            scale=EDGES_SCALE if self._wireframe else 1.0,
            side="double",
            cast_shadow=False,
            receive_shadow=False,
        )


def lifted(surface: Surface, by_m: float) -> Surface:
    """Return a surface a little outside itself, so that it hides what it was lifted off."""
    a, b, c = (surface.vertices_m[surface.faces[:, corner]] for corner in range(3))
    across = np.cross(b - a, c - a)
    normals = np.zeros_like(surface.vertices_m)
    for corner in range(3):
        np.add.at(normals, surface.faces[:, corner], across)
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    unit = normals / np.where(lengths > 0, lengths, 1.0)
    return Surface(vertices_m=surface.vertices_m + by_m * unit, faces=surface.faces)
