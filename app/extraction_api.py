"""The JSON interface for detecting the target in all frames anew."""

from dataclasses import replace
from typing import Any

from fastapi import APIRouter
from pydantic import Field

from app.api import Stream, state_of
from app.editing_api import Body, refusing
from core.analysis.analysis import Analysis
from core.analysis.extracting import extracted_again

router = APIRouter(prefix="/api")


class ExtractionOrder(Body):
    """By which settings to detect anew; what is not given stays as it is."""

    a1: float | None = Field(default=None, gt=0, le=100, allow_inf_nan=False)
    a2: float | None = Field(default=None, gt=0, le=1000, allow_inf_nan=False)
    closing_px: int | None = Field(default=None, ge=0, le=99)
    overwrites_edited: bool = Field(default=False, description="Outlines edited by hand too.")
    only_counts: bool = Field(default=False, description="Change nothing, tell what would.")


FIELDS = {"a1": "censoring_factor", "a2": "detection_factor", "closing_px": "closing_px"}


@router.post("/extraction")
def extract(order: ExtractionOrder, stream: Stream) -> dict[str, Any]:
    """Take the outlines of all frames from their images anew, as one step that can be undone.

    Returns the numbers of the frames that change, of the edited ones that keep their outline, and
    the state.
    """
    given = {
        name: value for key, name in FIELDS.items() if (value := getattr(order, key)) is not None
    }
    snapshot = stream.snapshot
    frames = [record.analysed for record in snapshot.records]
    extraction = replace(snapshot.settings.extraction, **given)
    overwrites = order.overwrites_edited
    with refusing():
        if order.only_counts:
            found = extracted_again(frames, extraction, overwrites_edited=overwrites)
            return {"changed": sorted(found.outlines), "kept": found.kept, "state": None}
        changed: list[int] = []
        kept: list[int] = []

        def extract_all(analysis: Analysis) -> None:
            done = analysis.extract_again(extraction, overwrites_edited=overwrites)
            changed.extend(frame.number for frame in done)
            kept.extend(f.number for f in analysis.frames if f.history.is_edited)

        stream.edit(extract_all)
    return {"changed": changed, "kept": kept, "state": state_of(stream)}


@router.post("/extraction/undo")
def undo_extraction(stream: Stream) -> dict[str, Any]:
    """Take the last detection in all frames back; frames that were edited since stay."""
    changed: list[int] = []
    with refusing():
        stream.edit(lambda analysis: changed.extend(f.number for f in analysis.undo_extraction()))
    return {"changed": changed, "kept": [], "state": state_of(stream)}
