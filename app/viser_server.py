"""A viser server that nobody but our relay can talk to.

viser 1.1.1 has no authentication, takes any Origin, and opens a public tunnel when a client asks.
"""

import secrets
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import rich
import viser

SECRET_HEADER = "X-Radarhull-Relay"  # noqa: S105 - the header's name, not a secret

PAGE_HEADER = "X-Radarhull-Page"
"""Names the page whose client it is, so that its camera and layers can be set without others'."""


@dataclass(frozen=True, slots=True)
class ViserAddress:
    """Where the relay finds the viser server, and how it proves that it is the relay."""

    url: str
    secret: str
    subprotocol: str


class PrivateViserServer(viser.ViserServer):
    """A viser server on a free loopback port that closes connections without our secret."""

    def __init__(self) -> None:
        """Start listening; nothing is printed."""
        self._secret = secrets.token_urlsafe(32)
        self._page_of: dict[int, str] = {}
        with _quiet_console():
            super().__init__(host="127.0.0.1", port=0, verbose=False)
        self._websock_server.on_client_connect(self._admit)
        self._websock_server.on_client_disconnect(self._forget)

    @property
    def address(self) -> ViserAddress:
        """What the relay needs to connect."""
        return ViserAddress(
            url=f"ws://127.0.0.1:{self.get_port()}/",
            secret=self._secret,
            subprotocol=f"viser-v{viser.__version__}",
        )

    def page_of(self, client: viser.ClientHandle) -> str:
        """Return the name of the page that a client belongs to, empty where it gave none."""
        return self._page_of.get(client.client_id, "")

    def request_share_url(self, verbose: bool = True) -> None:
        """Open no tunnel: a page that asks for a public address gets none."""

    def stop(self) -> None:
        """Stop the server and its threads; nothing is printed."""
        with _quiet_console():
            super().stop()

    async def _admit(self, connection: Any) -> None:
        # viser gives no hook that sees the request, so its own table of sockets is asked; this
        # runs before the first message is sent. A test holds viser's pinned version to it.
        socket = self._websock_server._live_connections[connection.client_id]
        headers = {} if socket.request is None else socket.request.headers
        shown = headers.get(SECRET_HEADER, "")
        if secrets.compare_digest(shown.encode(), self._secret.encode()):
            self._page_of[connection.client_id] = headers.get(PAGE_HEADER, "")
        else:
            await socket.close(1008, "Open the workstation's own page instead.")

    async def _forget(self, connection: Any) -> None:
        self._page_of.pop(connection.client_id, None)


@contextmanager
def _quiet_console() -> Iterator[None]:
    """Keep viser's banner, which `verbose=False` does not silence, off the terminal."""
    console = rich.get_console()
    before, console.quiet = console.quiet, True
    try:
        yield
    finally:
        console.quiet = before
