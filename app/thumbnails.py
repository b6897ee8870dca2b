"""Small pictures of frames with their outlines, for the row of all frames."""

import threading
from collections import OrderedDict

import cv2
import numpy as np
from numpy.typing import NDArray

from app.pictures import SHOWN_FLOOR_DB, colour_index, colour_table
from app.snapshot import Record
from core.arrays import Floats
from core.frame import Frame
from core.silhouettes.silhouette import Silhouette

SHAPE = (64, 80)
"""(rows, columns) of a thumbnail."""

MARGIN = 0.12
"""Of the outline's height and width, left free around it."""

OUTLINE_RGB = (64, 224, 208)

MOST_KEPT = 1024
"""Thumbnails in memory, of about 4 kB each."""

SHIFT = 4
"""Bits behind the point in the coordinates that OpenCV draws lines with."""


def thumbnail(frame: Frame, silhouette: Silhouette) -> NDArray[np.uint8]:
    """Return a frame cut to its outline and a margin, with the outline, SHAPE + (3,) RGB.

    A pixel is as many metres high as wide. A frame without an outline is shown whole.
    """
    first, last = _part_shown(frame, silhouette)
    scale = np.array(SHAPE) / (last - first)
    level_db = frame.decibels(floor_db=SHOWN_FLOOR_DB)
    index = colour_index(level_db, SHOWN_FLOOR_DB)
    picture = colour_table()[_shrunk(index, first, scale)]
    for ring in silhouette.rings:
        # A pixel's centre is an integer, its corner half a pixel before.
        places = (ring + 0.5 - first) * scale - 0.5
        points = np.round(places[:, ::-1] * 2**SHIFT).astype(np.int32)
        cv2.polylines(picture, [points], True, OUTLINE_RGB, 1, cv2.LINE_AA, SHIFT)
    return picture


def png(picture: NDArray[np.uint8]) -> bytes:
    """Return an RGB picture as a PNG file."""
    is_made, encoded = cv2.imencode(".png", picture[..., ::-1])
    assert is_made, "OpenCV could not encode a picture"
    return encoded.tobytes()


class Thumbnails:
    """Makes thumbnails one at a time, and keeps those that were asked for last."""

    def __init__(self) -> None:
        """Start with none."""
        self._lock = threading.Lock()
        self._kept: OrderedDict[str, bytes] = OrderedDict()

    def of(self, run: int, record: Record) -> bytes:
        """Return the PNG file of a frame as it stands."""
        key = key_of(run, record)
        with self._lock:
            if key not in self._kept:
                self._kept[key] = png(thumbnail(record.frame, record.silhouette))
            self._kept.move_to_end(key)
            while len(self._kept) > MOST_KEPT:
                self._kept.popitem(last=False)
            return self._kept[key]


def key_of(run: int, record: Record) -> str:
    """Return what changes with everything that a thumbnail shows."""
    return f"{run}-{record.number}-{record.analysed.history.revision}"


def _part_shown(frame: Frame, silhouette: Silhouette) -> tuple[Floats, Floats]:
    """Return the corners (row, column) of the part of a frame that a thumbnail shows, in pixels.

    They count from the frame's corner, half a pixel before the centre of its first pixel.
    """
    if silhouette.is_empty:
        first, last = np.zeros(2), np.array(frame.shape, dtype=np.float64)
    else:
        vertices = np.concatenate(silhouette.rings) + 0.5
        first, last = vertices.min(axis=0), vertices.max(axis=0)
    size = np.maximum((last - first) * (1 + 2 * MARGIN * (not silhouette.is_empty)), 4.0)
    pixel_m = np.array([frame.row_spacing_m or 1.0, frame.column_spacing_m or 1.0])
    wide = np.array(SHAPE) / pixel_m
    size = wide * (size / wide).max()
    middle = (first + last) / 2
    return middle - size / 2, middle + size / 2


def _shrunk(index: NDArray[np.uint8], first: Floats, scale: Floats) -> NDArray[np.uint8]:
    """Return part of a picture at a scale, averaged over what falls into a pixel; dark outside."""
    blur = np.maximum(0.5 / scale - 0.5, 0.0)
    if blur.max() > 0:
        index = cv2.GaussianBlur(index, (0, 0), *(np.maximum(blur, 0.1))[::-1])
    (row_scale, column_scale), (row, column) = scale, first
    # OpenCV counts from the centre of the first pixel.
    move = np.array(
        [
            [column_scale, 0, (0.5 - column) * column_scale - 0.5],
            [0, row_scale, (0.5 - row) * row_scale - 0.5],
        ]
    )
    shrunk: NDArray[np.uint8] = cv2.warpAffine(index, move, SHAPE[::-1], flags=cv2.INTER_LINEAR)
    return shrunk
