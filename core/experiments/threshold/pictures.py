"""Pictures of what wrong frames do to a hull, and of its repair."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure as Canvas

from core.experiments.pictures import Picture
from core.experiments.threshold.trials import BLAME, METHODS, Trial
from core.hull.shadow import CarvingRule

Trials = Mapping[tuple[CarvingRule, int], Sequence[Trial]]
"""By rule and number of wrong frames, one trial for each draw of them."""

COLOURS = ("#ff7a59", "#ffb454", "#ffd98a", "#b48ead", "#58b4ff")


def mean_of(trials: Sequence[Trial], method: str, attribute: str) -> float:
    """Return the mean IoU or coverage of a method over draws."""
    return float(np.mean([getattr(t.outcomes[method].agreement, attribute) for t in trials]))


def curves_picture(trials: Trials) -> Picture:
    """Picture IoU and coverage by the shadow rule, and what blame finds, by wrong frames."""
    counts = sorted({count for rule, count in trials if rule == "shadow"})
    shadow = [trials["shadow", count] for count in counts]

    def draw(canvas: Canvas) -> None:
        iou, coverage, frames = canvas.subplots(1, 3)
        for cell, attribute, title in (
            (iou, "intersection_over_union", "IoU"),
            (coverage, "coverage", "coverage of the truth"),
        ):
            for method, colour in zip(METHODS, COLOURS, strict=True):
                values = [mean_of(each, method, attribute) for each in shadow]
                width = 2.4 if method == BLAME else 1.4
                cell.plot(counts, values, "o-", color=colour, label=method, linewidth=width)
            cell.set(xlabel="wrong frames", ylim=(0, 1.03), title=title)
        coverage.legend(loc="lower left")
        found = [float(np.mean([t.found for t in each])) for each in shadow]
        false = [float(np.mean([t.falsely_accused for t in each])) for each in shadow]
        frames.plot(counts, counts, ":", color="#aab4c3", label="wrong frames")
        frames.plot(counts, found, "o-", color=COLOURS[-1], label="wrong ones excluded")
        frames.plot(counts, false, "o-", color=COLOURS[0], label="right ones excluded")
        frames.set(xlabel="wrong frames", title="what blame excludes")
        frames.legend()

    return Picture(
        name="threshold-curves",
        caption="Shadow rule, wrong frames of all kinds in turn, mean over draws: IoU and coverage "
        "with all votes, with some misses tolerated, and after blame; and what blame excludes.",
        draw=draw,
        size_in=(14.0, 4.4),
    )
