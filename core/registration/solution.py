"""Offsets that satisfy as many equations as can be: robust least squares with outlines that lie."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array, vstack
from scipy.sparse.linalg import cg

from core.arrays import Floats
from core.registration.extents import ExtentEquations

TIPS = 24
"""Directions around an image within which the same tip of the target sets the extent."""
TIP_ERROR_PX = 0.6
"""How far a tip in a silhouette stands from the target's, rms; all its equations share it."""
EXTENT_ERROR_PX = 0.3
"""What else sets two extents apart."""
OUTLIER_PX = 1.0
"""Differences beyond this count less and less."""
WRONG_PX = 3.0
"""A difference that no noise makes."""
WRONG_SHARE = 0.35
"""A silhouette is bad when more of its equations are wrong."""
MOST_BAD = 1 / 3
"""Share of the silhouettes that the rest may outvote."""
BAD_WEIGHT = 1e-3
"""Of a bad silhouette's equations: it finds its own place and moves no other."""
CONVEX_ROUNDS = 15
"""Of reweighting, so that the start decides nothing."""
ROUNDS = 40
STEP_TOLERANCE = 1e-6
"""Of each round; the next one makes up for what it leaves."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ContourEquations:
    """Equations slope · offset = value of one view each, from outlines against the hull.

    Attributes:
        view: (rows,) which view.
        slope: (rows, 2).
        value_px: (rows,).
        weight: of every row beside an extent's equation.
    """

    view: NDArray[np.intp]
    slope: Floats
    value_px: Floats
    weight: float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Solution:
    """Offsets of all views.

    Attributes:
        offsets_px: (views, 2) in (row, column), the shortest of all that differ by a translation
            of the target.
        is_bad: (views,) whose extents contradict the others'.
    """

    offsets_px: Floats
    is_bad: NDArray[np.bool_]


def solved(views: int, extents: ExtentEquations) -> Solution:
    """Return the offsets that the extents want, and the silhouettes that contradict the rest.

    The worst silhouette is taken out and the rest solved again until none is bad, or a third of
    them are: then nothing tells which are right.
    """
    is_bad = np.zeros(views, dtype=np.bool_)
    offsets_px = solve(views, extents, is_bad)
    while True:
        found = _worst(views, extents, offsets_px, is_bad)
        if found is None or np.mean(is_bad) >= MOST_BAD:
            return Solution(offsets_px=offsets_px, is_bad=is_bad)
        is_bad[found] = True
        offsets_px = solve(views, extents, is_bad)


def solve(
    views: int,
    extents: ExtentEquations,
    is_bad: NDArray[np.bool_],
    contours: ContourEquations | None = None,
) -> Floats:
    """Return offsets (views, 2) by reweighted least squares, of least norm.

    Args:
        views: how many.
        extents: what pairs of views must agree on.
        is_bad: (views,) whose equations move no other view.
        contours: what single views must agree on with the hull, if it has been carved.

    Every (view, direction) has an error of its own that all its equations share, or twenty
    equations of one tip would count as twenty measurements.

    Source: Holland and Welsch, 1977, for the reweighting; the error of a tip is a random effect.
    """
    rows, wanted = _system(views, extents, contours)
    good = np.where(is_bad[extents.first] | is_bad[extents.second], BAD_WEIGHT, 1.0)
    good /= EXTENT_ERROR_PX**2
    unknowns, left = np.zeros(rows.shape[1]), wanted
    weight = np.concatenate(
        [np.where(extents.sign == 0, good, 0.0), np.ones(len(wanted) - len(extents))]
    )
    for number in range(ROUNDS):
        # Short vectors, one per unknown: with one per row BLAS starts threads for every product.
        weighted = csr_array(rows.multiply(weight[:, None])).T
        step, _ = cg(csr_array(weighted @ rows), weighted @ left, rtol=STEP_TOLERANCE, maxiter=500)
        unknowns += step
        left = wanted - rows @ unknowns
        if number > CONVEX_ROUNDS and np.abs(step[: 2 * views]).max() < 1e-3:
            break
        power = 0.5 if number < CONVEX_ROUNDS else 1.0
        weight[: len(extents)] = _robust(left[: len(extents)], extents.sign, power) * good
        if contours is not None:
            outlines = left[-len(contours.view) :] / OUTLIER_PX
            weight[-len(contours.view) :] = contours.weight / (1 + outlines**2) ** 2
    offsets: Floats = unknowns[: 2 * views].reshape(views, 2)
    return offsets


def _system(
    views: int, extents: ExtentEquations, contours: ContourEquations | None
) -> tuple[csr_array, Floats]:
    """Return rows and wanted values: extents, tips near 0, contours; unknowns: offsets, tips."""
    width = 2 * views + TIPS * views
    signed = ((extents.first, extents.first_slope, 1), (extents.second, extents.second_slope, -1))
    columns, entries = [], []
    for of, slope, sign in signed:
        angle = np.arctan2(slope[:, 1], slope[:, 0])
        tip = np.floor((angle / (2 * np.pi) + 0.5) * TIPS).astype(int) % TIPS
        columns += [2 * of, 2 * of + 1, 2 * views + TIPS * of + tip]
        entries += [sign * slope[:, 0], sign * slope[:, 1], np.full(len(of), float(sign))]
    parts = [_sparse(columns, entries, width)]
    tips = np.arange(2 * views, width)
    parts.append(_sparse([tips], [np.full(len(tips), 1 / TIP_ERROR_PX)], width))
    wanted = [extents.difference_px, np.zeros(len(tips))]
    if contours is not None:
        places = [2 * contours.view, 2 * contours.view + 1]
        parts.append(_sparse(places, list(contours.slope.T), width))
        wanted.append(contours.value_px)
    return csr_array(vstack(parts)), np.concatenate(wanted)


def _sparse(columns: list[NDArray[np.intp]], entries: list[Floats], width: int) -> csr_array:
    """Return rows whose n-th entries stand in `columns[n]`."""
    count = len(columns[0])
    rows = np.tile(np.arange(count), len(columns))
    where = (rows, np.concatenate(columns))
    return csr_array((np.concatenate(entries), where), shape=(count, width))


def _robust(left_px: Floats, sign: NDArray[np.int8], power: float) -> Floats:
    """Return weights that make least squares robust, 0 for one-sided rows that are satisfied.

    Power ½ is a convex loss that grows with the difference, 1 is Cauchy's, which lets go of it.
    """
    weights: Floats = _told(left_px, sign) / (1 + (left_px / OUTLIER_PX) ** 2) ** power
    return weights


def _told(left_px: Floats, sign: NDArray[np.int8]) -> NDArray[np.bool_]:
    told: NDArray[np.bool_] = (sign == 0) | (sign * left_px < 0)
    return told


def _worst(
    views: int, extents: ExtentEquations, offsets_px: Floats, is_bad: NDArray[np.bool_]
) -> int | None:
    """Return the view most of whose equations with good ones are wrong, None if no view is bad."""
    left = extents.left_px(offsets_px)
    counted = _told(left, extents.sign) & ~(is_bad[extents.first] | is_bad[extents.second])
    wrong = counted & (np.abs(left) > WRONG_PX)
    share = _per_view(wrong, extents, views) / np.maximum(_per_view(counted, extents, views), 1)
    worst = int(np.argmax(share))
    return worst if share[worst] > WRONG_SHARE else None


def _per_view(rows: NDArray[np.bool_], extents: ExtentEquations, views: int) -> Floats:
    """Return in how many of the chosen rows every view takes part."""
    both = np.concatenate([extents.first[rows], extents.second[rows]])
    return np.bincount(both, minlength=views).astype(np.float64)
