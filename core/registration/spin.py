"""Spin of a target from its silhouettes: the axis and the rate on which all of them agree.

A range-Doppler image knows range and Doppler, not metres across: what a trial spin changes is the
projection of each image, that is its plane and the length of a Doppler cell in it. The images
themselves stay as they were formed: a rate that was some per cent off leaves that share of a
cell's walk and of the quadratic phase in them, which the outlines hardly show.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import minimize
from scipy.spatial import ConvexHull

from core.arrays import Floats, frozen
from core.geometry.projection import Projection
from core.geometry.spin import Spin
from core.hull.threads import in_parallel
from core.hull.view import View
from core.registration.agreement import contours
from core.registration.depth import DistanceMaps, depths_px
from core.registration.extents import extent_equations
from core.silhouettes.silhouette import Silhouette

MOST_MISS_PX = 10.0
"""An extent or an outline's point that is off by more counts as this far off."""
POINTS = 20
"""Of each outline that are held against the hull of the others."""
STEP_PX = 5.0
"""Between the places looked at along a line of sight."""
FIRST_STEPS = (np.deg2rad(4.0), 0.03)
"""Of the search, in tilt and as a share of the rate."""
MOST_TRIALS = 160
TOLERANCE_RAD = np.deg2rad(0.01)
"""Of the axis, where the search ends; of the rate the same share of its first step."""
STRAYING_PX = 0.02
"""What the square of a first step away from the start costs. It decides only where outlines tell
nothing: a wrong axis that they do tell costs ten times that."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SpinningOutline:
    """An outline in range and Doppler, and whence it was seen.

    Attributes:
        silhouette: as found in a range-Doppler image whose centre pixel images the spin's axis
            point, the target frame's origin.
        time_s: of the image, on the time scale of the spin.
        line_of_sight: (3,) unit vector k from radar to target, inertial.
        line_of_sight_rate_per_s: (3,) dk/dt, inertial.
        row_spacing_m: range step between rows.
        column_spacing_m_per_s: range-rate step between columns, λ/2 of the Doppler step in hertz.
    """

    silhouette: Silhouette
    time_s: float
    line_of_sight: Floats
    line_of_sight_rate_per_s: Floats
    row_spacing_m: float
    column_spacing_m_per_s: float

    def __post_init__(self) -> None:
        for name in ("line_of_sight", "line_of_sight_rate_per_s"):
            object.__setattr__(self, name, frozen(getattr(self, name), np.float64, (3,), name))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SpinEstimate:
    """A spin on which silhouettes agree.

    Attributes:
        spin: the estimate.
        miss_px: `extents_miss_px` of it.
        start_miss_px: the same of the start.
        trials: spins tried.
    """

    spin: Spin
    miss_px: float
    start_miss_px: float
    trials: int


def spin_views(outlines: Sequence[SpinningOutline], spin: Spin) -> list[View]:
    """Return the views that outlines are if the target spins so, in its frame.

    Raises:
        ValueError: a line of sight that stands still in the frame of that spin.

    Source: eqs. 5 and 6 of the paper, the rows k/Δr and (2/λ)(dk/dt)/Δf.
    """
    sight, rate = spin.lines_of_sight(
        np.array([each.time_s for each in outlines]),
        np.array([each.line_of_sight for each in outlines]),
        np.array([each.line_of_sight_rate_per_s for each in outlines]),
    )
    return [
        View(silhouette=each.silhouette, projection=_projection(each, k, moving))
        for each, k, moving in zip(outlines, sight, rate, strict=True)
    ]


def _projection(outline: SpinningOutline, k: Floats, moving: Floats) -> Projection:
    rows, columns = outline.silhouette.image_shape
    matrix = np.zeros((2, 4))
    matrix[0, :3] = k / outline.row_spacing_m
    matrix[1, :3] = moving / outline.column_spacing_m_per_s
    matrix[:, 3] = rows // 2, columns // 2
    return Projection(matrix=matrix)


def extents_miss_px(outlines: Sequence[SpinningOutline], spin: Spin) -> float:
    """Return by how many pixels extents disagree that two views must share, on average.

    It looks at tips only, costs a tenth of `SpinAgreement`, and on echoes its minimum lies as near
    the true spin (0.15° against 0.2°).
    """
    views = spin_views(outlines, spin)
    equations = extent_equations(views)
    left = equations.left_px(np.zeros((len(views), 2)))
    told = (equations.sign == 0) | (equations.sign * left < 0)
    return float(np.mean(np.minimum(np.abs(left) * told, MOST_MISS_PX)))


class SpinAgreement:
    """How well outlines agree with the hull that all others carve, for any spin."""

    def __init__(self, outlines: Sequence[SpinningOutline], near: Spin) -> None:
        """Prepare the outlines; `near` says how far the target may reach.

        Raises:
            ValueError: fewer than three outlines, or an empty one.
        """
        _check(outlines)
        self.outlines = tuple(outlines)
        views = spin_views(self.outlines, near)
        self._maps = DistanceMaps.of(views)
        self._points = [_thinned(each.points) for each in contours(views, self._maps)]
        self._reach_m = 1.2 * max(
            float(np.linalg.norm(view.projection.plane_points(points), axis=1).max(initial=0.0))
            for view, points in zip(views, self._points, strict=True)
        )
        # Views that follow each other look alike; a distant one ends the search of a miss sooner.
        self._order = np.random.default_rng(0).permutation(len(views)).astype(np.int64)

    def __call__(self, spin: Spin) -> float:
        """Return the agreement: 1 where every outline's carving points touch the others' hull.

        A point whose line of sight misses that hull takes away in proportion, down to 0 where all
        miss by `MOST_MISS_PX` or more. A hull that is larger than an outline takes nothing: it
        may just be loose there.

        Source: the silhouette coherence of Hernández, Schmitt and Cipolla, 2007.
        """
        miss = np.clip(-np.concatenate(self.depths_px(spin)), 0, MOST_MISS_PX)
        return 1 - float(np.mean(miss)) / MOST_MISS_PX

    def depths_px(self, spin: Spin) -> list[Floats]:
        """Return for each outline how deep its points' lines of sight run in the others' hull."""
        views = spin_views(self.outlines, spin)
        matrices = np.array([view.projection.matrix for view in views])
        step_m = STEP_PX * min(each.row_spacing_m for each in self.outlines)
        along_m = np.arange(-self._reach_m, self._reach_m + step_m, step_m)

        def of_view(number: int) -> Floats:
            projection = views[number].projection
            lines_m = projection.plane_points(self._points[number])
            steps_m = along_m[:, None] * projection.viewing_direction()
            others = self._order[self._order != number]
            return depths_px(lines_m, steps_m, matrices, others, self._maps)

        return in_parallel(of_view, range(len(views)))


def _thinned(points: Floats) -> Floats:
    count = min(POINTS, len(points))
    thinned: Floats = points[np.linspace(0, len(points) - 1, count).round().astype(int)]
    return thinned


def estimate_spin(outlines: Sequence[SpinningOutline], start: Spin) -> SpinEstimate:
    """Return the spin on which the extents of silhouettes agree best, from a rough start.

    What the stations cannot tell stays near the start: a turn of the axis about a line of sight
    that never moves changes no radar image.

    Args:
        outlines: three or more, none of them empty, whose translation is known.
        start: a rough spin: its axis some 10° off at most, and its rate by so much that its
            attitude is off by a few tens of degrees at most in any image.

    Raises:
        ValueError: fewer than three outlines, an empty one, or a start without a rate.

    Source: Nelder and Mead, 1965, for the search; Cipolla and Giblin, 2000, for extents along the
    line in which two image planes meet.
    """
    _check(outlines)
    if start.rate_rad_per_s == 0:
        raise ValueError("The start must spin: its rate is scaled by the search and is 0 rad/s.")
    tilt_rad, share = FIRST_STEPS
    tips = [_tips_alone(each) for each in outlines]

    def spin_at(unknowns: Floats) -> Spin:
        return start.changed(tilt_rad * unknowns[:2], 1 + share * float(unknowns[2]))

    def cost(unknowns: Floats) -> float:
        straying = STRAYING_PX * float(unknowns @ unknowns)
        return extents_miss_px(tips, spin_at(unknowns)) + straying

    searched = minimize(
        cost,
        np.zeros(3),
        method="Nelder-Mead",
        options={
            "initial_simplex": np.vstack([np.zeros(3), np.eye(3)]) - 0.25,
            "xatol": TOLERANCE_RAD / tilt_rad,
            "fatol": 1e-4,
            "maxfev": MOST_TRIALS,
        },
    )
    spin = spin_at(searched.x)
    return SpinEstimate(
        spin=spin,
        miss_px=extents_miss_px(tips, spin),
        start_miss_px=extents_miss_px(tips, start),
        trials=int(searched.nfev),
    )


def _tips_alone(outline: SpinningOutline) -> SpinningOutline:
    """Return an outline's convex hull, which has the same extents in every spin's frame."""
    points = np.concatenate(outline.silhouette.rings)
    hull = points[ConvexHull(points).vertices]
    return replace(outline, silhouette=replace(outline.silhouette, rings=(hull,)))


def _check(outlines: Sequence[SpinningOutline]) -> None:
    filled = sum(not each.silhouette.is_empty for each in outlines)
    if filled < 3 or filled < len(outlines):
        raise ValueError(
            "A spin is estimated from at least 3 outlines, none of them empty; of "
            f"{len(outlines)}, {filled} are not."
        )
