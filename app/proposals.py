"""Tools that propose outlines: the page names one, and what it proposes changes nothing.

A tool is a function of a question and of its parameters, checked by a model of its own. A new one
is a line in `TOOLS`.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from app.snapshot import Record, Snapshot
from core.arrays import Floats
from core.frame import Frame
from core.hull.reprojection import reprojected_rings as hull_image
from core.silhouettes.editing.brush import combined_rings
from core.silhouettes.editing.grabcut import grab_cut
from core.silhouettes.editing.growing import grown
from core.silhouettes.editing.livewire import livewire
from core.silhouettes.editing.smoothing import simplified, smoothed, without_holes
from core.silhouettes.editing.snapping import snapped
from core.silhouettes.editing.transfer import copied, interpolated
from core.silhouettes.extraction import ExtractionSettings, extract_silhouette
from core.silhouettes.silhouette import WHOLE, Claim, Silhouette


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Question:
    """What a tool is asked about.

    Attributes:
        snapshot: all that is on show.
        record: the frame.
        drawn: its outline as it stands on the page.
    """

    snapshot: Snapshot
    record: Record
    drawn: Silhouette


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Proposal:
    """What a tool answers.

    Attributes:
        rings: the outline, each ring (vertices, 2) as (row, column).
        claim: what it claims to show.
        note: what a person should know of it, empty if nothing.
        path: an open line (vertices, 2) for tools that propose a part of an outline only.
    """

    rings: tuple[Floats, ...]
    claim: Claim
    note: str = ""
    path: Floats | None = None

    def facts(self) -> dict[str, Any]:
        """Return it as JSON."""
        facts: dict[str, Any] = {
            "rings": [ring.tolist() for ring in self.rings],
            "claim": self.claim,
            "note": self.note,
        }
        return facts if self.path is None else {**facts, "path": self.path.tolist()}


class Parameters(BaseModel):
    """A tool's parameters; what it does not know it refuses."""

    model_config = ConfigDict(extra="forbid", populate_by_name=True, allow_inf_nan=False)


class NoParameters(Parameters):
    """Of a tool that needs none."""


class ThresholdParameters(Parameters):
    """The extraction's own settings; what is not given is as in the whole analysis."""

    censoring_factor: float | None = Field(default=None, alias="a1", gt=0, le=100)
    detection_factor: float | None = Field(default=None, alias="a2", gt=0, le=1000)
    closing_px: int | None = Field(default=None, ge=0, le=99)
    smallest_part_px: int | None = Field(default=None, ge=0, le=1_000_000)
    sidelobe_level_db: float | None = Field(default=None, ge=-200, le=0)
    corrects_edge: bool | None = None


class CopyParameters(Parameters):
    """Which frame's outline to copy."""

    source: int = Field(alias="from")


class GrowParameters(Parameters):
    """Where a region grows from, and how far the level may fall."""

    row: float
    column: float
    tolerance_db: float = Field(default=6.0, gt=0, le=120)


class LivewireParameters(Parameters):
    """Anchors of a path along an edge, each (row, column)."""

    points: list[tuple[float, float]] = Field(min_length=2, max_length=200)


class SnapParameters(Parameters):
    """How far a vertex may move."""

    reach_px: float = Field(default=4.0, gt=0, le=50)


class SmoothParameters(Parameters):
    """How strongly wiggles are taken out."""

    strength_px: float = Field(default=1.5, gt=0, le=50)


class SimplifyParameters(Parameters):
    """How far the outline may move."""

    tolerance_px: float = Field(default=0.5, gt=0, le=50)


class InterpolateParameters(Parameters):
    """Between which two frames' outlines."""

    ends: tuple[int, int] = Field(alias="from")


Chosen = TypeVar("Chosen", bound=Parameters)


@dataclass(frozen=True, slots=True)
class Tool(Generic[Chosen]):
    """A tool: how its parameters are checked, and what it proposes."""

    parameters: type[Chosen]
    propose: Callable[[Question, Chosen], Proposal]

    def proposal(self, parameters: dict[str, Any], question: Question) -> Proposal:
        """Return what it proposes.

        Raises:
            ValueError: parameters that it does not take.
        """
        try:
            chosen = self.parameters.model_validate(parameters)
        except ValidationError as error:
            first = error.errors()[0]
            place = " → ".join(str(part) for part in first["loc"])
            raise ValueError(f"The tool's parameters: {place}: {first['msg']}.") from error
        return self.propose(question, chosen)


def proposal(tool: str, parameters: dict[str, Any], question: Question) -> Proposal:
    """Return what a tool proposes.

    Raises:
        ValueError: there is no such tool, or it refuses.
    """
    if tool not in TOOLS:
        raise ValueError(f'There is no tool "{tool}" that proposes outlines, only: {_names()}.')
    return TOOLS[tool].proposal(parameters, question)


