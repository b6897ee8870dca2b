"""Thumbnails over HTTP: a browser asks again whether one is still as it was, and mostly it is."""

import secrets
from typing import Annotated

from fastapi import APIRouter, Header, Request, Response

from app.api import Stream, record_at
from app.thumbnails import Thumbnails, key_of

router = APIRouter(prefix="/api")

_PROCESS = secrets.token_hex(4)
"""Another workstation on the same port has other frames under the same numbers."""


@router.get("/frames/{number}/thumbnail", response_class=Response)
def read_thumbnail(
    number: int,
    request: Request,
    stream: Stream,
    if_none_match: Annotated[str | None, Header()] = None,
) -> Response:
    """Return a small PNG picture of a frame with its outline, as both stand now."""
    run, record = stream.snapshot.run, record_at(stream, number)
    tag = f'"{_PROCESS}-{key_of(run, record)}"'
    headers = {"ETag": tag, "Cache-Control": "private, no-cache"}
    if if_none_match == tag:
        return Response(status_code=304, headers=headers)
    thumbnails: Thumbnails = request.app.state.thumbnails
    return Response(thumbnails.of(run, record), media_type="image/png", headers=headers)
