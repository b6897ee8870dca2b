"""Where an outline and the hull's image of it disagree."""

from dataclasses import dataclass

import shapely

from core.arrays import Floats
from core.silhouettes.areas import area_of, rings_of


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Disagreement:
    """What only one of an outline and a reprojection covers.

    Attributes:
        only_outline: rings around what was drawn and the hull does not fill: some other view
            carved it away.
        only_reprojection: rings around what the hull fills and was not drawn.
        only_outline_px, only_reprojection_px: their areas in square pixels.
        overlap: intersection over union of the two, 1 where they agree.
    """

    only_outline: tuple[Floats, ...]
    only_reprojection: tuple[Floats, ...]
    only_outline_px: float
    only_reprojection_px: float
    overlap: float


def disagreement(
    outline: tuple[Floats, ...],
    reprojection: tuple[Floats, ...],
    shadow: tuple[Floats, ...] = (),
) -> Disagreement:
    """Return where an outline and the hull's reprojection differ.

    Args:
        outline: rings as drawn, each (vertices, 2) as (row, column).
        reprojection: rings of the hull's image.
        shadow: rings of what the outline leaves open, as a lit side does behind it; the hull may
            fill it or not, and neither is a difference.
    """
    drawn, seen, either = area_of(outline), area_of(reprojection), area_of(shadow)
    seen = shapely.difference(seen, shapely.difference(either, drawn)) if shadow else seen
    missing, excess = shapely.difference(drawn, seen), shapely.difference(seen, drawn)
    union_px = shapely.union(drawn, seen).area
    return Disagreement(
        only_outline=rings_of(missing),
        only_reprojection=rings_of(excess),
        only_outline_px=missing.area,
        only_reprojection_px=excess.area,
        overlap=shapely.intersection(drawn, seen).area / union_px if union_px > 0 else 1.0,
    )
