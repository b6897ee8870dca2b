"""Intervals: how far a number read off a hull can be trusted, and what that says of it.

Two kinds of error are told apart, because no one method sees both:

- What all outlines have in common (a threshold that moves every edge, a point spread not quite
  taken out) no comparison of frames with each other can show. It is stated as k cells, within
  which the outlines' common edge lies with 95 % confidence; measured on the hulls of the eroded
  and the dilated silhouettes it says how far the number may be off: the **sensitivity**.
- What differs from frame to frame (offsets, speckle, an analyst's hand) shows when frames are left
  out: the delete-a-group **jackknife**.

Being independent of each other the two are added in quadrature, on each side of the number by
itself. The value is not moved: a hull is an intersection, an outer bound, that can only grow when
views are left out, so that every value without a group lies on one side of it. The jackknife's
correction of bias would read all of that as a body still to be carved; but where outlines are
noisy the hull has been carved too far already, because of several bounds the tightest wins, and
the correction would make that worse. Its standard error stands. On average it is not too small
(Efron and Stein, "The jackknife estimate of variance", 1981); with few views, whose choice changes
the hull also without noise, it is too large. Of an extent, which is an extreme of a few frames, it
has the right size but does not settle with more frames, as that of a greatest value never does.

What an interval covers is the number that the same views would give with noise-free outlines. The
body itself may be smaller than that hull: what no view sees, no interval of its outlines contains.
Nor does it hold what is carved away where frames err more by themselves than all of them together
and every view has a veto: of many bounds the tightest then is wrong by more than the interval. An
extent suffers first: with own errors four times the common one, 34 % of a span's intervals held it
(73 % where a voxel may miss three views). Count the frames' own errors into the cells there; the
intervals then are wider than need be.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import stats

from core.arrays import Floats
from core.geometry.grid import VoxelGrid
from core.hull.casting import UNWATCHED, Watch
from core.hull.view import View
from core.measurement.resampling import Grouping, Measure, Resampled, frame_groups, resampled

CONFIDENCE = 0.95

COMMON_EDGE_CELLS = 0.5
"""By how many pixels all outlines may be too large or too small together, with 95 % confidence:
about what is left of a threshold's bias once the point spread has been taken out."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Interval:
    """A number with the interval that sensitivity and jackknife together give it.

    Attributes:
        value: as measured on the hull.
        low, high: ends of the 95 % interval; NaN where none can be stated.
        eroded, dilated: the value with every outline `cells` pixels smaller or larger; NaN if lost.
        standard_error: of the jackknife over groups of frames; NaN if lost without one of them.
        cells: of the sensitivity.
        groups: of frames, each left out once.
        note: why an end cannot be stated, for people to read; empty if both are.
    """

    value: float
    low: float
    high: float
    eroded: float
    dilated: float
    standard_error: float
    cells: float
    groups: int
    note: str = ""

    @property
    def is_stated(self) -> bool:
        """Whether both ends are."""
        return bool(np.isfinite(self.low) and np.isfinite(self.high))

    @property
    def method(self) -> str:
        """What the interval is, for people to read beside it."""
        return (
            f"{100 * CONFIDENCE:g} % interval: outlines ± {self.cells:g} cells, and jackknife "
            f"leaving out {self.groups} groups of frames in turn, added in quadrature"
        )


def measured_intervals(
    views: Sequence[View],
    grid: VoxelGrid,
    measure: Measure,
    *,
    cells: float = COMMON_EDGE_CELLS,
    groups: int = 10,
    grouping: Grouping = "interleaved",
    tolerated_misses: int = 0,
    watch: Watch = UNWATCHED,
) -> tuple[Interval, ...]:
    """Measure numbers on the hull of views, each with its interval.

    Args:
        views: that vote, as they vote (under the shadow rule already filled).
        grid: that they vote on.
        measure: from a surface to numbers (quantities,), NaN for one that is lost.
        cells: by how many pixels all outlines may be off together, with 95 % confidence.
        groups: how many groups of frames are left out in turn; fewer where there are fewer frames.
        grouping: "interleaved", or "consecutive" where neighbours' errors are alike.
        tolerated_misses: as in `ReconstructionSettings`.
        watch: is told how many of the 3 + groups hulls are done, and may cancel between them.

    Raises:
        ValueError: fewer than 3 views, an empty hull, or cells that are not positive.
        Cancelled: `watch` said so.
    """
    return combined(
        resampled(
            views,
            grid,
            measure,
            cells=cells,
            groups=frame_groups(len(views), groups, grouping),
            tolerated_misses=tolerated_misses,
            watch=watch,
        )
    )


def combined(numbers: Resampled) -> tuple[Interval, ...]:
    """Return the interval of each resampled number; the same rule for all of them.

    Source: the factor of the standard error is Student's t with groups − 1 degrees of freedom, as
    for any variance from that many values.
    """
    count = len(numbers.groups)
    errors = jackknife_standard_error(numbers.values, numbers.without_group)
    random = stats.t.ppf(0.5 + 0.5 * CONFIDENCE, count - 1) * errors
    moved = np.stack([numbers.values, numbers.eroded, numbers.dilated])
    below, above = numbers.values - moved.min(axis=0), moved.max(axis=0) - numbers.values
    low = numbers.values - np.hypot(below, random)
    high = numbers.values + np.hypot(above, random)
    return tuple(
        Interval(
            value=float(numbers.values[index]),
            low=float(low[index]),
            high=float(high[index]),
            eroded=float(numbers.eroded[index]),
            dilated=float(numbers.dilated[index]),
            standard_error=float(errors[index]),
            cells=numbers.cells,
            groups=count,
            note=_note(numbers, index),
        )
        for index in range(len(numbers.values))
    )


def jackknife_standard_error(values: Floats, without_group: Floats) -> Floats:
    """Return the delete-a-group jackknife's standard errors (quantities,).

    Groups may differ by one frame. A value that is NaN without one group has no standard error.

    Args:
        values: (quantities,) with all groups.
        without_group: (groups, quantities) values with one group left out.

    Source: Shao and Wu, "A general theory for jackknife variance estimation", 1989, for groups of
    equal size: (G − 1)/G Σ (θ₍g₎ − θ)², which is Efron and Tibshirani's eq. 11.5 ("An
    Introduction to the Bootstrap", 1993) with groups for observations, but about the value with
    all groups instead of the mean of those without one. That form is never the smaller (Wolter,
    "Introduction to Variance Estimation", 2007, section 4.2), and a hull needs it: all its values
    lie on one side, so that their mean is not where the number is.
    """
    count = len(without_group)
    squares: Floats = ((without_group - values) ** 2).sum(axis=0)
    errors: Floats = np.sqrt((count - 1) / count * squares)
    return errors


def _note(numbers: Resampled, index: int) -> str:
    if np.isnan(numbers.values[index]):
        return "lost on the hull itself"
    lost = [
        f"when outlines are {cells:g} cells {size}"
        for values, cells, size in (
            (numbers.eroded, numbers.cells, "smaller"),
            (numbers.dilated, numbers.cells, "larger"),
        )
        if np.isnan(values[index])
    ]
    without = int(np.isnan(numbers.without_group[:, index]).sum())
    if without:
        lost.append(f"without {without} of {len(numbers.groups)} groups of frames")
    return f"no interval: it is lost {' and '.join(lost)}" if lost else ""
