"""Pictures that an experiment draws, all in one dark style."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import matplotlib as mpl
from matplotlib.figure import Figure as Canvas

from core.formats.files import written_aside

STYLE = {
    "figure.facecolor": "#11151c",
    "axes.facecolor": "#171c25",
    "savefig.facecolor": "#11151c",
    "axes.edgecolor": "#5b6675",
    "axes.labelcolor": "#d5dbe5",
    "axes.titlecolor": "#eef1f6",
    "axes.titlesize": 10,
    "axes.labelsize": 9,
    "axes.grid": True,
    "grid.color": "#2b3340",
    "text.color": "#d5dbe5",
    "xtick.color": "#aab4c3",
    "ytick.color": "#aab4c3",
    "xtick.labelsize": 8,
    "ytick.labelsize": 8,
    "legend.facecolor": "#171c25",
    "legend.edgecolor": "#2b3340",
    "legend.fontsize": 8,
    "lines.linewidth": 1.4,
    "image.cmap": "inferno",
}
"""Matplotlib's settings of every picture."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Picture:
    """One picture, drawn when it is written.

    Attributes:
        name: of its file, without an ending.
        caption: what it shows, in a sentence, with units.
        draw: draws it on a canvas that has the size and the style already.
        size_in: width and height in inches.
    """

    name: str
    caption: str
    draw: Callable[[Canvas], None]
    size_in: tuple[float, float] = (10.0, 5.0)


def write_pictures(pictures: Sequence[Picture], folder: Path) -> tuple[Path, ...]:
    """Draw pictures into PNG files in a folder, made if it is missing, and return their paths.

    Raises:
        ValueError: the folder cannot be written.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ValueError(f"{folder} could not be made: {error.strerror}.") from error
    return tuple(_written(picture, folder / f"{picture.name}.png") for picture in pictures)


def drawn_png(picture: Picture, target: BinaryIO | Path) -> None:
    """Draw a picture as PNG into a file or a path."""
    with mpl.rc_context(STYLE):
        canvas = Canvas(figsize=picture.size_in, layout="constrained")
        picture.draw(canvas)
        canvas.savefig(target, dpi=120, format="png")


def _written(picture: Picture, path: Path) -> Path:
    with written_aside(path) as aside:
        drawn_png(picture, aside)
    return path
