"""The JSON interface for editing: outlines, previews, undo, review states, proposals, carving."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Annotated, Any

from fastapi import APIRouter, HTTPException
from pydantic import BaseModel, ConfigDict, Field

from app.api import Stream, facts_of, record_at, state_of
from app.components import Component, checked_label
from app.proposals import TOOLS, Question, proposal, reprojected_rings
from core.analysis.analysis import Analysis
from core.analysis.frames import ReviewState
from core.analysis.history import NothingLeft, StaleRevision
from core.hull.drawing import MOST_RINGS, MOST_VERTICES, drawn_silhouette
from core.hull.shadow import CarvingRule, shadow_region
from core.silhouettes.editing.disagreement import disagreement
from core.silhouettes.silhouette import WHOLE, Claim, Silhouette

router = APIRouter(prefix="/api")

Ring = Annotated[list[tuple[float, float]], Field(max_length=MOST_VERTICES)]
Rings = Annotated[list[Ring], Field(max_length=MOST_RINGS)]

NOT_DRAWING = ("claim",)
"""Tools that leave the rings as they are, and so what is said of how these came to be."""

MOST_SIDE_M = 1000.0
MOST_VOXELS_A_SIDE = 640
"""That an interactive grid may have: 640³ is 260 million voxels."""


class Body(BaseModel):
    """A request's body; what it does not know it refuses."""

    model_config = ConfigDict(extra="forbid")


class OutlineOrder(Body):
    """An outline of a frame, as it was drawn."""

    rings: Rings = Field(description="Each a list of (row, column); none: shows no target.")
    claim: Claim
    component: str = Field(default=WHOLE, description="Label of what it outlines.")
    tool: str = Field(default="drawing", min_length=1, max_length=40)
    base_revision: int = Field(description="Of the outline that this one was made from.")


class StepOrder(Body):
    """Undo or redo."""

    component: str = Field(default=WHOLE, description="Label of whose outline.")
    base_revision: int


class StateOrder(Body):
    """How far the analyst is with a frame."""

    state: ReviewState


class ProposalOrder(Body):
    """What a tool shall propose."""

    tool: str = Field(max_length=40)
    component: str = Field(default=WHOLE, description="Label of what shall be outlined.")
    parameters: dict[str, Any] = {}
    rings: Rings | None = Field(default=None, description="The outline as it stands on the page.")


class CarvingOrder(Body):
    """How the hull shall be carved; what is not given stays."""

    rule: CarvingRule | None = None
    tolerated_misses: int | None = Field(default=None, ge=0, le=1000)
    spacing_m: float | None = Field(default=None, gt=0, le=MOST_SIDE_M)
    side_m: float | None = Field(default=None, gt=0, le=MOST_SIDE_M)
    frame_range: tuple[int, int | None] | None = Field(
        default=None, description="First and last frame that vote; the last null for no end."
    )


@router.put("/frames/{number}/silhouette")
def commit_outline(number: int, order: OutlineOrder, stream: Stream) -> dict[str, Any]:
    """Give a frame another outline, in the journal, and return the frame once the hull follows."""
    with refusing():
        silhouette, repair = _drawn(number, order, stream)
        stream.edit(
            lambda analysis: analysis.commit(
                number,
                silhouette,
                tool=order.tool,
                base_revision=order.base_revision,
                repair=repair,
            )
        )
    return facts_of(stream, number, silhouette.component)


@router.put("/frames/{number}/preview")
def preview_outline(number: int, order: OutlineOrder, stream: Stream) -> dict[str, Any]:
    """Let the hull follow an outline that is not committed; the latest wins."""
    with refusing():
        silhouette, _ = _drawn(number, order, stream)
        stream.preview(number, silhouette, base_revision=order.base_revision)
    return facts_of(stream, number, silhouette.component)


@router.delete("/frames/{number}/preview")
def end_preview(number: int, stream: Stream, component: Component = WHOLE) -> dict[str, Any]:
    """Show the hulls of the committed outlines again."""
    record_at(stream, number)
    stream.end_preview()
    with refusing():
        return facts_of(stream, number, checked_label(component))


@router.post("/frames/{number}/undo")
def undo(number: int, order: StepOrder, stream: Stream) -> dict[str, Any]:
    """Take the last edit of a component's outline in the frame back."""
    return _stepped(number, order, stream, Analysis.undo)


@router.post("/frames/{number}/redo")
def redo(number: int, order: StepOrder, stream: Stream) -> dict[str, Any]:
    """Do the edit again that was taken back last."""
    return _stepped(number, order, stream, Analysis.redo)


