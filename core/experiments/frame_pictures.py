"""Pictures of frames with the outlines taken from them and the true ones."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.figure import Figure as Canvas

from core.experiments.pictures import Picture
from core.experiments.true_outline import true_silhouette
from core.frame import Frame
from core.silhouettes.silhouette import Silhouette
from core.targets import Target

TRUTH, OURS = "#5fd38a", "#58b4ff"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class OutlinedFrame:
    """A frame with the silhouette taken from it."""

    frame: Frame
    silhouette: Silhouette


def frames_picture(
    found: Sequence[OutlinedFrame], target: Target, *, name: str, caption: str, most: int = 8
) -> Picture:
    """Picture some frames, evenly chosen, with found and true outlines.

    Args:
        found: frames and their silhouettes.
        target: the truth.
        name: of the picture's file.
        caption: what the frames are.
        most: frames that are shown.
    """
    shown = _evenly(found, most)
    mesh = target.mesh()
    half_m = 1.04 * float(np.linalg.norm(mesh.vertices, axis=1).max())
    columns = min(4, len(shown))
    rows = -(-len(shown) // columns)

    def draw(canvas: Canvas) -> None:
        cells = canvas.subplots(rows, columns, squeeze=False)
        for cell in cells.flat[len(shown) :]:
            cell.set_axis_off()
        for number, (cell, each) in enumerate(zip(cells.flat, shown, strict=False)):
            truth = true_silhouette(mesh, each.frame.projection, each.frame.shape)
            _show(cell, each, truth, half_m, has_names=number == 0)
            if number == 0:
                cell.legend(loc="lower left")

    return Picture(name=name, caption=caption, draw=draw, size_in=(3.0 * columns, 3.15 * rows))


def photographs_picture(
    found: Sequence[OutlinedFrame], *, name: str, caption: str, most: int = 8
) -> Picture:
    """Picture some whole photographs, evenly chosen, with the outlines found.

    Args:
        found: photographs and their silhouettes.
        name: of the picture's file.
        caption: what they are.
        most: photographs that are shown.
    """
    shown = _evenly(found, most)
    columns = min(4, len(shown))
    rows = -(-len(shown) // columns)
    high, wide = shown[0].frame.shape

    def draw(canvas: Canvas) -> None:
        cells = canvas.subplots(rows, columns, squeeze=False)
        for cell in cells.flat:
            cell.set_axis_off()
        for cell, each in zip(cells.flat, shown, strict=False):
            cell.imshow(each.frame.amplitude, cmap="gray")
            _draw_outline(cell, each.silhouette, OURS, None)
            cell.set_title(each.frame.label)

    size_in = (3.0 * columns, (3.0 * high / wide + 0.3) * rows)
    return Picture(name=name, caption=caption, draw=draw, size_in=size_in)


def _evenly(found: Sequence[OutlinedFrame], most: int) -> list[OutlinedFrame]:
    chosen = np.unique(np.linspace(0, len(found) - 1, most).round().astype(int))
    return [found[index] for index in chosen]


def _draw_outline(cell: Any, outline: Silhouette, colour: str, name: str | None) -> None:
    for number, ring in enumerate(outline.rings):
        closed = np.vstack([ring, ring[:1]])
        label = name if number == 0 else None
        cell.plot(closed[:, 1], closed[:, 0], color=colour, linewidth=0.9, label=label)


def _show(
    cell: Any, each: OutlinedFrame, truth: Silhouette, half_m: float, *, has_names: bool
) -> None:
    frame = each.frame
    is_radar = frame.sensor == "radar"
    level = frame.decibels(floor_db=-45) if is_radar else np.sqrt(frame.amplitude)
    cell.imshow(level, cmap="inferno" if is_radar else "gray")
    for outline, colour, name in ((truth, TRUTH, "true"), (each.silhouette, OURS, "found")):
        _draw_outline(cell, outline, colour, name if has_names else None)
    row, column = frame.projection.image_points(np.zeros(3))
    tall, wide = (
        half_m * float(size) for size in np.linalg.norm(frame.projection.matrix[:2, :3], axis=1)
    )
    cell.set(xlim=(column - wide, column + wide), ylim=(row + tall, row - tall))
    cell.set_aspect(wide / tall)
    cell.set_title(f"{frame.label or frame.sensor}, {frame.time_s:.0f} s")
    cell.grid(visible=False)
    cell.set(xticks=[], yticks=[])
