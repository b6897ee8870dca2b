"""What an analyst does to an outline, at random but repeatable."""

from collections.abc import Iterator

import numpy as np
import shapely

from core.arrays import Floats
from core.hull.view import View
from core.silhouettes.silhouette import Silhouette

DRAG_STEPS = 5
DRAG_PX = 2.0


def drags(views: tuple[View, ...], random: np.random.Generator) -> Iterator[tuple[int, View]]:
    """Yield endless (view's number, view): vertices dragged, each in a few steps of a pixel or two.

    Outlines stay valid; what was dragged stays where it was left.
    """
    current = list(views)
    while True:
        number = int(random.integers(len(current)))
        rings = current[number].silhouette.rings
        ring = int(random.integers(len(rings)))
        vertex = int(random.integers(len(rings[ring])))
        for _ in range(DRAG_STEPS):
            step = random.normal(0.0, DRAG_PX, 2)
            dragged = _dragged(current[number], ring, vertex, step)
            if dragged is not None:
                current[number] = dragged
                yield number, dragged


def redrawn(views: tuple[View, ...], random: np.random.Generator) -> Iterator[tuple[int, View]]:
    """Yield endless (view's number, view) with the whole outline moved and scaled a little."""
    while True:
        number = int(random.integers(len(views)))
        rings = views[number].silhouette.rings
        centre = rings[0].mean(axis=0)
        scale, shift = random.uniform(0.96, 1.04), random.normal(0.0, DRAG_PX, 2)
        yield (
            number,
            with_rings(
                views[number], tuple(centre + scale * (ring - centre) + shift for ring in rings)
            ),
        )


def with_rings(view: View, rings: tuple[Floats, ...]) -> View:
    """Return a view with other rings."""
    silhouette = Silhouette(
        rings=rings,
        image_shape=view.silhouette.image_shape,
        claim=view.silhouette.claim,
        component=view.silhouette.component,
    )
    return View(silhouette=silhouette, projection=view.projection)


def _dragged(view: View, ring: int, vertex: int, step: Floats) -> View | None:
    """Return the view with one vertex moved, or None if its outline would cross itself."""
    rings = [np.array(points) for points in view.silhouette.rings]
    rings[ring][vertex] += step
    edges = shapely.MultiLineString([np.vstack([points, points[:1]]) for points in rings])
    if not edges.is_simple:
        return None
    return with_rings(view, tuple(rings))
