"""Pictures of the benchmarks' curves; they need matplotlib."""

from collections.abc import Sequence
from pathlib import Path

from matplotlib.figure import Figure as Picture

from core.benchmarks.growth import Curve
from core.benchmarks.measuring import fitted_exponent


def plot_growth(curves: Sequence[Curve], path: Path) -> None:
    """Write a PNG with time against voxels, views and vertices on logarithmic axes.

    Raises:
        ValueError: the file cannot be written.
    """
    picture = Picture(figsize=(4.5 * len(curves), 4), layout="constrained")
    for axes, curve in zip(picture.subplots(1, len(curves)), curves, strict=True):
        amounts = [point.amount for point in curve.points]
        times = {
            "all votes": [point.votes_s for point in curve.points],
            "exact mesh": [point.mesh_s for point in curve.points],
        }
        for name, values in times.items():
            axes.loglog(amounts, values, marker="o", label=_label(name, amounts, values))
        axes.set(xlabel=curve.of, ylabel="time [s]")
        axes.grid(which="both", alpha=0.3)
        axes.legend()
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        picture.savefig(path, dpi=120)
    except OSError as error:
        raise ValueError(f"{path} could not be written: {error.strerror}.") from error


def _label(name: str, amounts: list[float], values: list[float]) -> str:
    if len(amounts) < 2:
        return name
    return f"{name}, power {fitted_exponent(amounts, values):.2f}"
