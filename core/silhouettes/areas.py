"""Between rings and areas: what a silhouette's rings enclose, and the rings around an area."""

from itertools import groupby

import numpy as np
import shapely

from core.arrays import Floats
from core.silhouettes.silhouette import clockwise_area_px


def area_of(rings: tuple[Floats, ...]) -> shapely.Geometry:
    """Return the area (row, column) that rings enclose, valid even where they cross or touch.

    Outer rings add and holes take away, the larger before the smaller, so that a part within a
    hole stays.

    Args:
        rings: each (vertices, 2); outer ones clockwise, holes counter-clockwise.
    """
    area: shapely.Geometry = shapely.Polygon()
    larger_first = sorted(rings, key=lambda ring: -abs(clockwise_area_px(ring)))
    # A ring that is alone can be no hole; whoever gave it turned it the wrong way.
    alone = len(rings) == 1
    for outer, group in groupby(larger_first, lambda r: alone or clockwise_area_px(r) > 0):
        parts = shapely.get_parts([shapely.make_valid(shapely.Polygon(ring)) for ring in group])
        enclosed = shapely.union_all(parts[shapely.area(parts) > 0])
        area = shapely.union(area, enclosed) if outer else shapely.difference(area, enclosed)
    return area


def rings_of(geometry: shapely.Geometry) -> tuple[Floats, ...]:
    """Return the rings of a polygonal geometry in (row, column): outer clockwise, holes not."""
    rings: list[Floats] = []
    for part in shapely.get_parts(geometry):
        if part.geom_type != "Polygon" or part.is_empty:
            continue
        rings.append(_turned(np.asarray(part.exterior.coords)[:-1], clockwise=True))
        rings += [_turned(np.asarray(hole.coords)[:-1], clockwise=False) for hole in part.interiors]
    return tuple(rings)


def _turned(ring: Floats, *, clockwise: bool) -> Floats:
    return ring if (clockwise_area_px(ring) > 0) == clockwise else ring[::-1]
