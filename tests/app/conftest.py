import time
from collections.abc import Callable, Iterator
from socket import create_connection
from typing import Any

import httpx
import pytest
from websockets.sync.client import connect

from app.playback import Playback
from tests.app.running import running
from tests.app.synthetic import SETTINGS, source


@pytest.fixture
def wait_for() -> Callable[..., Any]:
    """Return a function that waits until a condition holds, and returns what it gave."""

    def wait(condition: Callable[[], Any], timeout_s: float = 20.0) -> Any:
        deadline = time.monotonic() + timeout_s
        while not (value := condition()):
            assert time.monotonic() < deadline, "the condition did not come true"
            time.sleep(0.01)
        return value

    return wait


@pytest.fixture(scope="session")
def client() -> Iterator[httpx.Client]:
    """A client of a running workstation whose four frames have all arrived."""
    with (
        running(source(4), SETTINGS, Playback(speed_hz=None)) as address,
        httpx.Client(base_url=address, trust_env=False) as client,
    ):
        for _ in range(1000):
            if client.get("/api/state").json()["status"] == "finished":
                break
            time.sleep(0.02)
        yield client


@pytest.fixture
def link(client: httpx.Client) -> Callable[..., Any]:
    """Return a function that opens a websocket, as browsers do from `host` and `origin`."""

    def open_link(
        path: str, *, origin: str | None = None, host: str | None = None, **more: Any
    ) -> Any:
        netloc = f"127.0.0.1:{client.base_url.port}"
        socket = create_connection(("127.0.0.1", client.base_url.port))
        return connect(f"ws://{host or netloc}{path}", sock=socket, origin=origin, **more)

    return open_link
