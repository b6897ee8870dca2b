"""Between masks and rings: cleaning a mask, and tracing it."""

import cv2
import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import Polygon
from skimage.measure import find_contours
from skimage.morphology import remove_small_holes, remove_small_objects

from core.arrays import Floats
from core.silhouettes.silhouette import clockwise_area_px


def cleaned_mask(
    mask: NDArray[np.bool_], *, closing_px: int, smallest_part_px: int
) -> NDArray[np.bool_]:
    """Close gaps in a mask and drop specks and pinholes.

    Args:
        mask: (rows, columns).
        closing_px: diameter of the closing disc; 0 or 1 closes nothing.
        smallest_part_px: 8-connected parts and holes of fewer pixels disappear.
    """
    closed = mask.astype(np.uint8)
    if closing_px > 1:
        disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (closing_px, closing_px))
        # Padded, so that the closing of a target at the image's edge does not wrap or clip.
        border = (closing_px, closing_px, closing_px, closing_px)
        padded = cv2.copyMakeBorder(closed, *border, borderType=cv2.BORDER_CONSTANT, value=0)
        closed = cv2.morphologyEx(padded, cv2.MORPH_CLOSE, disc)
        closed = closed[closing_px:-closing_px, closing_px:-closing_px]
    cleaned: NDArray[np.bool_] = closed.astype(bool)
    if smallest_part_px > 1:
        largest = smallest_part_px - 1
        cleaned = remove_small_objects(cleaned, max_size=largest, connectivity=2)
        cleaned = remove_small_holes(cleaned, max_size=largest, connectivity=1)
    return cleaned


def traced_rings(
    level: NDArray[np.float32], threshold: float, *, simplification_px: float = 0.0
) -> tuple[Floats, ...]:
    """Trace where an image (rows, columns) crosses a level, between pixels.

    Diagonal neighbours above the level belong together (8-connected). Outer rings run clockwise
    as seen on the image, holes counter-clockwise; each is (vertices, 2) in (row, column).

    Args:
        level: (rows, columns).
        threshold: the level to trace.
        simplification_px: vertices are left out where the ring moves by at most this.

    Source: Lorensen and Cline's marching squares as in scikit-image's find_contours; Douglas and
    Peucker, 1973, for the simplification, kept from crossing itself by GEOS.
    """
    outside = min(float(level.min()), threshold - 1)
    padded = np.pad(level.astype(np.float64), 1, constant_values=outside)
    rings = []
    for contour in find_contours(padded, threshold, fully_connected="high"):
        closed = contour - 1
        if simplification_px > 0 and len(closed) > 4:
            closed = shapely.get_coordinates(Polygon(closed).simplify(simplification_px))
        ring = _without_repeats(closed[:-1])
        if len(ring) >= 3 and clockwise_area_px(ring) != 0:
            rings.append(np.ascontiguousarray(ring))
    return tuple(rings)


def _without_repeats(ring: Floats) -> Floats:
    kept: Floats = ring[np.any(ring != np.roll(ring, 1, axis=0), axis=1)]
    return kept
