"""Pictures of the benchmarks' curves; they need matplotlib."""

from collections.abc import Sequence
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure as Picture
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from core.benchmarks.growth import Curve
from core.benchmarks.measuring import fitted_exponent

HULL_ONLY = "exact mesh, hull only"
BEYOND = "hull only"
LABELS = {"voxels": "voxels", "views": "views", "vertices": "vertices of an outline"}


def plot_growth(curves: Sequence[Curve], path: Path) -> None:
    """Write a PNG with time and memory against voxels, views and vertices on logarithmic axes.

    Raises:
        ValueError: the file cannot be written.
    """
    picture = Picture(figsize=(4.5 * len(curves), 7.5), layout="constrained")
    panels = picture.subplots(2, len(curves), squeeze=False, sharex="col")
    for column, curve in enumerate(curves):
        _draw(panels[0, column], curve, _times(curve), "time [s]")
        _draw(panels[1, column], curve, _memory(curve), "peak memory [MB]")
        panels[1, column].set_xlabel(LABELS[curve.of])
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        picture.savefig(path, dpi=120)
    except OSError as error:
        raise ValueError(f"{path} could not be written: {error.strerror}.") from error


def _times(curve: Curve) -> dict[str, list[float]]:
    return {
        "all votes": [point.votes_s for point in curve.points],
        "exact mesh of them": [point.mesh_s for point in curve.points],
        HULL_ONLY: [point.hull_only.seconds for point in curve.points],
        BEYOND: [point.seconds for point in curve.beyond],
    }


def _memory(curve: Curve) -> dict[str, list[float]]:
    return {
        "all votes and mesh": [point.peak_bytes / 1e6 for point in curve.points],
        HULL_ONLY: [point.hull_only.peak_bytes / 1e6 for point in curve.points],
        BEYOND: [point.peak_bytes / 1e6 for point in curve.beyond],
    }


def _draw(axes: Axes, curve: Curve, curves: dict[str, list[float]], what: str) -> None:
    amounts = [point.amount for point in curve.points]
    for name, values in curves.items():
        if name != BEYOND:
            colour = "C2" if name == HULL_ONLY else None
            label = _label(name, amounts, values)
            axes.loglog(amounts, values, marker="o", color=colour, label=label)
        elif values:
            voxels = [point.voxels for point in curve.beyond]
            sizes = ", ".join(point.size for point in curve.beyond)
            axes.loglog(voxels, values, "D", color="C2", label=f"{name}, {sizes}")
    # Decades alone leave a narrow axis without a number.
    drawn = [value for values in curves.values() for value in values]
    axes.set(ylabel=what, ylim=(min(drawn) / 1.6, 1.6 * max(drawn)))
    narrow = [axes.yaxis] if curve.of == "voxels" else [axes.xaxis, axes.yaxis]
    for axis in narrow:
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.set_minor_formatter(NullFormatter())
    axes.grid(which="major", alpha=0.4)
    axes.legend(fontsize="small")


def _label(name: str, amounts: list[float], values: list[float]) -> str:
    if len(amounts) < 2:
        return name
    return f"{name}, power {fitted_exponent(amounts, values):.2f}"
