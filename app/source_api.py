"""The JSON interface for loading another source: the demo, or a pass file that somebody sends."""

import json
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated, Any, BinaryIO

from fastapi import APIRouter, HTTPException, Query, Request
from starlette.concurrency import run_in_threadpool
from starlette.requests import ClientDisconnect

from app.api import Stream, state_of
from app.gate import LARGEST_UPLOADS_BYTES
from app.source import Source
from app.sources import demo_source, pass_source
from core.formats.files import reason

router = APIRouter(prefix="/api")

LARGEST_PASS_BYTES = LARGEST_UPLOADS_BYTES["/api/source"]

LARGEST_ORDER_BYTES = 1024

PIECE_BYTES = 1024 * 1024
"""Written at a time, in a thread: a disk may be slow."""

SPARE_BYTES = 256 * 1024 * 1024
"""That an upload leaves free on the disk for everybody else."""


@router.post("/source")
async def load_source(
    request: Request,
    stream: Stream,
    name: Annotated[str, Query(max_length=400, description="What to call an uploaded file.")] = "",
) -> dict[str, Any]:
    """Play another source: {"demo": true}, or a pass file as the body (application/octet-stream).

    The frames of the present source and their edits are gone then. A file that cannot be played
    leaves everything as it was.
    """
    kind = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    if kind == "application/octet-stream":
        source = await _uploaded(request, shown_name(name))
    elif kind == "application/json":
        source = await _ordered(request)
    else:
        raise HTTPException(
            415,
            "A source comes as application/octet-stream (a pass file) or as application/json; "
            f'got "{kind}".',
        )
    await run_in_threadpool(stream.load, source)
    return state_of(stream)


def shown_name(name: str) -> str:
    """Return what to call a file that somebody else named; it is never opened by that name."""
    plain = "".join(letter for letter in name if letter.isprintable())
    last = plain.replace("\\", "/").rstrip("/").rpartition("/")[2].strip()
    return last[:80] or "uploaded pass"


async def _ordered(request: Request) -> Source:
    body = b""
    async for piece in request.stream():
        body += piece
        if len(body) > LARGEST_ORDER_BYTES:
            break
    try:
        order = json.loads(body)
    except ValueError:
        order = None
    if order != {"demo": True} or order["demo"] is not True:
        raise HTTPException(422, 'The only source to be had by name is {"demo": true}.')
    return demo_source()


async def _uploaded(request: Request, name: str) -> Source:
    with _only_one(request), TemporaryDirectory(prefix="radarhull-") as folder:
        path = Path(folder) / "pass.h5"
        await _receive(request, path)
        try:
            source = await run_in_threadpool(pass_source, path)
        except ValueError as error:
            sentence = str(error).replace(str(path), name).replace(path.name, name)
            raise HTTPException(422, sentence) from error
        # All of it is in memory by now, so that the file may go.
        return replace(source, name=name)


@contextmanager
def _only_one(request: Request) -> Iterator[None]:
    """Take in one file at a time: two would fill the disk past what each finds free."""
    app_state = request.app.state
    if getattr(app_state, "is_taking_a_pass", False):
        raise HTTPException(409, "Another pass file is being loaded; wait until it is there.")
    app_state.is_taking_a_pass = True
    try:
        yield
    finally:
        app_state.is_taking_a_pass = False


async def _receive(request: Request, path: Path) -> None:
    """Write the body to a file as it comes."""
    _check_space(path.parent, int(request.headers.get("content-length", "0")))
    try:
        with path.open("wb") as file:
            received = await _write(request, file, path.parent)
    except ClientDisconnect as error:
        raise HTTPException(
            400, f"The upload ended early, or holds more than {LARGEST_PASS_BYTES} bytes."
        ) from error
    except OSError as error:
        raise HTTPException(507, f"The pass file could not be kept: {reason(error)}.") from error
    if received == 0:
        raise HTTPException(422, "The pass file is empty; 0 bytes came.")


async def _write(request: Request, file: BinaryIO, folder: Path) -> int:
    received, waiting = 0, bytearray()
    async for piece in request.stream():
        waiting += piece
        if len(waiting) >= PIECE_BYTES:
            _check_space(folder, len(waiting))
            received += await run_in_threadpool(file.write, bytes(waiting))
            waiting.clear()
    return received + await run_in_threadpool(file.write, bytes(waiting))


def _check_space(folder: Path, wanted_bytes: int) -> None:
    free_bytes = shutil.disk_usage(folder).free
    if free_bytes < wanted_bytes + SPARE_BYTES:
        raise HTTPException(
            507,
            f"The disk has {max(0, free_bytes - SPARE_BYTES) / 1e6:.0f} MB left for uploads, and "
            f"{wanted_bytes / 1e6:.1f} MB more are needed; free some space.",
        )
