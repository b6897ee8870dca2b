"""Which pass to observe next, from the present hull and the passes' predicted geometry alone."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, HalfspaceIntersection

from core.arrays import Floats
from core.geometry.grid import VoxelGrid
from core.geometry.projection import Projection
from core.geometry.track import LineOfSightTrack
from core.hull.shadow import filled_away_from_radar
from core.hull.view import View
from core.measurement.observability import Observability
from core.radar.intervals import CoherentInterval
from core.silhouettes.silhouette import Silhouette

SUPPORT = 1.5
"""Voxels within which a cell's nearest voxels count as what returned its first echo."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Aspect:
    """Axes of a range-Doppler image, which an orbit predicts before the pass.

    Attributes:
        line_of_sight: (3,) unit vector k, target frame.
        cross_range: (3,) unit vector along dk/dt, target frame.
    """

    line_of_sight: Floats
    cross_range: Floats


def predicted_aspects(
    track: LineOfSightTrack, intervals: Sequence[CoherentInterval]
) -> tuple[Aspect, ...]:
    """Return the aspects of the images that intervals of a track will give."""
    aspects = []
    for interval in intervals:
        rate = track.line_of_sight_rate_per_s[interval.middle]
        across = rate / np.linalg.norm(rate)
        k = track.line_of_sight[interval.middle]
        aspects.append(Aspect(line_of_sight=k, cross_range=across))
    return tuple(aspects)


def predicted_view(aspect: Aspect) -> View:
    """Return a view of a ball's lit side, to ask of it which directions a pass would observe."""
    matrix = np.zeros((2, 4))
    matrix[:, :3] = aspect.line_of_sight, aspect.cross_range
    matrix[:, 3] = 4.0
    square = Silhouette(
        rings=(np.array([[2.0, 2.0], [2.0, 6.0], [6.0, 6.0], [6.0, 2.0]]),),
        image_shape=(9, 9),
        claim="lit side",
    )
    return View(silhouette=filled_away_from_radar(square), projection=Projection(matrix=matrix))


def hull_points_m(inside: NDArray[np.bool_], grid: VoxelGrid) -> Floats:
    """Return the centres (n, 3) of a hull's voxels."""
    points: Floats = grid.origin_m + grid.spacing_m * np.argwhere(inside)
    return points


def compact_body(points_m: Floats, seen: Sequence[Aspect], spacing_m: float) -> NDArray[np.bool_]:
    """Return which of a hull's voxels the most compact body fills that explains what was seen.

    A radar's silhouette says where the first echo of every cross-range cell came from, and some
    voxel of the hull must have returned it: of those as near to the radar, the one nearest to the
    hull's centroid is taken. The body is what of the hull lies among all these, in their convex
    hull. Nothing but the hull and the views' directions goes in.

    Args:
        points_m: (n, 3) centres of the hull's voxels.
        seen: aspects of the views that carved it.
        spacing_m: voxel spacing, also the width of a cell.
    """
    offset_m = np.linalg.norm(points_m - points_m.mean(axis=0), axis=1)
    supports = [_supports(points_m, offset_m, aspect, spacing_m) for aspect in seen]
    chosen = points_m[np.unique(np.concatenate(supports))]
    # Whole voxels, not centres: supports of one pass nearly lie in one plane.
    corners = np.stack(np.meshgrid(*[(-0.5, 0.5)] * 3), axis=-1).reshape(-1, 3)
    filled = (chosen[:, None] + spacing_m * corners).reshape(-1, 3)
    inside = np.ones(len(points_m), dtype=np.bool_)
    for *normal, offset in np.unique(ConvexHull(filled).equations.round(9), axis=0):
        inside &= points_m @ np.array(normal) <= 1e-6 * spacing_m - offset
    return inside


def carved_voxels(
    points_m: Floats, body: NDArray[np.bool_], views: Sequence[Aspect], spacing_m: float
) -> NDArray[np.bool_]:
    """Return which of a hull's voxels views would carve under the shadow rule, if `body` were true.

    A voxel goes where it lies nearer to the radar than the body's first echo in its cross-range
    cell, or where that cell has none.

    Args:
        points_m: (n, 3) centres of the hull's voxels.
        body: (n,) which of them are taken to be filled.
        views: aspects of the views to come.
        spacing_m: voxel spacing, also the width of a cell.
    """
    carved = np.zeros(len(points_m), dtype=np.bool_)
    for view in views:
        range_m, cell = _placed(points_m, view, spacing_m)
        nearest_m = np.full(cell.max() + 1, np.inf)
        np.minimum.at(nearest_m, cell[body], range_m[body])
        carved |= range_m < nearest_m[cell] - 1e-9
    return carved & ~body


def ball_hull_volume(observed: Observability, *, radius_m: float, side_m: float) -> float:
    """Return the volume in m³ of the hull that views leave of a ball, cut off by the grid.

    It is the target-free criterion: what the views' geometry alone allows, of the dilution's ball.

    Args:
        observed: of the views.
        radius_m: of the ball.
        side_m: of the cubic grid around it, wider than the ball.
    """
    sides = np.concatenate([np.eye(3), -np.eye(3)])
    planes = np.concatenate(
        [
            np.column_stack([observed.normals, np.full(len(observed.normals), -radius_m)]),
            np.column_stack([sides, np.full(len(sides), -side_m / 2)]),
        ]
    )
    corners = HalfspaceIntersection(planes, np.zeros(3)).intersections
    return float(ConvexHull(corners).volume)


def _placed(points_m: Floats, view: Aspect, spacing_m: float) -> tuple[Floats, NDArray[np.intp]]:
    """Return every point's range and the number of its cross-range cell."""
    range_m: Floats = points_m @ view.line_of_sight
    cell = np.floor(points_m @ view.cross_range / spacing_m).astype(np.intp)
    return range_m, cell - cell.min()


def _supports(
    points_m: Floats, offset_m: Floats, view: Aspect, spacing_m: float
) -> NDArray[np.intp]:
    """Return the number of each cell's support: near the first return, nearest to the middle."""
    range_m, cell = _placed(points_m, view, spacing_m)
    nearest_m = np.full(cell.max() + 1, np.inf)
    np.minimum.at(nearest_m, cell, range_m)
    lit = np.flatnonzero(range_m <= nearest_m[cell] + SUPPORT * spacing_m)
    order = lit[np.lexsort((offset_m[lit], cell[lit]))]
    _, first = np.unique(cell[order], return_index=True)
    supports: NDArray[np.intp] = order[first]
    return supports
