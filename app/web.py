"""The web application: the page, its interface, and the viewport under one origin."""

from collections.abc import Iterable
from pathlib import Path

from fastapi import FastAPI, Request, WebSocket
from fastapi.exceptions import RequestValidationError
from fastapi.responses import HTMLResponse, JSONResponse, RedirectResponse
from starlette.exceptions import HTTPException
from starlette.staticfiles import StaticFiles

from app import (
    api,
    course_api,
    editing_api,
    export_api,
    extraction_api,
    silhouettes_api,
    source_api,
    thumbnails_api,
    viewport_api,
)
from app.changes import Changes
from app.gate import LOOPBACK_NAMES, Gate
from app.measuring import MeasurementDesk
from app.relay import relay
from app.stream import LiveStream
from app.thumbnails import Thumbnails
from app.viewport_api import PageName
from app.viewport_page import viewport_page
from app.viewport_pages import ViewportPages
from app.viser_server import ViserAddress


def create_app(
    stream: LiveStream,
    viewport: ViserAddress,
    pages: ViewportPages,
    desk: MeasurementDesk,
    *,
    host_names: Iterable[str] = LOOPBACK_NAMES,
) -> FastAPI:
    """Return the application that shows `stream`, with the viser server at `viewport` in it.

    Args:
        stream: the live loop; whoever made it starts and stops it.
        viewport: where viser listens.
        pages: whose cameras and layers can be set.
        desk: at which the hull is measured; whoever made it starts and stops it.
        host_names: names under which browsers may address the server.
    """
    app = FastAPI(title="radarhull", docs_url=None, redoc_url=None, openapi_url="/openapi.json")
    app.state.stream = stream
    app.state.changes = Changes()
    app.state.thumbnails = Thumbnails()
    stream.observe(lambda _: app.state.changes.notify())
    app.state.viewport_pages = pages
    app.state.desk = desk
    desk.observe(lambda _: app.state.changes.notify())
    for part in (
        api,
        course_api,
        editing_api,
        export_api,
        extraction_api,
        silhouettes_api,
        source_api,
        thumbnails_api,
        viewport_api,
    ):
        app.include_router(part.router)
    _add_viewport(app, viewport)
    app.mount("/", StaticFiles(directory=static_folder(), html=True), name="static")
    app.add_exception_handler(RequestValidationError, _explain_invalid)
    app.add_exception_handler(HTTPException, _explain_refused)
    app.add_middleware(Gate, host_names=frozenset(host_names))
    return app


def static_folder() -> Path:
    """Return the folder of the page's files, in an installed package or the source tree.

    Raises:
        FileNotFoundError: neither holds them.
    """
    package = Path(__file__).resolve().parent
    for folder in (package / "static", package.parent / "static"):
        if (folder / "index.html").is_file():
            return folder
    raise FileNotFoundError(
        f"The page's files are missing: neither {package / 'static'} nor "
        f"{package.parent / 'static'} holds an index.html. Install radarhull again."
    )


def _add_viewport(app: FastAPI, viewport: ViserAddress) -> None:
    page = viewport_page()
    headers = {"Content-Security-Policy": page.content_security_policy}

    @app.get("/viewport/", include_in_schema=False)
    @app.get("/viewport/{name}/", include_in_schema=False)
    def viewport_client() -> HTMLResponse:
        return HTMLResponse(page.html, headers=headers)

    @app.get("/viewport", include_in_schema=False)
    def viewport_folder() -> RedirectResponse:
        return RedirectResponse("/viewport/")

    # viser's client drops the slash from its page's address to find its websocket, but keeps the
    # name before it: that tells whose client it is.
    @app.websocket("/viewport")
    async def viewport_socket(socket: WebSocket) -> None:
        await relay(socket, viewport)

    @app.websocket("/viewport/{name}")
    async def named_viewport_socket(socket: WebSocket, name: PageName) -> None:
        await relay(socket, viewport, name=name)


def _explain_invalid(_: Request, error: Exception) -> JSONResponse:
    assert isinstance(error, RequestValidationError)
    first = error.errors()[0]
    place = " → ".join(str(part) for part in first["loc"])
    sentence = f"The request is not understood: {place}: {first['msg']}."
    return JSONResponse({"detail": sentence}, status_code=422)


def _explain_refused(request: Request, error: Exception) -> JSONResponse:
    assert isinstance(error, HTTPException)
    plain = {
        404: f"There is nothing at {request.url.path}.",
        405: f"{request.method} is not possible at {request.url.path}.",
    }
    is_standard = error.detail in ("Not Found", "Method Not Allowed")
    detail = plain[error.status_code] if is_standard else error.detail
    return JSONResponse({"detail": detail}, status_code=error.status_code, headers=error.headers)
