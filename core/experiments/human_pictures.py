"""Pictures of a person's frames and hulls."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, Protocol

import numpy as np
from matplotlib.figure import Figure as Canvas

from core.experiments.frame_pictures import OURS, TRUTH
from core.experiments.hull_pictures import sides_picture
from core.experiments.human_measures import PersonHull
from core.experiments.pictures import Picture
from core.frame import Frame
from core.hull.surface import Surface
from core.silhouettes.silhouette import Silhouette
from core.targets import Target

KNIFE_COLOUR = "#00f0ff"

FRAMES_SHOWN = 6


class HasOutlines(Protocol):
    """Frames with the outlines found in them."""

    @property
    def frames(self) -> Sequence[Frame]:
        """The images."""

    @property
    def body(self) -> Sequence[Silhouette]:
        """Of the whole."""

    @property
    def knife(self) -> Sequence[Silhouette]:
        """Of the bright part."""


def person_frames_picture(
    seen: Mapping[str, HasOutlines],
    true_body: Sequence[Silhouette],
    true_knife: Sequence[Silhouette],
    *,
    name: str,
) -> Picture:
    """Picture frames of both circles, one row for each variant, with found and true outlines."""

    def draw(canvas: Canvas) -> None:
        cells = canvas.subplots(len(seen), FRAMES_SHOWN, squeeze=False)
        for row, (variant, each) in zip(cells, seen.items(), strict=True):
            chosen = np.linspace(0, len(each.frames) - 1, FRAMES_SHOWN).round().astype(int)
            for cell, index in zip(row, chosen, strict=True):
                frame = each.frames[index]
                _show(cell, frame, f"{variant}, {frame.label}, {frame.time_s:.0f} s")
                outlines = {
                    "true": (true_body[index], TRUTH, 0.7),
                    "found": (each.body[index], OURS, 0.9),
                    "true knife": (true_knife[index], "white", 0.7),
                    "knife found": (each.knife[index], KNIFE_COLOUR, 1.1),
                }
                for label, (outline, colour, width) in outlines.items():
                    _draw_rings(cell, outline, label, color=colour, linewidth=width)
        handles = {h.get_label(): h for c in cells.flat for h in c.get_legend_handles_labels()[0]}
        cells[0, 0].legend(handles=list(handles.values()), loc="lower left", fontsize=6)

    return Picture(
        name=name,
        caption="Near-field frames from above and from below, bare and under a cover, with the "
        "outlines found of body and knife and the true ones: range down, cross-range right, 45 dB "
        "of amplitude. White: where the knife is, hidden or not.",
        draw=draw,
        size_in=(2.2 * FRAMES_SHOWN, 4.6 * len(seen)),
    )


def person_sides_picture(hull: PersonHull, person: Target, *, name: str) -> Picture:
    """Picture the hulls of body and knife from three sides beside the truth."""
    both = _together(hull.body, hull.knife)
    picture = sides_picture(both, person, name=name, what="Hulls of body and knife")
    return replace(
        picture,
        caption="Hulls of body and knife from three sides, above, and the truth, below (metres; x "
        "forward, y right, z down).",
    )


def _together(first: Surface, second: Surface) -> Surface:
    return Surface(
        vertices_m=np.concatenate([first.vertices_m, second.vertices_m]),
        faces=np.concatenate([first.faces, second.faces + len(first.vertices_m)]),
    )


def _show(cell: Any, frame: Frame, title: str) -> None:
    cell.imshow(frame.decibels(floor_db=-45), cmap="inferno")
    cell.grid(visible=False)
    cell.set(xticks=[], yticks=[])
    cell.set_title(title, fontsize=8)


def _draw_rings(cell: Any, outline: Silhouette, label: str, **style: Any) -> None:
    for number, ring in enumerate(outline.rings):
        closed = np.vstack([ring, ring[:1]])
        cell.plot(closed[:, 1], closed[:, 0], label=None if number else label, **style)
