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
        with _quiet_console():
            super().__init__(host="127.0.0.1", port=0, verbose=False)
        self._websock_server.on_client_connect(self._close_strangers)

    @property
    def address(self) -> ViserAddress:
        """What the relay needs to connect."""
        return ViserAddress(
            url=f"ws://127.0.0.1:{self.get_port()}/",
            secret=self._secret,
            subprotocol=f"viser-v{viser.__version__}",
        )

    def request_share_url(self, verbose: bool = True) -> None:
        """Open no tunnel: a page that asks for a public address gets none."""

    def stop(self) -> None:
        """Stop the server and its threads; nothing is printed."""
        with _quiet_console():
            super().stop()

    async def _close_strangers(self, connection: Any) -> None:
        # viser gives no hook that sees the request, so its own table of sockets is asked; this
        # runs before the first message is sent. A test holds viser's pinned version to it.
        socket = self._websock_server._live_connections[connection.client_id]
        request = socket.request
        shown = "" if request is None else request.headers.get(SECRET_HEADER, "")
        if not secrets.compare_digest(shown.encode(), self._secret.encode()):
            await socket.close(1008, "Open the workstation's own page instead.")


@contextmanager
def _quiet_console() -> Iterator[None]:
    """Keep viser's banner, which `verbose=False` does not silence, off the terminal."""
    console = rich.get_console()
    before, console.quiet = console.quiet, True
    try:
        yield
    finally:
        console.quiet = before
