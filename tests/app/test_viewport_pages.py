from collections.abc import Callable, Iterator

import msgspec
import numpy as np
import pytest
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Subprotocol

from app.camera import VIEWS
from app.layers import FIRST_LAYERS
from app.viewport_pages import MOST_REMEMBERED, ViewportPages
from app.viser_server import PAGE_HEADER, SECRET_HEADER, PrivateViserServer

FAR = VIEWS["+x"].camera(24.0, 1.0, None)


@pytest.fixture
def server() -> Iterator[PrivateViserServer]:
    server = PrivateViserServer()
    yield server
    server.stop()


@pytest.fixture
def wanted() -> list[frozenset[str]]:
    return []


@pytest.fixture
def pages(server, wanted) -> ViewportPages:
    return ViewportPages(server, wanted.append)


CAMERA_MESSAGE = {
    "type": "ViewerCameraMessage",
    "wxyz": (0.5, 0.5, 0.5, 0.5),
    "position": (0.0, -40.0, 0.0),
    "fov": 0.6,
    "near": 0.4,
    "far": 800.0,
    "image_height": 600,
    "image_width": 300,
    "look_at": (0.0, 0.0, 0.0),
    "up_direction": (0.0, 0.0, -1.0),
}
"""What viser's client says first."""


@pytest.fixture
def open_view(server, pages, wait_for) -> Iterator[Callable[[str], ClientConnection]]:
    """Return a function that connects a page's viser client, as the relay does."""
    links = []

    def opened(page: str) -> ClientConnection:
        address, before = server.address, len(server.get_clients())
        link = connect(
            address.url,
            subprotocols=[Subprotocol(address.subprotocol)],
            additional_headers={SECRET_HEADER: address.secret, PAGE_HEADER: page},
            max_size=None,
        )
        links.append(link)
        link.send(msgspec.msgpack.encode(CAMERA_MESSAGE))
        wait_for(lambda: len(server.get_clients()) > before)
        # viser lists a client before those who wait for one have put their nodes into it.
        wait_for(lambda: node(server, page, "wireframe") is not None)
        return link

    yield opened
    for link in links:
        link.close()


def client_of(server: PrivateViserServer, page: str):
    return next(c for c in server.get_clients().values() if server.page_of(c) == page)


def node(server: PrivateViserServer, page: str, layer: str):
    return client_of(server, page).scene.get_handle_by_name(f"/{layer}")


def shown(server: PrivateViserServer, page: str, layer: str) -> bool:
    """Whether the node that only this page's client has shows a layer."""
    return node(server, page, layer).visible


def test_each_page_has_its_own_layers(server, pages, wanted, open_view, wait_for) -> None:
    open_view("one")
    open_view("two")
    wait_for(lambda: wanted == [FIRST_LAYERS])
    pages.show_layers("one", frozenset({"hull", "wireframe"}))
    assert shown(server, "one", "wireframe")
    assert not shown(server, "one", "grid")
    assert not shown(server, "two", "wireframe")
    assert shown(server, "two", "grid")
    assert wanted[-1] == FIRST_LAYERS | {"wireframe"}
    assert pages.layers("two") == FIRST_LAYERS


def test_nobody_wants_what_only_a_closed_page_showed(pages, wanted, open_view, wait_for) -> None:
    link = open_view("one")
    pages.show_layers("one", frozenset({"uncarved"}))
    assert wanted[-1] == {"uncarved"}
    link.close()
    wait_for(lambda: wanted[-1] == frozenset())
    assert pages.layers("one") == {"uncarved"}


def test_a_camera_moves_on_its_own_page_only(server, pages, open_view) -> None:
    open_view("one")
    open_view("two")
    pages.move_camera("one", FAR)
    np.testing.assert_allclose(pages.camera("one").position_m, FAR.position_m)
    assert pages.camera("one").field_of_view_rad == FAR.field_of_view_rad
    assert client_of(server, "one").camera.near == FAR.near_m
    np.testing.assert_allclose(pages.camera("two").position_m, [0, -40, 0])
    assert pages.aspect("two") == 0.5


def test_what_is_set_before_the_view_has_connected_is_done_when_it_comes(
    server, pages, open_view, wait_for
) -> None:
    pages.show_layers("one", frozenset({"reference"}))
    pages.move_camera("one", FAR)
    np.testing.assert_allclose(pages.camera("one").position_m, FAR.position_m)
    open_view("one")
    wait_for(lambda: np.allclose(client_of(server, "one").camera.position, FAR.position_m))
    assert shown(server, "one", "reference")
    assert not shown(server, "one", "hull")


def test_a_page_that_nobody_has_opened_is_seen_from_nowhere(pages) -> None:
    assert pages.camera("one") is None
    assert pages.aspect("one") == 1.0
    assert pages.layers("one") == FIRST_LAYERS


def test_pages_are_not_remembered_for_ever(pages) -> None:
    for number in range(MOST_REMEMBERED + 5):
        pages.show_layers(f"page-{number}", frozenset())
    assert pages.layers("page-0") == FIRST_LAYERS
    assert pages.layers(f"page-{MOST_REMEMBERED + 4}") == frozenset()
