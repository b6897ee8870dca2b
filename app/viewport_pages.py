"""Each page's own camera and layers in the viewport, whichever viser client it now has."""

import threading
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field

import numpy as np
import viser

from app.camera import Camera
from app.layers import FIRST_LAYERS, LAYERS
from app.viser_server import PrivateViserServer

Listener = Callable[[str, viser.ClientHandle | None], None]
"""Called with a page's name and the viser client that it now has, None once that is gone."""

MOST_REMEMBERED = 64
"""Pages whose layers are kept; a page that comes back from a lost connection finds them again."""


@dataclass(slots=True, eq=False)
class _Page:
    layers: frozenset[str] = FIRST_LAYERS
    camera: Camera | None = None
    client: viser.ClientHandle | None = None
    groups: dict[str, viser.FrameHandle] = field(default_factory=dict)


class ViewportPages:
    """What each page shows of the one scene, and from where.

    A page names itself in the address of its viser client. A layer is hidden by a node that only
    this client has in the place of everybody's. What is set before the client has connected, or
    while it is away, is done when it comes.
    """

    def __init__(
        self,
        server: PrivateViserServer,
        want: Callable[[frozenset[str]], None],
        *,
        has_reference: bool = False,
    ) -> None:
        """Serve the pages of a viser server.

        Args:
            server: whose clients the pages have.
            want: is called with the layers that some page shows, when they change.
            has_reference: whether there is a reference to show.
        """
        self.has_reference = has_reference
        self._server = server
        self._want = want
        self._lock = threading.RLock()
        self._pages: dict[str, _Page] = {}
        self._wanted: frozenset[str] = frozenset()
        self._listeners: list[Listener] = []
        server.on_client_connect(self._come)
        server.on_client_disconnect(self._go)

    def listen(self, listener: Listener) -> None:
        """Call `listener` whenever a page's viser client has come or gone."""
        self._listeners.append(listener)

    def layers(self, name: str) -> frozenset[str]:
        """Return the layers that a page shows."""
        with self._lock:
            return self._pages[name].layers if name in self._pages else FIRST_LAYERS

    def show_layers(self, name: str, layers: frozenset[str]) -> None:
        """Show these layers on a page, and no others."""
        with self._lock:
            page = self._page(name)
            page.layers = layers
            self._apply_layers(page)
            self._tell_wanted()

    def camera(self, name: str) -> Camera | None:
        """Return where a page's camera stands, None where that is not known."""
        with self._lock:
            page = self._pages.get(name)
            if page is None or page.client is None:
                return None if page is None else page.camera
            seen = page.client.camera
            with suppress(ValueError):  # somebody has flown it where no camera should be sent
                return Camera(
                    position_m=np.array(seen.position),
                    look_at_m=np.array(seen.look_at),
                    up=np.array(seen.up_direction),
                    field_of_view_rad=float(seen.fov),
                )
            return None

    def aspect(self, name: str) -> float:
        """Return the width of a page's picture over its height, 1 where that is not known."""
        with self._lock:
            page = self._pages.get(name)
            if page is None or page.client is None or page.client.camera.image_height == 0:
                return 1.0
            return page.client.camera.aspect

    def move_camera(self, name: str, camera: Camera) -> None:
        """Put a page's camera somewhere; no other page's moves."""
        with self._lock:
            page = self._page(name)
            page.camera = camera
            self._apply_camera(page)

    def _page(self, name: str) -> _Page:
        page = self._pages.pop(name, None) or _Page()
        self._pages[name] = page  # the latest last
        gone = [known for known, other in self._pages.items() if other.client is None]
        for known in gone[: max(0, len(self._pages) - MOST_REMEMBERED)]:
            if known != name:
                del self._pages[known]
        return page

    def _come(self, client: viser.ClientHandle) -> None:
        if not (name := self._server.page_of(client)):
            return
        with self._lock:
            page = self._page(name)
            page.client, page.groups = client, {}
            self._apply_layers(page)
            self._apply_camera(page)
            self._tell_wanted()
        self._tell_listeners(name, client)

    def _go(self, client: viser.ClientHandle) -> None:
        with self._lock:
            left = [name for name, page in self._pages.items() if page.client is client]
            for name in left:
                self._pages[name].client, self._pages[name].groups = None, {}
            self._tell_wanted()
        for name in left:
            self._tell_listeners(name, None)

    def _tell_listeners(self, name: str, client: viser.ClientHandle | None) -> None:
        for listener in self._listeners:
            listener(name, client)

    def _apply_layers(self, page: _Page) -> None:
        if page.client is None:
            return
        with page.client.atomic():
            for layer in LAYERS:
                is_on = layer.name in page.layers
                if layer.name in page.groups:
                    page.groups[layer.name].visible = is_on
                else:
                    page.groups[layer.name] = page.client.scene.add_frame(
                        layer.node, show_axes=False, visible=is_on
                    )
        page.client.flush()

    def _apply_camera(self, page: _Page) -> None:
        if page.client is None or page.camera is None:
            return
        wanted, page.camera = page.camera, None
        with page.client.atomic():
            seen = page.client.camera
            seen.fov = wanted.field_of_view_rad
            seen.near = wanted.near_m
            seen.far = wanted.far_m
            # viser carries what it looks at along with the position, so that comes after it.
            seen.up_direction = np.array(wanted.up)
            seen.position = np.array(wanted.position_m)
            seen.look_at = np.array(wanted.look_at_m)
        page.client.flush()

    def _tell_wanted(self) -> None:
        connected = [page.layers for page in self._pages.values() if page.client is not None]
        wanted = frozenset[str]().union(*connected)
        if wanted != self._wanted:
            self._wanted = wanted
            self._want(wanted)
