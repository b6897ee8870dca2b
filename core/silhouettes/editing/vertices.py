"""Vertices of an outline moved, put in and taken out, one at a time."""

import numpy as np
import numpy.typing as npt
import shapely

from core.arrays import Floats, frozen
from core.silhouettes.silhouette import clockwise_area_px

Rings = tuple[Floats, ...]


def moved_vertex(rings: Rings, ring: int, vertex: int, to_px: npt.ArrayLike) -> Rings:
    """Return the rings with one vertex elsewhere.

    A ring that this turns inside out is run the other way around, about the vertex that moved,
    which keeps its number: an outer ring stays one, and so does a hole.

    Args:
        rings: each (vertices, 2) as (row, column).
        ring: which ring.
        vertex: which of its vertices.
        to_px: (2,) its new place.

    Raises:
        ValueError: no such ring or vertex, or a place that is not two finite numbers.
    """
    old = _ring_with(rings, ring, vertex)
    new = old.copy()
    new[vertex] = _place(to_px)
    return _with(rings, ring, _turned_like(old, new, 2 * vertex))


def inserted_vertex(rings: Rings, ring: int, vertex: int, at_px: npt.ArrayLike) -> Rings:
    """Return the rings with one more vertex, which gets the number `vertex`.

    It stands between the vertex before and the one that had this number; the number of vertices
    itself puts it between the last and the first. Deleting it again is the identity.

    Args:
        rings: each (vertices, 2) as (row, column).
        ring: which ring.
        vertex: its number from now on.
        at_px: (2,) its place.

    Raises:
        ValueError: no such ring or number, or a place that is not two finite numbers.
    """
    old = _ring_at(rings, ring)
    if not 0 <= vertex <= len(old):
        raise ValueError(
            f"A new vertex of ring {ring} may be number 0 to {len(old)}, not {vertex}."
        )
    new = np.insert(old, vertex, _place(at_px), axis=0)
    return _with(rings, ring, _turned_like(old, new, 2 * vertex))


def deleted_vertex(rings: Rings, ring: int, vertex: int) -> Rings:
    """Return the rings with one vertex less.

    Args:
        rings: each (vertices, 2) as (row, column).
        ring: which ring.
        vertex: which of its vertices.

    Raises:
        ValueError: no such ring or vertex, or a ring of three.
    """
    old = _ring_with(rings, ring, vertex)
    if len(old) <= 3:
        raise ValueError(
            f"Ring {ring} has three vertices, the least that enclose anything; delete the whole "
            "ring instead."
        )
    new = np.delete(old, vertex, axis=0)
    # About the gap, so that this undoes an insertion that turned the ring.
    return _with(rings, ring, _turned_like(old, new, 2 * vertex - 1))


def deleted_ring(rings: Rings, ring: int) -> Rings:
    """Return the rings without one of them; the holes of an outer ring go with it.

    Raises:
        ValueError: no such ring.
    """
    _ring_at(rings, ring)
    return tuple(
        other
        for number, other in enumerate(rings)
        if number != ring and _ring_around(rings, number) != ring
    )


def _ring_around(rings: Rings, number: int) -> int | None:
    """Return the smallest outer ring around a hole, None for outer rings."""
    if clockwise_area_px(rings[number]) > 0:
        return None
    start = shapely.Point(rings[number][0])
    around = {
        clockwise_area_px(ring): other
        for other, ring in enumerate(rings)
        if clockwise_area_px(ring) > 0 and shapely.Polygon(ring).intersects(start)
    }
    return around[min(around)] if around else None


def _turned_like(old: Floats, new: Floats, twice_about: int) -> Floats:
    """Return `new` run the way `old` is, if need be by reflecting numbers about a half of these."""
    if (clockwise_area_px(old) > 0) == (clockwise_area_px(new) > 0):
        return new
    turned: Floats = new[(twice_about - np.arange(len(new))) % len(new)]
    return turned


def _ring_at(rings: Rings, ring: int) -> Floats:
    if not 0 <= ring < len(rings):
        raise ValueError(f"There is no ring {ring}; the outline has {len(rings)}, counted from 0.")
    return rings[ring]


def _ring_with(rings: Rings, ring: int, vertex: int) -> Floats:
    old = _ring_at(rings, ring)
    if not 0 <= vertex < len(old):
        raise ValueError(f"Ring {ring} has no vertex {vertex}; it has {len(old)}, counted from 0.")
    return old


def _place(place_px: npt.ArrayLike) -> Floats:
    return frozen(place_px, np.float64, (2,), "A vertex (row, column)")


def _with(rings: Rings, number: int, ring: Floats) -> Rings:
    return (*rings[:number], ring, *rings[number + 1 :])
