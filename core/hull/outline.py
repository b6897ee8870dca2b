"""Outlines made fit for the sweep: valid, rightly turned, and a hair larger.

The paper counts a point on the outline as inside. Moving every edge outward by a ten-millionth of
a pixel says the same without ever testing for equality: what was on the outline is now inside it.
"""

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from core.arrays import Floats
from core.hull.outset import outset, prepared
from core.silhouettes.areas import area_of, rings_of
from core.silhouettes.silhouette import Silhouette, clockwise_area_px

OUTSET_PX = 1e-7
"""How far outlines are moved outward: far above rounding (1e-12), far below any measurement."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Outline:
    """What the vote engine knows of a silhouette.

    Attributes:
        points: (points, 2) as (row, column), all rings after one another, each closed by its
            first point and run with the inside on its right in (row, column) axes.
        offsets: (rings + 1,) where each ring starts in `points`.
        repair: what had to be repaired, for people to read; empty when nothing was.
    """

    points: Floats
    offsets: NDArray[np.int64]
    repair: str = ""


def outline_of(silhouette: Silhouette) -> Outline:
    """Return the silhouette's outline, repaired if its rings cross or touch, and outset.

    Raises:
        ValueError: the outline encloses no area at all.
    """
    if silhouette.is_empty:
        return Outline(points=np.empty((0, 2)), offsets=np.zeros(1, dtype=np.int64))
    points, offsets = closed_rings(silhouette.rings)
    if prepared(points, offsets):
        grown, starts = outset(points, offsets, OUTSET_PX)
        return Outline(points=grown, offsets=starts)
    return _repaired(silhouette.rings)


def closed_rings(rings: tuple[Floats, ...]) -> tuple[Floats, NDArray[np.int64]]:
    """Return the points of all rings, each with its first point repeated at its end, and starts."""
    points = np.concatenate([row for ring in rings for row in (ring, ring[:1])])
    offsets = np.zeros(len(rings) + 1, dtype=np.int64)
    offsets[1:] = np.cumsum([len(ring) + 1 for ring in rings])
    return points, offsets


def _repaired(rings: tuple[Floats, ...]) -> Outline:
    """Return the outline of the area that crossing or touching rings enclose.

    Raises:
        ValueError: they enclose none.
    """
    area, parts = enclosed_area(rings)
    # Needles without width hold no area, but who stands on one is on the outline. Rings that
    # touch would overlap if each were moved outward alone.
    needles = [part for part in shapely.get_parts(parts) if part.area == 0]
    grown = shapely.buffer(shapely.union_all([area, *needles]), OUTSET_PX, quad_segs=2)
    points, offsets = closed_rings(rings_of(grown))
    repair = what_was_repaired(rings, area.area)
    return Outline(points=points, offsets=offsets, repair=repair)


def enclosed_area(
    rings: tuple[Floats, ...],
) -> tuple[shapely.Geometry, list[shapely.Geometry]]:
    """Return the area that crossing or touching rings enclose, and each ring's made valid.

    Raises:
        ValueError: they enclose none.
    """
    parts = [shapely.make_valid(shapely.Polygon(ring)) for ring in rings]
    enclosed = shapely.get_parts(area_of(rings))
    area = shapely.union_all([part for part in enclosed if part.area > 0])
    if area.is_empty:
        raise ValueError(
            "The outline encloses no area: its vertices coincide or lie on one line. "
            "Draw at least three vertices that are not on a line."
        )
    return area, parts


def what_was_repaired(rings: tuple[Floats, ...], area_px: float) -> str:
    """Return the sentence that tells the analyst; rings that merely touch are nothing to tell."""
    before = abs(sum(clockwise_area_px(ring) for ring in rings))
    if abs(before - area_px) <= 1e-9 * max(before, 1.0):
        return ""
    return (
        "The outline crossed itself; it was split where it does, and what it encloses changed "
        f"from {before:.1f} to {area_px:.1f} square pixels."
    )
