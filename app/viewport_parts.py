"""The hulls of the target's parts in the viewport, each in its colour."""

import viser

from app.components import colours_of
from app.snapshot import Snapshot
from app.surface_node import SurfaceNode


class PartNodes:
    """Keeps a node for the hull of each part; a part that went leaves its node hidden."""

    def __init__(self, server: viser.ViserServer, above: str) -> None:
        """Show no part yet; nodes will hang below `above`."""
        self._server = server
        self._above = above
        self._nodes: dict[str, SurfaceNode] = {}

    def show(self, snapshot: Snapshot) -> None:
        """Show a snapshot's parts and no others; call within one `server.atomic()`."""
        colours = colours_of(snapshot)
        for label in self._nodes.keys() - set(snapshot.components):
            self._nodes[label].show(None)
        for part in snapshot.parts:
            if part.label not in self._nodes:
                self._nodes[part.label] = self._made()
            node = self._nodes[part.label]
            node.colour(colours[part.label])
            node.show(part.surface)

    def _made(self) -> SurfaceNode:
        # A label may hold what a node's name may not.
        return SurfaceNode(self._server, f"{self._above}/{len(self._nodes)}")
