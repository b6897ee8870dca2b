"""The target's parts as requests name them, and as JSON tells of them."""

from typing import Annotated, Any

import numpy as np
from fastapi import Query

from app.facts import hull_facts
from app.layers import Colour, component_colours, css
from app.snapshot import Record, Snapshot
from core.measurement.components import ComponentPlace
from core.silhouettes.silhouette import WHOLE

LONGEST_LABEL = 40
"""Characters, that a label still fits beside the picture."""

Component = Annotated[str, Query(description="Label of a part, or the whole target.")]


def checked_label(text: str) -> str:
    """Return a component's label, with single spaces.

    Raises:
        ValueError: none, one that is too long, or one with letters that cannot be shown.
    """
    label = " ".join(text.split())
    if not 1 <= len(label) <= LONGEST_LABEL or not label.isprintable():
        raise ValueError(
            f"A part's label has 1 to {LONGEST_LABEL} printable characters; this one has "
            f'{len(label)}. Call it "{WHOLE}" if it is the whole.'
        )
    return label


def colours_of(snapshot: Snapshot, *more: str) -> dict[str, Colour]:
    """Return the colour of all that has been outlined, and of `more` that may be.

    A component keeps its colour when others come or go.
    """
    return component_colours((*snapshot.outlined, *snapshot.components, *more))


def component_facts(snapshot: Snapshot) -> list[dict[str, Any]]:
    """Return of each part that has a hull of its own its colour, its numbers and its place.

    `has_place` tells whether there is a place to be measured, once the hulls have been quiet.
    """
    colours = colours_of(snapshot)
    return [
        {
            "label": part.label,
            "colour": css(colours[part.label]),
            "hull": hull_facts(part.hull),
            "has_place": snapshot.hull is not None and part.has_place_in(snapshot.hull),
            "place": None if (place := snapshot.place_of(part)) is None else _place_facts(place),
        }
        for part in snapshot.parts
    ]


def other_outlines(snapshot: Snapshot, record: Record, component: str) -> list[dict[str, Any]]:
    """Return the outlines of a frame that are not the component's, with their colours."""
    layers, parts = record.analysed.layers, record.analysed.parts
    colours = colours_of(snapshot, *parts)
    return [
        {
            "component": label,
            "colour": css(colours[label]),
            "rings": [ring.tolist() for ring in layers[label].silhouette.rings],
        }
        for label in (WHOLE, *parts)
        if label != component and not layers[label].silhouette.is_empty
    ]


def _place_facts(place: ComponentPlace) -> dict[str, Any]:
    """Return where a part is in the whole; axes are lines, so that their signs mean nothing."""
    return {
        "offset_m": place.offset_m.tolist(),
        "offset_along_axes_m": place.offset_along_axes_m.tolist(),
        "turn_deg": float(np.degrees(place.turn_rad)),
        "axes": place.component.axes.tolist(),
        "volume_share": place.volume_share,
    }
