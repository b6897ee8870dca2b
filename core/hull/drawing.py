"""Outlines as people and tools draw them, made silhouettes that may carve."""

from collections.abc import Iterable
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from core.arrays import Floats, frozen
from core.hull.outline import closed_rings, enclosed_area, what_was_repaired
from core.hull.outset import prepared
from core.silhouettes.areas import rings_of
from core.silhouettes.silhouette import Claim, Silhouette

MOST_RINGS = 200
MOST_VERTICES = 20_000

MARGIN_IMAGES = 1.0
"""How far outside an image a vertex may lie, in image heights and widths: a target may leave it."""


def drawn_silhouette(
    rings: Iterable[ArrayLike],
    *,
    image_shape: tuple[int, int],
    claim: Claim,
    component: str = "target",
    provenance: str = "",
) -> tuple[Silhouette, str]:
    """Return the silhouette of drawn rings, and what was repaired, in a sentence or empty.

    Rings may run either way: one within another is its hole. Where rings cross themselves or each
    other they are split. No rings at all are a frame that shows no target.

    Args:
        rings: each (vertices, 2) as (row, column), not repeated at the end.
        image_shape: (rows, columns) of the frame that they are drawn in.
        claim: whether they show the lit side only.
        component: what they outline.
        provenance: how they came to be.

    Raises:
        ValueError: too many rings or vertices, fewer than three vertices, a vertex that is not
            finite or far outside the image, or no area.
    """
    outlines = [_checked(ring, number, image_shape) for number, ring in enumerate(rings, start=1)]
    vertices = sum(map(len, outlines))
    if len(outlines) > MOST_RINGS or vertices > MOST_VERTICES:
        raise ValueError(
            f"An outline may have at most {MOST_RINGS} rings and {MOST_VERTICES:,} vertices; "
            f"got {len(outlines)} rings and {vertices:,} vertices. Simplify it first."
        )
    kept, repair = _valid(tuple(outlines))
    silhouette = Silhouette(
        rings=kept,
        image_shape=image_shape,
        claim=claim,
        component=component,
        provenance=provenance,
    )
    return silhouette, repair


def _checked(ring: ArrayLike, number: int, image_shape: tuple[int, int]) -> Floats:
    points: Floats = frozen(ring, np.float64, (None, 2), f"Ring {number} of the outline")
    if len(points) < 3:
        raise ValueError(
            f"Ring {number} of the outline has {len(points)} vertices; at least 3 are needed."
        )
    size = np.array(image_shape)
    outside = np.any((points < -MARGIN_IMAGES * size) | (points > (1 + MARGIN_IMAGES) * size), 1)
    if outside.any():
        row, column = points[np.argmax(outside)]
        raise ValueError(
            f"Ring {number} of the outline has a vertex at row {row:g}, column {column:g}, far "
            f"outside the image of {image_shape[0]} × {image_shape[1]} pixels."
        )
    return points


def _valid(rings: tuple[Floats, ...]) -> tuple[tuple[Floats, ...], str]:
    """Return the rings turned as silhouettes have them, split where they cross, and a sentence."""
    if not rings:
        return (), ""
    points, offsets = closed_rings(rings)
    if prepared(points, offsets):
        return tuple(points[a : b - 1] for a, b in pairwise(offsets)), ""
    area, _ = enclosed_area(rings)
    return rings_of(area), what_was_repaired(rings, area.area)
