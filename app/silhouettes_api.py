"""The JSON interface for outlines from annotation tools: a file of them becomes edits."""

from typing import Annotated

import numpy as np
from fastapi import APIRouter, HTTPException, Query, Request
from starlette.concurrency import run_in_threadpool
from starlette.requests import ClientDisconnect

from app.api import Stream
from app.components import checked_label
from app.gate import LARGEST_UPLOADS_BYTES
from app.source_api import shown_name
from app.stream import LiveStream
from core.analysis.analysis import Analysis
from core.analysis.frames import AnalysedFrame
from core.analysis.history import Outlined
from core.formats.annotation import Annotation
from core.formats.annotations import read_annotations
from core.hull.drawing import drawn_silhouette
from core.silhouettes.silhouette import WHOLE, Silhouette

router = APIRouter(prefix="/api")

LARGEST_FILE_BYTES = LARGEST_UPLOADS_BYTES["/api/silhouettes"]

TOOL = "import"

SAME_PX = 1e-6
"""Vertices that moved by less have come through a file unchanged."""


@router.post("/silhouettes")
async def import_silhouettes(
    request: Request,
    stream: Stream,
    name: Annotated[str, Query(max_length=400, description="Of the file.")] = "",
) -> dict[str, list[int]]:
    """Take the outlines of a COCO file, a labelme file, a PNG mask or a ZIP of them as edits.

    All or none: an outline of a frame that has not arrived, of another size, or that cannot vote
    is refused, and then nothing changes. Each frame's import can be undone by itself. Returns the
    numbers of the frames that have changed, and of those whose outline was the file's already.
    """
    try:
        content = b"".join([piece async for piece in request.stream()])
    except ClientDisconnect as error:
        raise HTTPException(
            413, f"The upload ended early, or holds more than {LARGEST_FILE_BYTES} bytes."
        ) from error
    try:
        return await run_in_threadpool(_imported, stream, content, shown_name(name))
    except ValueError as error:
        raise HTTPException(422, str(error)) from error


def _imported(stream: LiveStream, content: bytes, name: str) -> dict[str, list[int]]:
    annotations = read_annotations(content, name)
    outlines: list[tuple[int, Outlined]] = []

    def take_over(analysis: Analysis) -> None:
        for annotation in annotations:
            frame = analysis.frame(annotation.number)
            outlined = _outlined(annotation, frame, name)
            present = frame.layer(outlined.silhouette.component).silhouette
            if not _is_same(outlined.silhouette, present, is_mask=annotation.is_mask):
                outlines.append((annotation.number, outlined))
        analysis.commit_all(outlines, tool="import")

    stream.edit(take_over)
    changed = dict.fromkeys(number for number, _ in outlines)
    named = dict.fromkeys(each.number for each in annotations)
    return {
        "changed": list(changed),
        "unchanged": [number for number in named if number not in changed],
    }


def _outlined(annotation: Annotation, frame: AnalysedFrame, name: str) -> Outlined:
    present = frame.layer(checked_label(annotation.component or WHOLE)).silhouette
    if annotation.image_shape != present.image_shape:
        rows, columns = annotation.image_shape
        raise ValueError(
            f"Frame {frame.number} has {present.image_shape[0]} × {present.image_shape[1]} pixels, "
            f"its image in {name} {rows} × {columns}; export the outlines from here and edit those."
        )
    try:
        silhouette, repair = drawn_silhouette(
            annotation.rings,
            image_shape=present.image_shape,
            claim=annotation.claim or present.claim,
            component=present.component,
            provenance=f"imported from {name}",
        )
    except ValueError as error:
        raise ValueError(f"Frame {frame.number} in {name}: {error}") from error
    return Outlined(silhouette=silhouette, tool=TOOL, repair=repair)


def _is_same(one: Silhouette, other: Silhouette, *, is_mask: bool) -> bool:
    """Whether an outline is another as far as the file that it came from can tell."""
    if is_mask:
        return np.array_equal(one.mask(), other.mask())
    if (one.claim, one.component) != (other.claim, other.component):
        return False
    return len(one.rings) == len(other.rings) and all(
        a.shape == b.shape and np.allclose(a, b, rtol=0, atol=SAME_PX)
        for a, b in zip(one.rings, other.rings, strict=True)
    )
