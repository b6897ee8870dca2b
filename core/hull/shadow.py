"""The shadow rule: what a one-sided silhouette may carve.

A radar lights only the side of the target that faces it; behind its first return, along range,
the image is dark because the target shades itself. A background pixel may therefore carve only
if no return lies nearer the radar in its cross-range cell. Filling the outline away from the
radar says exactly that, and the vote engine needs to know nothing of it.
"""

from dataclasses import replace
from typing import Literal

import numpy as np
import shapely

from core.arrays import Floats
from core.hull.view import View
from core.silhouettes.areas import area_of, rings_of
from core.silhouettes.silhouette import Silhouette, clockwise_area_px

CarvingRule = Literal["shadow", "strict"]


def carving_view(view: View, rule: CarvingRule) -> View:
    """Return the view as it votes under `rule`.

    "strict" is the paper's: the outline as it stands. "shadow" fills outlines that claim only
    the lit side away from the radar, and leaves complete ones as they are.
    """
    if rule == "strict" or view.silhouette.claim == "complete":
        return view
    return View(silhouette=filled_away_from_radar(view.silhouette), projection=view.projection)


def filled_away_from_radar(silhouette: Silhouette) -> Silhouette:
    """Return the silhouette joined with everything behind it along growing rows.

    The filling reaches ten image heights past the last row, further than any grid.
    """
    if silhouette.is_empty:
        return silhouette
    rows = silhouette.image_shape[0]
    far_row = 10.0 * rows + max(float(ring[:, 0].max()) for ring in silhouette.rings)
    swept = [
        shapely.polygons(_edge_shadows(ring, far_row))
        for ring in silhouette.rings
        if clockwise_area_px(ring) > 0
    ]
    # A ring's inside lies behind its near edges, so their shadows cover it.
    union = shapely.union_all(np.concatenate(swept))
    return Silhouette(
        rings=rings_of(union),
        image_shape=silhouette.image_shape,
        claim="complete",
        component=silhouette.component,
        provenance=f"{silhouette.provenance}, filled away from the radar".lstrip(", "),
    )


def shadow_region(silhouette: Silhouette) -> tuple[Floats, ...]:
    """Return the rings around what the shadow rule adds to a silhouette within its image.

    It is there to be hatched: what the radar cannot know to be empty, and no part of the outline.
    A silhouette that claims to be complete has none.
    """
    if silhouette.claim == "complete" or silhouette.is_empty:
        return ()
    rows, columns = silhouette.image_shape
    image = shapely.box(-0.5, -0.5, rows - 0.5, columns - 0.5)
    filled = shapely.intersection(area_of(filled_away_from_radar(silhouette).rings), image)
    return rings_of(shapely.difference(filled, area_of(silhouette.rings)))


def filled_as_far_as(silhouette: Silhouette, reach_rows: float) -> Silhouette:
    """Return the silhouette joined with what lies behind it up to `reach_rows` along the rows."""
    if silhouette.is_empty:
        return silhouette
    parts = [_edge_shadows(ring, ring[:, 0] + reach_rows) for ring in silhouette.rings]
    shadows = list(shapely.polygons(np.concatenate(parts)))
    # Every ring whole: what is unlit within one is behind its near edge, within reach or not.
    bodies = [shapely.make_valid(shapely.polygons(ring)) for ring in silhouette.rings]
    return replace(
        silhouette,
        rings=rings_of(shapely.union_all([*bodies, *shadows])),
        claim="complete",
        provenance=f"{silhouette.provenance}, filled away from the sun".lstrip(", "),
    )


def _edge_shadows(ring: Floats, far_row: float | Floats) -> Floats:
    """Return the quadrilaterals (n, 5, 2) between each edge and `far_row`, one or per vertex."""
    far = np.column_stack([np.broadcast_to(far_row, len(ring)), ring[:, 1]])
    tail, head = ring, np.roll(ring, -1, axis=0)
    keep = tail[:, 1] != head[:, 1]
    corners = [tail[keep], head[keep], np.roll(far, -1, axis=0)[keep], far[keep]]
    tail = tail[keep]
    quadrilaterals: Floats = np.stack([*corners, tail], axis=1)
    return quadrilaterals
