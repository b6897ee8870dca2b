"""Finding wrong frames by blame alone, and hulls without them."""

from collections.abc import Mapping, Sequence

import numpy as np

from core.experiments.frame_pictures import OutlinedFrame
from core.hull.blame import removed_alone_m3
from core.hull.closed_mesh import Surface
from core.hull.reprojection import uncovered_area_px
from core.hull.votes import VoteCounts

OUTLYING = 5.0
"""Robust standard deviations above the median, beyond which a frame is accused."""

LEAST_M3 = 0.05
"""Added to what each view removes: below it, a thousandth of a satellite, no removal is a fault."""

DEVIATION = 1.4826
"""Standard deviations in one median absolute deviation of a normal distribution."""

MOST_ACCUSED = 0.25
"""Share of the frames that may be excluded: more is no outlier."""


def exclude_causers(volume: VoteCounts) -> list[int]:
    """Exclude the views that blame names, worst first, and return their numbers.

    The view that alone removes most goes if the logarithm of that volume lies more than
    `OUTLYING` robust deviations above the median of all; then blame is computed anew, for what
    two wrong views remove together is blamed on neither while both vote.
    """
    accused: list[int] = []
    most = int(MOST_ACCUSED * volume.view_count)
    while len(accused) < most:
        worst = _outlier(removed_alone_m3(volume), least=LEAST_M3)
        if worst is None:
            break
        volume.exclude(worst)
        accused.append(worst)
    return accused


def sufferers(
    surface: Surface, outlined: Sequence[OutlinedFrame], voting: Sequence[int]
) -> list[int]:
    """Return the numbers of the voting frames whose outlines a hull leaves open by too much.

    Too much is the share of the outline's area that is an outlier by the same rule.
    """
    shares = {}
    for number in voting:
        each = outlined[number]
        open_px = uncovered_area_px(surface, each.frame.projection, each.silhouette)
        shares[number] = open_px / each.silhouette.area_px()
    above = _robust_above(shares, least=1e-3)
    return [number for number in voting if above[number] > OUTLYING]


def _outlier(values: Mapping[int, float], *, least: float) -> int | None:
    above = _robust_above(values, least=least)
    worst = max(above, key=lambda number: above[number])
    return worst if above[worst] > OUTLYING else None


def _robust_above(values: Mapping[int, float], *, least: float) -> dict[int, float]:
    """Return how many robust deviations each logarithm lies above the median."""
    logs = np.log(np.array(list(values.values())) + least)
    off = logs - np.median(logs)
    deviation = DEVIATION * float(np.median(np.abs(off)))
    # Values that mostly agree have no spread; a tenth keeps the least difference from counting.
    return dict(zip(values, (off / max(deviation, 0.1)).tolist(), strict=True))
