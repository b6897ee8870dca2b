"""Key points in the viewport: a ball at each place, with its name."""

import viser

from app.key_points import KeyPointState
from app.layers import KEY_POINT_COLOUR
from core.arrays import Floats

RADIUS_M = 0.2
"""Large enough to be seen from home, and about as exact as a radar frame is marked."""

LABEL_LIFT_M = 0.3


class KeyPointNodes:
    """Keeps a ball and a label in the scene for each key point that has a place."""

    def __init__(self, server: viser.ViserServer) -> None:
        """Show nothing yet."""
        self._server = server
        self._shown: dict[str, tuple[float, ...]] = {}

    def show(self, state: KeyPointState) -> None:
        """Bring the scene up to date; does nothing for what is already there."""
        placed = state.places_m
        wanted = {name: tuple(position) for name, position in placed.items()}
        if wanted == self._shown:
            return
        with self._server.atomic():
            for number in range(len(wanted), len(self._shown)):
                self._server.scene.remove_by_name(_node(number))
            for number, (name, position) in enumerate(placed.items()):
                self._draw(number, name, position)
        self._server.flush()
        self._shown = wanted

    def _draw(self, number: int, name: str, position: Floats) -> None:
        self._server.scene.add_icosphere(
            _node(number),
            radius=RADIUS_M,
            color=KEY_POINT_COLOUR,
            position=tuple(position),
            cast_shadow=False,
            receive_shadow=False,
        )
        self._server.scene.add_label(
            f"{_node(number)}/label", name, position=(0.0, 0.0, -LABEL_LIFT_M), anchor="bottom-left"
        )


def _node(number: int) -> str:
    # Names may hold slashes, which would nest nodes.
    return f"/key-points/{number}"
