"""Sensitivity of a hull to its outlines: every silhouette larger or smaller by k cells.

If all outlines lie within k cells of the true ones, the true silhouettes lie between the eroded
and the dilated ones, and the hull of the true silhouettes between the two hulls: for a volume, or
an extent along a fixed direction, the two values are then bounds and not only a guess.
"""

from collections.abc import Sequence
from dataclasses import replace

import shapely

from core.hull.view import View
from core.silhouettes.areas import area_of, rings_of
from core.silhouettes.silhouette import Silhouette

ARC_SEGMENTS = 4
"""Of a quarter turn around a corner: off a circle of half a cell by less than 0.01 cells."""


def displaced_silhouette(silhouette: Silhouette, cells: float) -> Silhouette:
    """Return the silhouette with its edge moved outward by a number of cells, inward if negative.

    A part narrower than twice an inward step disappears, and a hole that an outward step closes.

    Args:
        silhouette: as it votes; one that is filled behind the first return keeps its filling.
        cells: pixels of its frame, fractions too.
    """
    if silhouette.is_empty or cells == 0:
        return silhouette
    moved = shapely.buffer(area_of(silhouette.rings), cells, quad_segs=ARC_SEGMENTS)
    return replace(silhouette, rings=rings_of(moved))


def displaced_views(views: Sequence[View], cells: float) -> list[View]:
    """Return views with the edge of every silhouette moved outward by `cells`, as a whole."""
    return [
        replace(view, silhouette=displaced_silhouette(view.silhouette, cells)) for view in views
    ]
