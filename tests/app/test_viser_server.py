import asyncio
from collections.abc import Iterator

import pytest
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed

from app.viser_server import SECRET_HEADER, PrivateViserServer
from tests.app.running import awaited


@pytest.fixture
def server() -> Iterator[PrivateViserServer]:
    server = PrivateViserServer()
    yield server
    server.stop()


async def first_message(server: PrivateViserServer, secret: str | None) -> bytes | str:
    address = server.address
    headers = {} if secret is None else {SECRET_HEADER: secret}
    async with connect(
        address.url, subprotocols=[address.subprotocol], additional_headers=headers, proxy=None
    ) as socket:
        return await asyncio.wait_for(socket.recv(), 5)


def test_the_relay_is_answered(server: PrivateViserServer) -> None:
    assert len(awaited(first_message(server, server.address.secret))) > 0


@pytest.mark.parametrize("secret", [None, "", "guessed"])
def test_strangers_get_nothing(server: PrivateViserServer, secret: str | None) -> None:
    with pytest.raises(ConnectionClosed) as closed:
        awaited(first_message(server, secret))
    assert closed.value.rcvd.code == 1008


def test_it_listens_on_this_machine_only(server: PrivateViserServer) -> None:
    assert server.get_host() == "127.0.0.1"


def test_a_public_address_is_refused(server: PrivateViserServer, monkeypatch) -> None:
    opened = []
    monkeypatch.setattr("viser._viser.ViserTunnel", lambda *_: opened.append(True))
    assert server.request_share_url() is None
    assert opened == []


def test_nothing_is_printed(capfd) -> None:
    PrivateViserServer().stop()
    assert capfd.readouterr() == ("", "")
