"""Agreement of every outline with the hull that all other views carve.

A true outline just touches the others' hull: lines of sight through it graze that hull. Where
they run deep the hull is not tight, which tells nothing; where they miss it, a frame stands wrong.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import map_coordinates

from core.arrays import Floats
from core.hull.threads import in_parallel
from core.hull.view import View
from core.registration.depth import DistanceMaps, depths_px
from core.registration.solution import ContourEquations

POINT_SPACING_PX = 3.0
"""Between points on an outline: a resolution cell, nearer ones err alike."""
STEP_PX = 2.0
"""Between the places looked at along a line of sight."""
CARVING_EDGE_PX = 0.8
"""An outline's points that carve stand this near the edge of its filled silhouette; behind the
first return nothing is carved."""
WEIGHT = 0.3
"""Of a point on an outline beside an extent: the hull is loose in places, extents are not."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Contour:
    """Points on one view's outline where it carves.

    Attributes:
        points: (points, 2) as (row, column).
        inward: (points, 2) unit vectors into the silhouette.
    """

    points: Floats
    inward: Floats


def contours(views: Sequence[View], maps: DistanceMaps) -> list[Contour]:
    """Return the carving points of every view's outline."""
    return [_contour(view, maps, number) for number, view in enumerate(views)]


def _contour(view: View, maps: DistanceMaps, number: int) -> Contour:
    points = np.concatenate([_along(ring) for ring in view.silhouette.rings])
    image = maps.image(number)
    place = (points - maps.corner[number]).T
    slopes = np.stack([map_coordinates(part, place, order=1) for part in np.gradient(image)], 1)
    steepness = np.linalg.norm(slopes, axis=1)
    carves = np.abs(map_coordinates(image, place, order=1)) < CARVING_EDGE_PX
    carves &= steepness > 0.5
    return Contour(points=points[carves], inward=slopes[carves] / steepness[carves, None])


def _along(ring: Floats) -> Floats:
    """Return evenly spaced points on a closed ring (vertices, 2)."""
    closed = np.concatenate([ring, ring[:1]])
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(closed, axis=0), axis=1))])
    count = max(3, round(length[-1] / POINT_SPACING_PX))
    place = (np.arange(count) + 0.5) / count * length[-1]
    return np.column_stack([np.interp(place, length, closed[:, axis]) for axis in range(2)])


def hull_depths_px(
    views: Sequence[View],
    outlines: Sequence[Contour],
    maps: DistanceMaps,
    offsets_px: Floats,
    is_bad: NDArray[np.bool_],
) -> list[Floats]:
    """Return for every view how deep its outline's lines of sight run in the others' hull.

    Args:
        views: as they came.
        outlines: their carving points.
        maps: of their distances.
        offsets_px: (views, 2) to register them by.
        is_bad: (views,) which carve nothing.
    """
    matrices = np.array([view.projection.matrix for view in views])
    matrices[:, :, 3] += offsets_px
    centre_m, reach_m, pixel_m = _whereabouts(outlines, matrices)
    share = np.linspace(-1, 1, 1 + 2 * int(np.ceil(reach_m / (STEP_PX * pixel_m))))
    # Views that follow each other look alike; a distant one ends the search of a miss sooner.
    carvers = np.random.default_rng(0).permutation(np.flatnonzero(~is_bad))

    def of_view(number: int) -> Floats:
        inverse = np.linalg.pinv(matrices[number, :, :3])
        blind = np.cross(matrices[number, 0, :3], matrices[number, 1, :3])
        blind /= np.linalg.norm(blind)
        lines = (outlines[number].points - matrices[number, :, 3]) @ inverse.T
        lines += blind * (centre_m @ blind)
        others = carvers[carvers != number].astype(np.int64)
        return depths_px(lines, share[:, None] * reach_m * blind, matrices, others, maps)

    return in_parallel(of_view, range(len(views)))


def _whereabouts(outlines: Sequence[Contour], matrices: Floats) -> tuple[Floats, float, float]:
    """Return a centre (3,) of what the outlines show, how far it may reach, and a pixel, metres."""
    middle = np.concatenate([0.5 * (o.points.min(0) + o.points.max(0)) for o in outlines])
    matrix = matrices[:, :, :3].reshape(-1, 3)
    wanted = middle - matrices[:, :, 3].ravel()
    centre = np.asarray(np.linalg.lstsq(matrix, wanted)[0], dtype=np.float64)
    pixel_m = float(np.median(1 / np.linalg.norm(matrix, axis=1)))
    widest = max(float(np.linalg.norm(np.ptp(o.points, axis=0))) for o in outlines)
    return centre, 0.75 * widest * pixel_m, pixel_m


def contour_equations(
    outlines: Sequence[Contour], depths: Sequence[Floats], offsets_px: Floats, looseness_px: float
) -> ContourEquations:
    """Return what moves each outline onto the hull of the others.

    Args:
        outlines: of all views.
        depths: of their lines of sight.
        offsets_px: (views, 2) by which they were registered.
        looseness_px: depth of a line on the whole: the hull is larger than the target everywhere,
            and that is no frame's offset.
    """
    of = np.repeat(np.arange(len(outlines)), [len(outline.points) for outline in outlines])
    inward = np.concatenate([outline.inward for outline in outlines])
    value = np.concatenate(depths) - looseness_px + np.sum(inward * offsets_px[of], axis=1)
    return ContourEquations(view=of, slope=inward, value_px=value, weight=WEIGHT)
