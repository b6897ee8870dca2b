"""Passing a page's websocket on to the viser server."""

import asyncio
from collections.abc import Coroutine
from contextlib import suppress
from typing import Any

from starlette.exceptions import WebSocketException
from starlette.websockets import WebSocket, WebSocketDisconnect, WebSocketState
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed, InvalidHandshake
from websockets.typing import Subprotocol

from app.viser_server import PAGE_HEADER, SECRET_HEADER, ViserAddress


async def relay(page: WebSocket, viewport: ViserAddress, *, name: str = "") -> None:
    """Carry messages between the page and the viser server until either hangs up.

    Args:
        page: its websocket.
        viewport: where viser listens.
        name: that the page gave itself, in plain letters.

    Raises:
        WebSocketException: the page sent text, which viser's client never does.
    """
    if viewport.subprotocol not in page.scope.get("subprotocols", ()):
        await page.close(1002, f"The viewport speaks {viewport.subprotocol}; reload the page.")
        return
    with suppress(ConnectionClosed, InvalidHandshake, OSError, WebSocketDisconnect):
        async with connect(
            viewport.url,
            subprotocols=[Subprotocol(viewport.subprotocol)],
            additional_headers={SECRET_HEADER: viewport.secret, PAGE_HEADER: name},
            compression=None,
            max_size=None,
            proxy=None,
        ) as viser:
            await page.accept(subprotocol=viewport.subprotocol)
            await first_to_end(_to_viser(page, viser), _to_page(viser, page))
    if page.client_state == WebSocketState.CONNECTED:
        with suppress(RuntimeError):  # it has hung up in the meantime
            await page.close(1012)


async def first_to_end(*activities: Coroutine[Any, Any, None]) -> None:
    """Run activities side by side; when one ends, stop the others and raise what it raised."""
    tasks = [asyncio.create_task(activity) for activity in activities]
    try:
        done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
    for task in done:
        task.result()


async def _to_viser(page: WebSocket, viser: ClientConnection) -> None:
    while (message := await page.receive())["type"] != "websocket.disconnect":
        if message.get("bytes") is None:
            raise WebSocketException(1003, "The viewport takes binary messages only.")
        await viser.send(message["bytes"])


async def _to_page(viser: ClientConnection, page: WebSocket) -> None:
    async for message in viser:
        await page.send_bytes(message if isinstance(message, bytes) else message.encode())
