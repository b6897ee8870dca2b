"""A workstation on a free port, in this process."""

import asyncio
import threading
from collections.abc import Coroutine, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from typing import Any, TypeVar

from app.playback import Playback
from app.reference import Reference
from app.server import WorkstationServer, listening_socket, workstation
from app.source import Source
from core.reconstruction import ReconstructionSettings

Result = TypeVar("Result")


@contextmanager
def running(
    source: Source,
    settings: ReconstructionSettings,
    playback: Playback,
    *,
    port: int = 0,
    reference: Reference | None = None,
) -> Iterator[str]:
    """Serve `source` and give the page's address, without the last slash."""
    ready = threading.Event()
    with (
        listening_socket("127.0.0.1", port) as listener,
        workstation(source, settings, playback=playback, reference=reference) as app,
    ):
        address = f"http://127.0.0.1:{listener.getsockname()[1]}"
        server = WorkstationServer(app, ready.set)
        thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]})
        thread.start()
        try:
            assert ready.wait(20), "the server did not start"
            yield address
        finally:
            server.should_exit = True
            thread.join(20)
            assert not thread.is_alive(), "the server did not end"


def awaited(coroutine: Coroutine[Any, Any, Result]) -> Result:
    """Run a coroutine in a thread of its own: Playwright's browser keeps this one's event loop."""
    with ThreadPoolExecutor(1) as pool:
        return pool.submit(asyncio.run, coroutine).result()
