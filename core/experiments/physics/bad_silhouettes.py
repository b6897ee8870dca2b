"""Silhouettes spoilt as they are in practice, for stages that must bear them."""

from dataclasses import replace

import shapely

from core.hull.view import View
from core.silhouettes.areas import rings_of


def cut_in_half(view: View) -> View:
    """Return the view with the half of its silhouette at greater cross-range cut off."""
    shape = _shape(view)
    low_row, low, high_row, high = shape.bounds
    return _with_shape(
        view, shape.intersection(shapely.box(low_row, low, high_row, (low + high) / 2))
    )


def streaked(view: View) -> View:
    """Return the view with a streak of sidelobes along range through its middle, 6 pixels wide."""
    shape = _shape(view)
    middle = shape.centroid
    streak = shapely.box(middle.x - 100, middle.y - 3, middle.x + 100, middle.y + 3)
    return _with_shape(view, shape.union(streak))


def _shape(view: View) -> shapely.Geometry:
    return shapely.union_all(
        [shapely.make_valid(shapely.Polygon(ring)) for ring in view.silhouette.rings]
    )


def _with_shape(view: View, shape: shapely.Geometry) -> View:
    return replace(view, silhouette=replace(view.silhouette, rings=rings_of(shape)))
