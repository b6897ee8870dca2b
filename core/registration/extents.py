"""What two views must agree on: the target's extents along the line in which their planes meet.

A tip of the target that points toward the radar is always lit: whatever shaded it would stand out
further. So a lit side's extent along u is the target's where u points toward the radar, and where
it points away it is the target's or less.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from core.arrays import Floats
from core.hull.view import View

LEAST_SINE = 0.02
"""Of the angle between two image planes: at 1° a tenth of a milliradian in the line of sight turns
the line where they meet by 5 mrad, which moves a tip 8 m off by less than a pixel of 0.06 m."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ExtentEquations:
    """Equations slope_i · offset_i − slope_j · offset_j = difference, one a row.

    Attributes:
        first, second: (rows,) the views i and j.
        first_slope, second_slope: (rows, 2) pixels of extent per pixel of offset.
        difference_px: (rows,) extent seen in i less that in j, in mean pixels.
        sign: (rows,) 0 where both extents are the target's; +1 where only that in i is, so that
            the difference left by the offsets may be positive but not negative; −1 where only
            that in j is.
    """

    first: NDArray[np.intp]
    second: NDArray[np.intp]
    first_slope: Floats
    second_slope: Floats
    difference_px: Floats
    sign: NDArray[np.int8]

    def __len__(self) -> int:
        return len(self.first)

    def left_px(self, offsets_px: Floats) -> Floats:
        """Return the differences (rows,) that offsets (views, 2) leave."""
        first = np.sum(self.first_slope * offsets_px[self.first], axis=1)
        second = np.sum(self.second_slope * offsets_px[self.second], axis=1)
        left: Floats = self.difference_px - first + second
        return left


def extent_equations(views: Sequence[View]) -> ExtentEquations:
    """Return the equations of all pairs of views whose planes meet at an angle.

    Args:
        views: affine ones, each with a silhouette.

    Raises:
        ValueError: an empty silhouette, or a perspective camera.
    """
    for view in views:
        if view.silhouette.is_empty:
            raise ValueError("An empty silhouette has no extents; leave its frame out.")
        if not view.projection.is_affine:
            raise ValueError("Only radar and affine views have a line common to both planes.")
    normals = np.array([view.projection.viewing_direction() for view in views])
    first, second = np.triu_indices(len(views), 1)
    common = np.cross(normals[first], normals[second])
    sine = np.linalg.norm(common, axis=1)
    met = sine > LEAST_SINE
    first, second = np.tile(first[met], 2), np.tile(second[met], 2)
    direction = common[met] / sine[met, None]
    direction = np.concatenate([direction, -direction])
    pixel_m = mean_pixel_m(views)
    rows = [_seen_along(views, of, direction, pixel_m) for of in (first, second)]
    (slope_i, extent_i, whole_i), (slope_j, extent_j, whole_j) = rows
    told = whole_i | whole_j
    return ExtentEquations(
        first=first[told],
        second=second[told],
        first_slope=slope_i[told],
        second_slope=slope_j[told],
        difference_px=(extent_i - extent_j)[told],
        sign=(whole_i.astype(np.int8) - whole_j.astype(np.int8))[told],
    )


def mean_pixel_m(views: Sequence[View]) -> float:
    """Return the median size of the views' pixels on the target, metres."""
    steps = np.concatenate([view.projection.matrix[:2, :3] for view in views])
    return float(np.median(1 / np.linalg.norm(steps, axis=1)))


def _seen_along(
    views: Sequence[View], of: NDArray[np.intp], direction: Floats, pixel_m: float
) -> tuple[Floats, Floats, NDArray[np.bool_]]:
    """Return slopes (rows, 2), extents (rows,) and whether each is the target's own.

    Args:
        views: all.
        of: (rows,) which view.
        direction: (rows, 3) unit vectors in that view's plane, target frame.
        pixel_m: the unit of extents.
    """
    slope, extent = np.empty((len(of), 2)), np.empty(len(of))
    whole = np.empty(len(of), dtype=np.bool_)
    for number, view in enumerate(views):
        rows = np.flatnonzero(of == number)
        matrix = view.projection.matrix
        points = np.concatenate(view.silhouette.rings)
        corners = points[ConvexHull(points).vertices] - matrix[:, 3]
        # u = Aᵀ a, so that u · p = a · (image of p).
        slope[rows] = direction[rows] @ np.linalg.pinv(matrix[:, :3]) / pixel_m
        extent[rows] = (slope[rows] @ corners.T).max(axis=1)
        lit = direction[rows] @ matrix[0, :3] <= 0
        whole[rows] = lit | (view.silhouette.claim == "complete")
    return slope, extent, whole