def reprojected_rings(
    snapshot: Snapshot, record: Record, component: str = WHOLE
) -> tuple[Floats, ...]:
    """Return the outline of a hull on show as a frame sees it, traced between its pixels."""
    carved = snapshot.carved(component)
    if carved is None or carved[1].is_empty:
        return ()
    frame = record.frame
    return hull_image(carved[1], frame.projection, frame.shape, finer=2)


def _threshold(question: Question, chosen: ThresholdParameters) -> Proposal:
    given = {key: value for key, value in chosen.model_dump().items() if value is not None}
    base = question.snapshot.settings.extraction
    settings = ExtractionSettings(**{**_fields(base), **given})
    found = extract_silhouette(question.record.analysed.received, settings)
    note = "" if found.rings else "Nothing in this frame stands out at these settings."
    return Proposal(rings=found.rings, claim=found.claim, note=note)


def _fields(settings: ExtractionSettings) -> dict[str, Any]:
    return {name: getattr(settings, name) for name in settings.__dataclass_fields__}


def _record(question: Question, number: int) -> Record:
    records = question.snapshot.records
    if not 1 <= number <= len(records):
        raise ValueError(
            f"There is no frame {number} to copy from; {len(records)} have arrived so far."
        )
    return records[number - 1]


def _copy(question: Question, chosen: CopyParameters) -> Proposal:
    """Copy another frame's outline so that the target's origin stays under it."""
    other, component = _record(question, chosen.source), question.drawn.component
    silhouette = other.analysed.layer(component).silhouette
    if silhouette.is_empty:
        note = f"Frame {chosen.source} shows no {component}."
        return Proposal(rings=(), claim=silhouette.claim, note=note)
    rings = copied(silhouette.rings, other.frame, question.record.frame)
    return Proposal(rings=rings, claim=silhouette.claim)


def _interpolate(question: Question, chosen: InterpolateParameters) -> Proposal:
    before, after = (_record(question, number) for number in chosen.ends)
    component = question.drawn.component
    first, last = (end.analysed.layer(component).silhouette for end in (before, after))
    rings = interpolated(first.rings, before.frame, last.rings, after.frame, question.record.frame)
    return Proposal(rings=rings, claim=first.claim)


def _grow(question: Question, chosen: GrowParameters) -> Proposal:
    """Add the region that grows from a place to the outline as drawn."""
    frame = question.record.frame
    region = grown(frame, (chosen.row, chosen.column), chosen.tolerance_db)
    drawn = question.drawn
    joined = combined_rings(drawn.rings, region, "add") if drawn.rings else region
    return Proposal(rings=joined, claim=drawn.claim)


def _livewire(question: Question, chosen: LivewireParameters) -> Proposal:
    path = livewire(question.record.frame, np.array(chosen.points))
    return Proposal(rings=question.drawn.rings, claim=question.drawn.claim, path=path)


def _redrawn(change: Callable[[Silhouette, Frame, Any], tuple[Floats, ...]]) -> Any:
    """Return the tool that changes the outline as drawn; without one there is nothing to change."""

    def propose(question: Question, chosen: Any) -> Proposal:
        if question.drawn.is_empty:
            raise ValueError("This frame has no outline to change; draw one first.")
        rings = change(question.drawn, question.record.frame, chosen)
        return Proposal(rings=rings, claim=question.drawn.claim)

    return propose


def _reprojection(question: Question, _: NoParameters) -> Proposal:
    rings = reprojected_rings(question.snapshot, question.record, question.drawn.component)
    return Proposal(
        rings=rings,
        claim="complete",
        note="" if rings else "There is no hull to be seen in this frame.",
    )


TOOLS: dict[str, Tool[Any]] = {
    "threshold": Tool(ThresholdParameters, _threshold),
    "grow": Tool(GrowParameters, _grow),
    "livewire": Tool(LivewireParameters, _livewire),
    "grabcut": Tool(NoParameters, _redrawn(lambda drawn, frame, _: grab_cut(drawn.rings, frame))),
    "snap": Tool(
        SnapParameters,
        _redrawn(lambda drawn, frame, chosen: snapped(drawn.rings, frame, chosen.reach_px)),
    ),
    "smooth": Tool(
        SmoothParameters,
        _redrawn(lambda drawn, _, chosen: smoothed(drawn.rings, chosen.strength_px)),
    ),
    "simplify": Tool(
        SimplifyParameters,
        _redrawn(lambda drawn, _, chosen: simplified(drawn.rings, chosen.tolerance_px)),
    ),
    "fill holes": Tool(NoParameters, _redrawn(lambda drawn, _frame, _: without_holes(drawn.rings))),
    "copy": Tool(CopyParameters, _copy),
    "interpolate": Tool(InterpolateParameters, _interpolate),
    "reprojection": Tool(NoParameters, _reprojection),
}


def _names() -> str:
    return ", ".join(TOOLS)
