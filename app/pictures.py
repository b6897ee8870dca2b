"""Frames as pictures: levels in dB as 16-bit numbers, and their colours.

The page and the viewport colour the same numbers with the same table.
"""

from typing import Any, Literal

import cv2
import numpy as np
from numpy.typing import NDArray

from core.frame import Frame

FLOOR_DB = -100.0
"""Level of the number 0; everything darker is 0 too."""

STEP_DB = -FLOOR_DB / 65535
"""Level between neighbouring numbers; 65535 is the frame's peak, 0 dB."""

SHOWN_FLOOR_DB = -40.0
"""Level at which pictures turn dark before the analyst chooses another."""

ColourName = Literal["magma", "viridis", "cividis", "grey"]

_OPENCV_MAPS = {
    "magma": cv2.COLORMAP_MAGMA,
    "viridis": cv2.COLORMAP_VIRIDIS,
    "cividis": cv2.COLORMAP_CIVIDIS,
}

FADE = (0.15, 0.45)
"""Parts of the shown dynamic range between which a picture in space turns from clear to opaque.

Noise just above the floor must not speckle what is behind it.
"""


def encoded_levels(frame: Frame) -> NDArray[np.uint16]:
    """Return the frame's levels as (rows, columns) little-endian uint16.

    A number n stands for FLOOR_DB + n · STEP_DB relative to the frame's peak.
    """
    level = (frame.decibels(floor_db=FLOOR_DB) - FLOOR_DB) / STEP_DB
    encoded: NDArray[np.uint16] = np.clip(np.round(level), 0, 65535).astype("<u2")
    return encoded


def colour_table(name: ColourName = "magma") -> NDArray[np.uint8]:
    """Return 256 colours (256, 3) RGB from dark to bright.

    Source: "magma", "viridis" and "cividis", perceptually uniform, as OpenCV carries them; "grey"
    is a linear ramp.
    """
    ramp = np.arange(256, dtype=np.uint8)[:, None]
    if name == "grey":
        return np.repeat(ramp, 3, axis=1)
    table: NDArray[np.uint8] = cv2.applyColorMap(ramp, _OPENCV_MAPS[name])[:, 0, ::-1].copy()
    return table


def colour_index(level_db: NDArray[Any], floor_db: float) -> NDArray[np.uint8]:
    """Return which of the 256 colours shows a level, (…) uint8; 0 at `floor_db`, 255 at 0 dB."""
    share = np.clip((level_db - floor_db) / -floor_db, 0, 1)
    index: NDArray[np.uint8] = np.floor(share * 255 + 0.5).astype(np.uint8)
    return index


def translucent_picture(level_db: NDArray[Any], floor_db: float) -> NDArray[np.uint8]:
    """Return levels (rows, columns) as RGBA whose dark parts let through what is behind."""
    index = colour_index(level_db, floor_db)
    alpha = 255 * np.clip((index / 255 - FADE[0]) / (FADE[1] - FADE[0]), 0, 1)
    return np.dstack([colour_table()[index], alpha.astype(np.uint8)])
