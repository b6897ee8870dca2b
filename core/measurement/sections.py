"""Sections of a surface by a plane."""

from collections import defaultdict

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.hull.closed_mesh import Surface


def section_of(
    surface: Surface, through_m: Floats, normal: Floats
) -> tuple[tuple[Floats, ...], float]:
    """Return the closed curves in which a plane cuts a closed surface, and the area within.

    Outer curves run counter-clockwise as seen against the normal, around holes they run clockwise.
    A vertex in the plane counts as above it, so that a face that lies in the plane is no curve,
    and each curve closes because neighbouring faces share its points by number, not by distance.

    Args:
        surface: closed; of several overlapping bodies each counts.
        through_m: (3,) a point in the plane, target frame.
        normal: (3,) unit vector, target frame.

    Returns:
        The curves, each (n, 3) and not repeating its first point, and the area in m².
    """
    above = (surface.vertices_m - through_m) @ normal >= 0
    cut = surface.faces[above[surface.faces].any(axis=1) & ~above[surface.faces].all(axis=1)]
    # Seen along its own sense of turning, a face leaves the upper side once and comes back once.
    leaving, coming = _crossed(cut, above, falling=True), _crossed(cut, above, falling=False)
    start, end = (_points(surface, edges, through_m, normal) for edges in (leaving, coming))
    area_m2 = float(np.cross(start - through_m, end - through_m).sum(axis=0) @ normal / 2)
    return _linked(leaving, coming, start), area_m2


def _crossed(
    faces: NDArray[np.int32], above: NDArray[np.bool_], *, falling: bool
) -> NDArray[np.int32]:
    """Return of each face the edge by which it falls below the plane or rises above it, (n, 2)."""
    ahead = np.roll(faces, -1, axis=1)
    side = above[faces] if falling else ~above[faces]
    other = ~above[ahead] if falling else above[ahead]
    corner = np.argmax(side & other, axis=1)
    rows = np.arange(len(faces))
    edges = np.stack([faces[rows, corner], ahead[rows, corner]], axis=1)
    # From the lower to the higher number, so that both neighbours compute the very same point.
    return np.sort(edges, axis=1)


def _points(
    surface: Surface, edges: NDArray[np.int32], through_m: Floats, normal: Floats
) -> Floats:
    first, second = surface.vertices_m[edges[:, 0]], surface.vertices_m[edges[:, 1]]
    height, other = (first - through_m) @ normal, (second - through_m) @ normal
    points: Floats = first + (height / (height - other))[:, None] * (second - first)
    return points


def _linked(
    leaving: NDArray[np.int32], coming: NDArray[np.int32], start: Floats
) -> tuple[Floats, ...]:
    """Follow the faces from each edge to the next until they are back, and return their starts.

    Where four faces share an edge two curves touch, and either way on is right.
    """
    entering: defaultdict[tuple[int, int], list[int]] = defaultdict(list)
    for number, edge in enumerate(map(tuple, leaving.tolist())):
        entering[edge].append(number)
    onward = list(map(tuple, coming.tolist()))
    unused = [True] * len(onward)
    curves = []
    for first in range(len(onward)):
        curve, number = [], first
        while unused[number]:
            unused[number] = False
            curve.append(number)
            following = entering[onward[number]]
            number = next((other for other in following if unused[other]), number)
        if len(curve) >= 3:
            curves.append(start[curve])
    return tuple(curves)
