"""Livewire: a line that follows the target's edge from anchor to anchor."""

from itertools import pairwise

import cv2
import numpy as np
import numpy.typing as npt
from numpy.typing import NDArray
from scipy.ndimage import map_coordinates

from core.arrays import Floats, frozen
from core.frame import Frame
from core.silhouettes.editing.levels import intensity

NEIGHBOURHOOD_PX = 4.0
"""Standard deviation of the neighbourhood whose intensity an edge is measured against, so that a
dull panel's edge attracts as much as a bright one's."""

SMOOTHING_PX = {"radar": 1.5, "optical": 1.0}
"""Standard deviations that even out speckle and noise before edges are looked for."""

BACKGROUND = 10.0
"""Edges are measured against this many times the frame's median intensity at the least, or the
noise would be full of them."""

GLINT = 1.25
"""What is brighter than this many times its neighbourhood is cut to it: a glint's flanks within
the target are no edge. Less draws the wire outward, more draws it to the glints."""

WEAKEST = 0.1
"""Crests of the gradient below this share of its highest are no edges."""


class Livewire:
    """Paths along the edges of one frame, from one anchor to anywhere.

    Finding edges and all the paths from an anchor takes a tenth of a second on 512 × 512 pixels;
    a path from the same anchor to elsewhere takes next to nothing, as dragging needs.

    Raises:
        ValueError: a frame without any signal.

    Source: Mortensen and Barrett, "Intelligent scissors for image composition", 1995, as in
    OpenCV. The edges are crests of the intensity's gradient over the intensity near by.
    """

    def __init__(self, frame: Frame) -> None:
        self._shape = frame.shape
        self._scissors = cv2.segmentation.IntelligentScissorsMB()
        self._scissors.applyImageFeatures(*_edges(frame))
        self._anchor: tuple[int, int] | None = None

    def path(self, start_px: npt.ArrayLike, end_px: npt.ArrayLike) -> Floats:
        """Return the pixels (points, 2) as (row, column) along the edge, both ends included.

        Args:
            start_px: (2,) the anchor, rounded to its pixel.
            end_px: (2,) where to, likewise.

        Raises:
            ValueError: a place outside the image.
        """
        start, end = self._pixel(start_px), self._pixel(end_px)
        if start != self._anchor:
            self._scissors.buildMap(start[::-1])
            self._anchor = start
        path: Floats = self._scissors.getContour(end[::-1]).reshape(-1, 2)[:, ::-1].astype(float)
        return path

    def _pixel(self, place_px: npt.ArrayLike) -> tuple[int, int]:
        row, column = np.floor(frozen(place_px, np.float64, (2,), "An anchor") + 0.5)
        if not (0 <= row < self._shape[0] and 0 <= column < self._shape[1]):
            raise ValueError(
                f"The anchor ({row:g}, {column:g}) lies outside the image of {self._shape[0]} × "
                f"{self._shape[1]} pixels."
            )
        return int(row), int(column)


def livewire(frame: Frame, anchors_px: npt.ArrayLike, *, closed: bool = False) -> Floats:
    """Return the path (points, 2) as (row, column) along the edges between anchors, in order.

    It runs from pixel to pixel; `snapped` puts it between them. A closed one does not repeat its
    first point and can be given to `combined` as a polygon. Among speckle it takes short cuts
    through the target where anchors are far apart; set them at corners.

    Args:
        frame: either sensor's.
        anchors_px: (anchors, 2) as (row, column), at least two.
        closed: whether it goes on from the last anchor to the first.

    Raises:
        ValueError: fewer than two anchors, one outside the image, or a dark frame.
    """
    anchors = frozen(anchors_px, np.float64, (None, 2), "The anchors")
    if len(anchors) < 2:
        raise ValueError(f"A livewire needs at least two anchors, got {len(anchors)}.")
    wire = Livewire(frame)
    stops = [*anchors, anchors[0]] if closed else list(anchors)
    pieces = [wire.path(start, end) for start, end in pairwise(stops)]
    path = np.concatenate([pieces[0][:1], *(piece[1:] for piece in pieces)])
    return path[:-1] if closed and len(path) > 1 else path


def _edges(
    frame: Frame,
) -> tuple[NDArray[np.uint8], NDArray[np.float32], NDArray[np.float32]]:
    """Return what is no edge, the gradient's direction as (column, row), and the cost of a step."""
    level = intensity(frame, SMOOTHING_PX[frame.sensor])
    around = cv2.GaussianBlur(level, (0, 0), NEIGHBOURHOOD_PX)
    around += BACKGROUND * float(np.median(level)) + np.finfo(float).tiny
    level = np.minimum(level, GLINT * around)
    gradient = np.stack([cv2.Scharr(level, cv2.CV_64F, 1, 0), cv2.Scharr(level, cv2.CV_64F, 0, 1)])
    gradient /= around
    steepness = np.hypot(*gradient)
    highest = max(float(steepness.max()), np.finfo(float).tiny)
    uphill = gradient / np.maximum(steepness, 1e-12 * highest)
    places = np.indices(level.shape) + uphill[::-1], np.indices(level.shape) - uphill[::-1]
    ahead, behind = (map_coordinates(steepness, place, order=1) for place in places)
    crest = (steepness >= ahead) & (steepness >= behind) & (steepness > WEAKEST * highest)
    return (
        (~crest).astype(np.uint8),
        np.ascontiguousarray(np.moveaxis(uphill, 0, -1), dtype=np.float32),
        (1 - steepness / highest).astype(np.float32),
    )
