"""The interface for downloads: the hull and the outlines, as files."""

from collections.abc import Iterator

from fastapi import APIRouter, HTTPException
from fastapi.responses import StreamingResponse

from app.api import Stream
from app.export import EXPORTS, file_name

router = APIRouter(prefix="/api/export")

MEASUREMENT_FILES = ("measurements.csv", "measurements.json")
"""To be had under the same address; `app.measurements_api` writes them."""

PIECE_BYTES = 256 * 1024


# Not a coroutine: a large hull takes its time, in a thread of its own.
@router.get("/{what}")
def export(what: str, stream: Stream) -> StreamingResponse:
    """Return a file of the hull or the outlines as they stand now."""
    if what not in EXPORTS:
        known = ", ".join((*EXPORTS, *MEASUREMENT_FILES))
        raise HTTPException(404, f"There is no export {what}; there are {known}.")
    snapshot, source = stream.snapshot, stream.source
    try:
        content = EXPORTS[what].write(snapshot, source)
    except ValueError as error:
        raise HTTPException(409, str(error)) from error
    name = file_name(what, snapshot, source)
    return StreamingResponse(
        _pieces(content),
        media_type=EXPORTS[what].media_type,
        headers={
            "Content-Disposition": f'attachment; filename="{name}"',
            "Content-Length": str(len(content)),
            "Cache-Control": "no-store",
        },
    )


def _pieces(content: bytes) -> Iterator[bytes]:
    for start in range(0, len(content), PIECE_BYTES):
        yield content[start : start + PIECE_BYTES]
