"""Outlines as annotation tools exchange them: what COCO, labelme and mask files share.

Inside, pixel centres are integers. Annotation tools count from the upper left corner of the image,
where (x, y) = (0, 0), so that the centre of its first pixel lies at (0.5, 0.5):
x = column + 0.5 and y = row + 0.5.

A file that gives some outline the label of the whole target keeps labels apart: the others are
parts of it. In any other file all that a frame shows is the target, whatever it is called there.

Frames are told apart by the number in the name of their image, from 1: "frame-000012.png".
"""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from core.arrays import Floats
from core.silhouettes.areas import area_of, rings_of
from core.silhouettes.contours import traced_rings
from core.silhouettes.silhouette import Claim, Silhouette, clockwise_area_px

CORNER_PX = 0.5
"""From the corner of a pixel, where annotation tools count from, to its centre."""

MOST_PIXELS = 2**26
"""Of an image whose mask is unpacked."""

OWN_FIELD = "radarhull"
"""Under which files carry what their format has no word for; other programs read past it."""

Outlines = Iterable[tuple[int, Silhouette]]
"""Numbers of frames, from 1, with their silhouettes; one of each component that a frame shows."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Annotation:
    """The outline of one frame as a file gives it; nothing has been compared with the frame yet.

    Attributes:
        number: of the frame, from the name of its image.
        rings: each (vertices, 2) as (row, column), pixel centres integers; none where the file
            says that the frame shows no target.
        image_shape: (rows, columns) that the file states.
        claim: what the outline claims to show, None where the file does not say.
        component: what it outlines, None where the file does not tell parts from the whole.
        is_mask: whether the rings run around whole pixels, for the file knows no others.
    """

    number: int
    rings: tuple[Floats, ...]
    image_shape: tuple[int, int]
    claim: Claim | None = None
    component: str | None = None
    is_mask: bool = False


def image_name(number: int, suffix: str = ".png") -> str:
    """Return what the image of a frame is called."""
    return f"frame-{number:06d}{suffix}"


def frame_number(name: str) -> int:
    """Return the number of the frame whose image has a name: the last digits before its ending.

    Raises:
        ValueError: there are none, or more than nine.
    """
    digits = re.findall(r"[0-9]+", PurePosixPath(name.replace("\\", "/")).stem)
    if not digits or len(digits[-1]) > 9:
        raise ValueError(
            f'The name of an image must end in the number of its frame, as "{image_name(12)}" '
            f'does; got "{name[:80]}".'
        )
    return int(digits[-1])


def to_xy(ring: Floats) -> list[list[float]]:
    """Return a ring of (row, column) as [x, y] from the image's corner."""
    pairs: list[list[float]] = (ring[:, ::-1] + CORNER_PX).tolist()
    return pairs


def from_xy(points: Any, where: str) -> Floats:
    """Return [x, y] pairs from the image's corner as a ring of (row, column).

    Raises:
        ValueError: not at least three pairs of finite numbers.
    """
    try:
        pairs = np.asarray(points, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        pairs = np.empty(0)
    if pairs.ndim != 2 or pairs.shape[1:] != (2,) or len(pairs) < 3 or not np.isfinite(pairs).all():
        raise ValueError(f"{where} must be a list of at least three points (x, y).")
    ring: Floats = pairs[:, ::-1] - CORNER_PX
    return ring


def combined(parts: Sequence[tuple[Floats, ...]]) -> tuple[Floats, ...]:
    """Return the rings around all that several parts enclose together.

    Parts that neither cross nor overlap keep their rings as they are, vertex by vertex.

    Args:
        parts: each of rings (vertices, 2) as (row, column), turned as a silhouette's are.
    """
    areas = [area_of(rings) for rings in parts]
    together = shapely.union_all(areas)
    rings = tuple(ring for rings in parts for ring in rings)
    stated_px = sum(map(clockwise_area_px, rings))
    return rings if abs(together.area - stated_px) <= 1e-9 * (1 + stated_px) else rings_of(together)


def mask_rings(mask: NDArray[np.bool_]) -> tuple[Floats, ...]:
    """Return rings halfway between the pixels of a mask (rows, columns) and those around them."""
    return traced_rings(np.where(mask, np.float32(1), np.float32(-1)), 0.0)


def by_frame(outlines: Outlines) -> dict[int, list[Silhouette]]:
    """Return the silhouettes of each frame."""
    frames: dict[int, list[Silhouette]] = {}
    for number, silhouette in outlines:
        frames.setdefault(number, []).append(silhouette)
    return frames


def stated_claim(own: Any) -> Claim | None:
    """Return the claim in a file's own field, None where there is none that is known."""
    claim = own.get("claim") if isinstance(own, dict) else None
    return claim if claim in ("lit side", "complete") else None


def member(holder: Any, name: str, kind: type, where: str) -> Any:
    """Return what a JSON object has under a name.

    Raises:
        ValueError: the object is none, or has nothing of that kind there.
    """
    value = holder.get(name) if isinstance(holder, dict) else None
    if not isinstance(value, kind) or isinstance(value, bool):
        words = {str: "text", int: "a whole number", list: "a list", dict: "an object"}
        raise ValueError(f'{where} must have {words[kind]} under "{name}".')
    return value


def stated_shape(holder: Any, rows: str, columns: str, where: str) -> tuple[int, int]:
    """Return the (rows, columns) that a JSON object states under two names.

    Raises:
        ValueError: it states none, or too many pixels.
    """
    shape = member(holder, rows, int, where), member(holder, columns, int, where)
    return checked_shape(shape, where)


def checked_shape(shape: tuple[int, int], where: str) -> tuple[int, int]:
    """Return (rows, columns) of an image that may be unpacked.

    Raises:
        ValueError: less than a pixel, or too many.
    """
    if min(shape) < 1 or shape[0] * shape[1] > MOST_PIXELS:
        raise ValueError(
            f"{where} is said to have {shape[0]} × {shape[1]} pixels; 1 to {MOST_PIXELS:,} in all "
            "are taken."
        )
    return shape


def turned(ring: Floats, *, clockwise: bool) -> Floats:
    """Return a ring (vertices, 2), running clockwise as seen on the image or the other way."""
    return ring if (clockwise_area_px(ring) > 0) == clockwise else ring[::-1]
