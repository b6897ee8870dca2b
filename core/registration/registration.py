"""Registration of all frames of a target together: offsets from what the outlines agree on."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats, frozen
from core.geometry.projection import Projection
from core.hull.view import View
from core.registration.agreement import contour_equations, contours, hull_depths_px
from core.registration.depth import DistanceMaps
from core.registration.extents import extent_equations
from core.registration.solution import MOST_BAD, solve, solved

RegistrationRule = Literal["none", "centroid", "agreement"]

REFINEMENTS = 2
"""Rounds of carving and moving; a third moves frames by less than 0.05 pixel rms."""
STICKS_OUT_PX = 4.0
"""An outline further outside the others' hull is not the target's."""
BAD_SHARE = 0.12
"""Of an outline's points that stick out, from which on the silhouette is bad."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Registration:
    """Where every frame stood, as far as its outline and all the others tell.

    One translation of the whole target remains free; of all offsets that differ by one, these
    are the smallest.

    Attributes:
        offsets_px: (views, 2) rows and columns by which each image stood off its projection.
        residual_px: (views,) median distance left between each outline and the others' hull.
        is_bad: (views,) whose silhouettes contradict the others; they moved no other frame.
    """

    offsets_px: Floats
    residual_px: Floats
    is_bad: NDArray[np.bool_]

    def __post_init__(self) -> None:
        views = len(self.is_bad)
        for name, shape in (("offsets_px", (views, 2)), ("residual_px", (views,))):
            array = frozen(getattr(self, name), np.float64, shape, f"Registration's {name}")
            object.__setattr__(self, name, array)

    def projection(self, view: int, projection: Projection) -> Projection:
        """Return the projection of a view moved to where its image stands."""
        return moved(projection, self.offsets_px[view])


def moved(projection: Projection, offset_px: Floats) -> Projection:
    """Return an affine projection whose image is moved by (rows, columns)."""
    matrix = projection.matrix.copy()
    matrix[:, 3] += offset_px
    return Projection(matrix=matrix)


def registered(views: Sequence[View], *, refinements: int = REFINEMENTS) -> Registration:
    """Find the offset of every view from what all of them must agree on.

    First the target's extents along the line in which two image planes meet, for all pairs;
    then, with them, each outline against the hull of all the others.

    Args:
        views: silhouettes as they were seen, with the projections that they should have.
        refinements: rounds of the latter.

    Raises:
        ValueError: fewer than three views, an empty silhouette, or a perspective camera.

    Source: section III.D of the paper names the offsets and takes the centroid. Extents along a
    common direction are the epipolar tangency of Cipolla and Giblin, 2000, for parallel views;
    outlines against the others' hull are the silhouette coherence of Hernández et al., 2007.
    """
    if len(views) < 3:
        raise ValueError(
            f"Registration needs at least 3 views that show a target, {len(views)} do."
        )
    extents = extent_equations(views)
    solution = solved(len(views), extents)
    offsets_px, is_bad = solution.offsets_px, solution.is_bad.copy()
    maps = DistanceMaps.of(views)
    outlines = contours(views, maps)
    for number in range(refinements + 1):
        depths = hull_depths_px(views, outlines, maps, offsets_px, is_bad)
        looseness_px = _looseness_px(depths, is_bad)
        found = is_bad | np.array([_sticks_out(depth - looseness_px) for depth in depths])
        is_bad = found if np.mean(found) <= MOST_BAD else is_bad
        if number < refinements:
            equations = contour_equations(outlines, depths, offsets_px, looseness_px)
            offsets_px = solve(len(views), extents, is_bad, equations)
    residual_px = np.array([float(np.median(np.abs(depth - looseness_px))) for depth in depths])
    return Registration(offsets_px=offsets_px, residual_px=residual_px, is_bad=is_bad)


def _looseness_px(depths: Sequence[Floats], is_bad: NDArray[np.bool_]) -> float:
    good = [depth for depth, bad in zip(depths, is_bad, strict=True) if not bad]
    return float(np.median(np.concatenate(good)))


def _sticks_out(depth_px: Floats) -> bool:
    return len(depth_px) == 0 or float(np.mean(depth_px < -STICKS_OUT_PX)) > BAD_SHARE
