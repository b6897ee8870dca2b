"""What every request passes first: who may ask, how much may be sent, what the browser may do."""

import json
import re
from collections.abc import Iterable

from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

LOOPBACK_NAMES = frozenset({"127.0.0.1", "localhost", "::1"})

LARGEST_BODY_BYTES = 1024 * 1024
"""An outline of 20,000 vertices, written with all their digits."""

LARGEST_UPLOADS_BYTES = {
    "/api/source": 2 * 2**30,
    "/api/silhouettes": 64 * 2**20,
    "/api/measurements/import": 16 * 2**20,
}
"""What these paths may be sent instead: files, which they take in piece by piece."""

PAGE_POLICY = "; ".join(
    [
        "default-src 'none'",
        "script-src 'self'",
        "style-src 'self'",
        "img-src 'self' data:",
        "connect-src 'self'",
        "frame-src 'self'",
        "base-uri 'none'",
        "form-action 'none'",
        "frame-ancestors 'none'",
    ]
)

_HOST = re.compile(r"(?P<name>[a-z0-9.-]+|\[[0-9a-f:.]+\])(:[0-9]{1,5})?")

_HEADERS = {
    "Content-Security-Policy": PAGE_POLICY,
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cache-Control": "no-cache",
}


class Gate:
    """ASGI middleware that lets only our own page's requests through.

    A web page elsewhere can make a browser send requests here; its Origin gives it away. A name
    that its owner points at 127.0.0.1 makes that page look like ours; the Host gives it away.
    """

    def __init__(self, app: ASGIApp, host_names: Iterable[str] = LOOPBACK_NAMES) -> None:
        """Guard `app`, which may be addressed by `host_names` only."""
        self._app = app
        self._host_names = frozenset(name.lower() for name in host_names)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a refused request, hand on any other."""
        if scope["type"] == "lifespan":
            await self._app(scope, receive, send)
            return
        most_bytes = LARGEST_UPLOADS_BYTES.get(scope.get("path", ""), LARGEST_BODY_BYTES)
        status, sentence = _refusal(Headers(scope=scope), self._host_names, most_bytes)
        if sentence:
            await _refuse(scope, receive, send, status, sentence)
        elif scope["type"] == "websocket":
            await self._app(scope, receive, send)
        else:
            await self._app(scope, _limited(receive, most_bytes), _with_headers(send))


def _refusal(headers: Headers, host_names: frozenset[str], most_bytes: int) -> tuple[int, str]:
    # A second Host or Origin shows in the joined text, which then is neither name nor origin.
    host = ", ".join(headers.getlist("host"))
    if _host_name(host) not in host_names:
        return 421, (
            f"This server answers to {', '.join(sorted(host_names))}, not to {_short(host)!r}; "
            "open the address that it printed."
        )
    origin = ", ".join(headers.getlist("origin"))
    if "origin" in headers and not _is_own(origin, host):
        return 403, (
            f"Requests from {_short(origin)} are refused; only this server's own page may ask."
        )
    length = headers.get("content-length", "0")
    if not _is_allowed(length, most_bytes):
        return 413, (
            f"The request's body may hold at most {most_bytes} bytes; got {_short(length)}."
        )
    return 200, ""


def _host_name(host: str) -> str:
    """Return the name in a Host header, empty where it is not a plain name with or without port."""
    plain = _HOST.fullmatch(host.lower())
    return plain["name"].strip("[]") if plain else ""


def _is_own(origin: str, host: str) -> bool:
    return origin.lower() in (f"http://{host}".lower(), f"https://{host}".lower())


def _is_allowed(length: str, most_bytes: int) -> bool:
    digits = length.lstrip("0")
    is_number = length.isascii() and length.isdecimal()
    return is_number and len(digits) < 20 and int(digits or "0") <= most_bytes


def _short(text: str) -> str:
    return text if len(text) <= 80 else f"{text[:80]}…"


def _limited(receive: Receive, most_bytes: int = LARGEST_BODY_BYTES) -> Receive:
    """Return `receive` that ends a body which came without a length and grows too large."""
    received = 0

    async def limited() -> Message:
        nonlocal received
        message = await receive()
        received += len(message.get("body", b""))
        return {"type": "http.disconnect"} if received > most_bytes else message

    return limited


def _with_headers(send: Send) -> Send:
    async def with_headers(message: Message) -> None:
        if message["type"] == "http.response.start":
            headers = MutableHeaders(scope=message)
            for name, value in _HEADERS.items():
                headers.setdefault(name, value)
        await send(message)

    return with_headers


async def _refuse(scope: Scope, receive: Receive, send: Send, status: int, sentence: str) -> None:
    if scope["type"] == "websocket":
        await receive()
        await send({"type": "websocket.close", "code": 1008, "reason": sentence[:120]})
        return
    # Closing over an unread body would reset the connection before the sentence is read.
    limited = _limited(receive)
    while (await limited()).get("more_body", False):
        pass
    body = json.dumps({"detail": sentence}).encode()
    start = {
        "type": "http.response.start",
        "status": status,
        "headers": [
            (b"content-type", b"application/json"),
            (b"content-length", str(len(body)).encode()),
        ],
    }
    await _with_headers(send)(start)
    await send({"type": "http.response.body", "body": body})
