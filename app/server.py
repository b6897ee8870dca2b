"""Serving the workstation: one page on one port, until Ctrl+C."""

import errno
import logging
import socket
import webbrowser
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import trimesh
import uvicorn
from fastapi import FastAPI

from app.compilation import compiling
from app.gate import LOOPBACK_NAMES
from app.measuring import MeasurementDesk
from app.playback import DEFAULT_SPEED_HZ, Playback
from app.source import Source
from app.stream import LiveStream, SurfaceOf
from app.uncarved import UncarvedWatch
from app.viewport import Viewport
from app.viewport_pages import ViewportPages
from app.viser_server import PrivateViserServer
from app.web import create_app
from core.hull.volume import VoteVolume
from core.reconstruction import ReconstructionSettings

DEFAULT_PORT = 8370

LARGEST_MESSAGE_BYTES = 1024 * 1024
"""That a page may send over a websocket: viser's client sends camera poses, a few hundred bytes."""


def serve(
    source: Source,
    *,
    host: str = "127.0.0.1",
    port: int = DEFAULT_PORT,
    open_browser: bool = False,
    settings: ReconstructionSettings | None = None,
    speed_hz: float | None = DEFAULT_SPEED_HZ,
    reference: trimesh.Trimesh | None = None,
) -> None:
    """Show the reconstruction of `source` in a browser until SIGINT or SIGTERM.

    Prints the page's address once it can be opened.

    Args:
        source: the frames to play.
        host: a loopback address.
        port: 0 for any free one.
        open_browser: whether to open the page in the user's browser.
        settings: how the hull is reconstructed.
        speed_hz: frames per second to start with, None for as fast as they are computed.
        reference: a mesh in metres of the target frame, to look at beside the hull.

    Raises:
        ValueError: the host is not a loopback address, the port is in use or forbidden, or the
            speed is out of range.
    """
    playback = Playback(speed_hz=speed_hz)
    with listening_socket(host, port) as listener:
        address = _address(host, listener.getsockname()[1])

        def announce() -> None:
            print(f"radarhull is ready at {address}", flush=True)
            if open_browser:
                webbrowser.open(address)

        with (
            compiling() as compilation,
            workstation(
                source,
                settings,
                playback=playback,
                surface_of=compilation.surface_of,
                reference=reference,
            ) as app,
        ):
            WorkstationServer(app, announce).run(sockets=[listener])


@contextmanager
def workstation(
    source: Source,
    settings: ReconstructionSettings | None = None,
    *,
    playback: Playback | None = None,
    surface_of: SurfaceOf = VoteVolume.surface,
    reference: trimesh.Trimesh | None = None,
) -> Iterator[FastAPI]:
    """Run the live loop and the viewport, and give the application that shows them."""
    stream = LiveStream(source, settings, playback=playback, surface_of=surface_of)
    viser_server = PrivateViserServer()
    viewport = Viewport(viser_server, reference=reference)
    uncarved = UncarvedWatch(lambda: stream.volume, viewport.show_uncarved)
    desk = MeasurementDesk(stream)

    def want(layers: frozenset[str]) -> None:
        viewport.want(layers)
        uncarved.want("uncarved" in layers)

    pages = ViewportPages(viser_server, want, has_reference=reference is not None)
    try:
        app = create_app(stream, viser_server.address, pages, desk)
        stream.observe(viewport.show)
        stream.observe(uncarved.note)
        stream.observe(desk.note)
        stream.start()
        desk.start()
        yield app
    finally:
        desk.stop()
        uncarved.stop()
        stream.stop()
        viser_server.stop()


class WorkstationServer(uvicorn.Server):
    """uvicorn that announces itself, and for which Ctrl+C is a normal end."""

    def __init__(self, app: FastAPI, announce: Callable[[], None]) -> None:
        """Serve `app`, and call `announce` once it can be reached."""
        super().__init__(_uvicorn_config(app))
        self._announce = announce

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Start, then announce."""
        await super().startup(sockets)
        if self.started:
            self._announce()

    @contextmanager
    def capture_signals(self) -> Iterator[None]:
        """Take SIGINT and SIGTERM as orders to end."""
        # uvicorn raises the signals it caught again after it has shut down, which would end the
        # process with a traceback or by the signal; they have been obeyed by then.
        with super().capture_signals():
            yield
            self._captured_signals.clear()


def _uvicorn_config(app: FastAPI) -> uvicorn.Config:
    logging.getLogger("uvicorn.error").setLevel(logging.WARNING)
    return uvicorn.Config(
        app,
        log_config=None,
        access_log=False,
        server_header=False,
        lifespan="off",
        ws="websockets-sansio",
        ws_max_size=LARGEST_MESSAGE_BYTES,
        ws_per_message_deflate=False,
        timeout_graceful_shutdown=3,
    )


@contextmanager
def listening_socket(host: str, port: int) -> Iterator[socket.socket]:
    """Bind before anything else starts, so that a port in use costs nobody any time."""
    _check_loopback(host)
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    listener = socket.socket(family, socket.SOCK_STREAM)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        try:
            listener.bind((host, port))
            listener.listen()
        except (OSError, OverflowError) as error:
            raise ValueError(_why_not_bound(host, port, error)) from error
        yield listener
    finally:
        listener.close()


def _check_loopback(host: str) -> None:
    if host not in LOOPBACK_NAMES:
        raise ValueError(
            f"The workstation listens on this machine only, at {', '.join(sorted(LOOPBACK_NAMES))};"
            f" got {host}. From elsewhere, reach it through an SSH tunnel."
        )


def _why_not_bound(host: str, port: int, error: OSError | OverflowError) -> str:
    number = error.errno if isinstance(error, OSError) else None
    if number == errno.EADDRINUSE:
        return f"Port {port} of {host} is in use; stop the program that holds it or take another."
    if number == errno.EACCES:
        return f"Port {port} needs administrator rights; take one from 1024 to 65535."
    return f"Port {port} of {host} cannot be used ({error}); take one from 1024 to 65535, or 0."


def _address(host: str, port: int) -> str:
    return f"http://[{host}]:{port}/" if ":" in host else f"http://{host}:{port}/"
