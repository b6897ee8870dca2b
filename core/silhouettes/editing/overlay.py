"""Areas laid over an outline, with every vertex that they do not touch left as it is."""

from typing import Literal

import numpy as np
import shapely

from core.arrays import Floats
from core.silhouettes.areas import area_of, rings_of

Operation = Literal["add", "subtract", "intersect"]

_OVERLAYS = {
    "add": shapely.union,
    "subtract": shapely.difference,
    "intersect": shapely.intersection,
}

SLIVER_PX = 1e-6
"""Parts and holes of less area, in square pixels, are crumbs of an operation and disappear."""


def overlaid(
    rings: tuple[Floats, ...], area: shapely.Geometry, operation: Operation
) -> tuple[Floats, ...]:
    """Return the outline with a polygonal area joined to it or cut out of it.

    Rings that stay what they were keep their place, start and vertices to the last bit.

    Raises:
        ValueError: another operation than those of `combined`.
    """
    if operation not in _OVERLAYS:
        raise ValueError(
            f'An outline is combined by "add", "subtract" or "intersect", not "{operation}".'
        )
    return kept_in_place(
        rings, rings_of(_without_slivers(_OVERLAYS[operation](area_of(rings), area)))
    )


def repaired(rings: tuple[Floats, ...]) -> tuple[Floats, ...]:
    """Return rings that neither cross nor touch along a line; valid ones as they are."""
    return kept_in_place(rings, rings_of(_without_slivers(area_of(rings))))


def kept_in_place(before: tuple[Floats, ...], after: tuple[Floats, ...]) -> tuple[Floats, ...]:
    """Return the rings of `after`, those that are also in `before` first, in its order and form.

    Geometry libraries start and order rings as they like. A ring counts as the same if it has the
    same vertices in the same cyclic order.
    """
    new = {_cyclic(ring): ring for ring in after}
    kept = [ring for ring in before if new.pop(_cyclic(ring), None) is not None]
    return (*kept, *new.values())


def _cyclic(ring: Floats) -> bytes:
    """Return bytes that are equal for rings that differ by their start and repeats alone."""
    distinct = ring[np.any(ring != np.roll(ring, 1, axis=0), axis=1)]
    # Adding zero turns −0 into 0.
    first = np.lexsort((distinct[:, 1], distinct[:, 0]))[:1]
    return bytes((np.roll(distinct, -int(first[0]) if len(first) else 0, axis=0) + 0.0).tobytes())


def _without_slivers(area: shapely.Geometry) -> shapely.Geometry:
    parts = [part for part in shapely.get_parts(area) if part.area > SLIVER_PX]
    return shapely.MultiPolygon([_without_slits(part) for part in parts])


def _without_slits(part: shapely.Polygon) -> shapely.Polygon:
    holes = [hole for hole in part.interiors if shapely.Polygon(hole).area > SLIVER_PX]
    return part if len(holes) == len(part.interiors) else shapely.Polygon(part.exterior, holes)
