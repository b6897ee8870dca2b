"""Silhouettes as PNG masks: 8 bits, 255 where a pixel's centre lies inside, 0 elsewhere.

A mask knows whole pixels only; what comes back encloses the same pixel centres. Those of a part lie
in a folder that is called after it, "parts/solar%20panel/frame-000012.png".
"""

from urllib.parse import quote, unquote

import cv2
import numpy as np
from numpy.typing import NDArray

from core.formats.annotation import (
    Annotation,
    Outlines,
    checked_shape,
    frame_number,
    image_name,
    mask_rings,
)
from core.formats.archive import packed
from core.silhouettes.silhouette import WHOLE, Silhouette

PARTS = "parts"

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_SIZE_AT = slice(16, 24)
"""Of columns and rows in a PNG's first chunk, which must be IHDR."""


def masks_zip(outlines: Outlines) -> bytes:
    """Return silhouettes as a ZIP archive of masks, one per frame and component."""
    return packed((_name(number, each), mask_png(each.mask())) for number, each in outlines)


def mask_png(mask: NDArray[np.bool_]) -> bytes:
    """Return a mask (rows, columns) as PNG."""
    _, encoded = cv2.imencode(".png", mask.astype(np.uint8) * 255)
    return bytes(encoded)


def read_mask(content: bytes, name: str) -> Annotation:
    """Return the outline around a PNG's pixels that are not black; a black one shows no target.

    Args:
        content: of the file.
        name: of the file; it carries the frame's number.

    Raises:
        ValueError: no PNG, one that is too large or damaged, or no number in its name.
    """
    where = f'The mask "{name[:80]}"'
    if not content.startswith(_SIGNATURE) or len(content) < _SIZE_AT.stop:
        raise ValueError(f"{where} is no PNG file.")
    columns, rows = (int(value) for value in np.frombuffer(content[_SIZE_AT], dtype=">u4"))
    shape = checked_shape((rows, columns), where)
    pixels = _decoded(content)
    if pixels is None or pixels.shape != shape:
        raise ValueError(f"{where} is damaged; write it again.")
    return Annotation(
        number=frame_number(name),
        rings=mask_rings(pixels.astype(bool)),
        component=_component(name),
        image_shape=shape,
        is_mask=True,
    )


def _name(number: int, silhouette: Silhouette) -> str:
    if silhouette.component == WHOLE:
        return image_name(number)
    return f"{PARTS}/{quote(silhouette.component, safe='')}/{image_name(number)}"


def _component(name: str) -> str | None:
    above, _, folder = name.rpartition("/")[0].rpartition("/")
    return unquote(folder) if above.rpartition("/")[2] == PARTS else None


def _decoded(content: bytes) -> NDArray[np.generic] | None:
    # Grey, so that an opaque alpha channel is no target; in its own depth, so that a 1 of 65535
    # is not rounded away.
    try:
        pixels: NDArray[np.generic] | None = cv2.imdecode(
            np.frombuffer(content, dtype=np.uint8), cv2.IMREAD_GRAYSCALE | cv2.IMREAD_ANYDEPTH
        )
    except cv2.error:
        return None
    return pixels
