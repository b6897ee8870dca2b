"""How silhouettes agree around the true spin, as a map."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure as Canvas

from core.arrays import Floats
from core.experiments.pictures import Picture
from core.geometry.spin import Spin
from core.registration.spin import SpinningOutline, extents_miss_px

TILT_DEG = 10.0
RATE_PERCENT = 6.0


def landscape_picture(
    outlines: Mapping[str, Sequence[SpinningOutline]], truth: Spin, *, points: int
) -> Picture:
    """Picture by how much extents disagree over errors of a spin.

    Args:
        outlines: by what is written above each row.
        truth: the true spin, in the middle.
        points: along each side of a map.
    """
    tilt_deg = np.linspace(-TILT_DEG, TILT_DEG, points)
    rate_percent = np.linspace(-RATE_PERCENT, RATE_PERCENT, points)
    maps = {
        name: (
            _miss_px(seen, truth, [(tilt_deg, 0), (tilt_deg, 1)]),
            _miss_px(seen, truth, [(tilt_deg, 0), (rate_percent, 2)]),
        )
        for name, seen in outlines.items()
    }

    def draw(canvas: Canvas) -> None:
        cells = canvas.subplots(len(maps), 2, squeeze=False)
        sides = ((tilt_deg, "second tilt of the axis (°)"), (rate_percent, "rate error (%)"))
        for row, (name, both) in zip(cells, maps.items(), strict=True):
            for cell, miss, (across, label) in zip(row, both, sides, strict=True):
                drawn = cell.contourf(across, tilt_deg, miss, 20, cmap="viridis_r")
                cell.grid(visible=False)
                cell.plot(0, 0, "+", color="#ff9a76", markersize=12)
                cell.set(xlabel=label, ylabel="first tilt of the axis (°)", title=name)
                canvas.colorbar(drawn, ax=cell, label="miss (px)")

    return Picture(
        name="spin-landscape",
        caption="Mean disagreement of the extents that pairs of outlines share, in pixels of "
        "0.06 m, over errors of the spin: of the axis in two directions, and of axis and rate. "
        "The cross is the true spin.",
        draw=draw,
        size_in=(10.0, 4.0 * len(maps)),
    )


def _miss_px(
    outlines: Sequence[SpinningOutline], truth: Spin, axes: Sequence[tuple[Floats, int]]
) -> Floats:
    """Return the miss over two of: first tilt (°), second tilt (°), rate error (%)."""
    (down, first), (across, second) = axes
    miss = np.empty((len(down), len(across)))
    for place in np.ndindex(miss.shape):
        error = np.zeros(3)
        error[first], error[second] = down[place[0]], across[place[1]]
        spin = truth.changed(np.deg2rad(error[:2]), 1 + error[2] / 100)
        miss[place] = extents_miss_px(outlines, spin)
    return miss