@router.put("/frames/{number}/state")
def set_state(number: int, order: StateOrder, stream: Stream) -> dict[str, Any]:
    """Say how far the analyst is with a frame; an excluded one does not vote."""
    record_at(stream, number)
    with refusing():
        stream.edit(lambda work: work.set_state(number, order.state))
    return state_of(stream)


@router.get("/tools")
def read_tools() -> list[str]:
    """Return the names of the tools that propose outlines."""
    return list(TOOLS)


@router.post("/frames/{number}/proposals")
def propose(number: int, order: ProposalOrder, stream: Stream) -> dict[str, Any]:
    """Return the outline that a tool proposes; nothing changes."""
    snapshot = stream.snapshot
    record = record_at(stream, number)
    with refusing():
        kept = record.analysed.layer(checked_label(order.component)).silhouette
        drawn = None if order.rings is None else _silhouette(order.rings, kept)[0]
        question = Question(snapshot=snapshot, record=record, drawn=drawn or kept)
        return proposal(order.tool, order.parameters, question).facts()


@router.get("/frames/{number}/reprojection")
def read_reprojection(number: int, stream: Stream, component: Component = WHOLE) -> dict[str, Any]:
    """Return the outline of a hull as the frame sees it, and how it differs from the frame's.

    What the shadow rule leaves open behind a lit side is no difference.
    """
    snapshot, record = stream.snapshot, record_at(stream, number)
    layer, carved = record.analysed.layer(component), snapshot.carved(component)
    drawn = layer.silhouette
    rings = reprojected_rings(snapshot, record, component)
    shadow = shadow_region(drawn) if snapshot.settings.rule == "shadow" else ()
    found = disagreement(drawn.rings, rings, shadow)
    return {
        "rings": [ring.tolist() for ring in rings],
        "revision": None if carved is None else carved[0].revision,
        "outline_revision": layer.history.revision,
        "only_outline_px": found.only_outline_px,
        "only_hull_px": found.only_reprojection_px,
        "overlap": found.overlap,
    }


@router.put("/carving")
def set_carving(order: CarvingOrder, stream: Stream) -> dict[str, Any]:
    """Carve by another rule, threshold, grid, or by other frames."""
    given = {key: value for key, value in order.model_dump().items() if value is not None}

    def change(analysis: Analysis) -> None:
        settings = replace(analysis.settings, **given)
        if settings.side_m / settings.spacing_m > MOST_VOXELS_A_SIDE:
            raise ValueError(
                f"A grid of {settings.side_m:g} m at {settings.spacing_m:g} m has "
                f"{settings.side_m / settings.spacing_m:.0f} voxels a side; at most "
                f"{MOST_VOXELS_A_SIDE} follow edits at once. Use a larger spacing."
            )
        analysis.set_carving(settings)

    with refusing():
        stream.edit(change)
    return state_of(stream)


@router.delete("/components")
def delete_component(stream: Stream, component: Component) -> dict[str, Any]:
    """Take a part's outline out of all frames; each frame's can be brought back by undo."""
    with refusing():
        stream.edit(lambda work: work.delete_part(component))
    return state_of(stream)


def _stepped(
    number: int, order: StepOrder, stream: Stream, step: Callable[..., object]
) -> dict[str, Any]:
    record_at(stream, number)
    with refusing():
        label, base = checked_label(order.component), order.base_revision
        stream.edit(lambda work: step(work, number, component=label, base_revision=base))
        return facts_of(stream, number, label)


def _drawn(number: int, order: OutlineOrder, stream: Stream) -> tuple[Silhouette, str]:
    present = record_at(stream, number).analysed.layer(checked_label(order.component)).silhouette
    like = replace(present, claim=order.claim)
    if order.tool not in NOT_DRAWING:
        like = replace(like, provenance=f"edited with {order.tool}")
    return _silhouette(order.rings, like)


def _silhouette(rings: Rings, like: Silhouette) -> tuple[Silhouette, str]:
    return drawn_silhouette(
        rings,
        image_shape=like.image_shape,
        claim=like.claim,
        component=like.component,
        provenance=like.provenance,
    )


@contextmanager
def refusing() -> Iterator[None]:
    """Answer what the engine refuses with its sentence."""
    try:
        yield
    except (StaleRevision, NothingLeft) as error:
        raise HTTPException(409, str(error)) from error
    except ValueError as error:
        raise HTTPException(422, str(error)) from error
