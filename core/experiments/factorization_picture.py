"""The picture of experiment C: errors with more and more points missing."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure as Canvas

from core.arrays import Floats
from core.experiments.lines_found import LinesFound
from core.experiments.pictures import Picture


def missing_picture(missed: Mapping[str, Mapping[float, LinesFound]]) -> Picture:
    """Picture mean length error and worst attitude error over the share that is missing.

    Args:
        missed: by what the curve is called, the lines by the share of points missing from tracks
            or of scatterers missing from echoes.
    """

    def draw(canvas: Canvas) -> None:
        left, right = canvas.subplots(1, 2)
        for name, rows in missed.items():
            shares = [100 * share for share in rows]
            means = [each.mean_error_percent() for each in rows.values()]
            worst = [each.worst_attitude_deg() for each in rows.values()]
            left.plot(shares, _gaps(means), "o-", label=name)
            right.plot(shares, _gaps(worst), "o-", label=name)
        left.set(ylabel="mean length error (%)", xlabel="missing in each frame (%)")
        right.set(ylabel="worst attitude error (°)", xlabel="missing in each frame (%)")
        for axes in (left, right):
            axes.set_ylim(bottom=0)
            axes.legend()

    return Picture(
        name="factorization-missing",
        caption="Errors with points missing from the tracks of the factorization (noise of 0.3 "
        "cells), and with scatterers missing from the echoes that our hull is made of.",
        draw=draw,
        size_in=(10.0, 4.0),
    )


def _gaps(values: Sequence[float | None]) -> Floats:
    return np.array([np.nan if value is None else value for value in values])
