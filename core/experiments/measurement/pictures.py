"""Pictures of the measurement experiment."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Canvas
from matplotlib.ticker import NullFormatter, StrMethodFormatter

from core.arrays import Floats
from core.experiments.measurement.settings import Case
from core.experiments.pictures import Picture
from core.experiments.results import Figure
from core.hull.closed_mesh import Surface
from core.measurement.results import Lost, Measurement

BLUE, ORANGE, GREEN, RED = "#4fb3ff", "#ff9a3c", "#3fbf7f", "#e0524d"
MOST_DOTS = 12_000


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Measured:
    """A hull and what was measured on it."""

    case: Case
    surface: Surface
    results: tuple[Measurement | Lost, ...]


def errors_picture(
    name: str, caption: str, figures: Sequence[Figure], wanted: tuple[float | None, float | None]
) -> Picture:
    """Return a picture of the errors of lengths (per cent) and attitudes (degrees), by feature."""

    def draw(canvas: Canvas) -> None:
        both = canvas.subplots(1, 2)
        for axes, unit, bound in zip(both, ("%", "°"), wanted, strict=True):
            _draw_errors(axes, [f for f in figures if f.unit == unit], unit, bound)
        both[0].set_title("lengths")
        both[1].set_title("attitude")

    return Picture(name=name, caption=caption, draw=draw, size_in=(11.0, 4.2))


def _draw_errors(axes: Axes, figures: Sequence[Figure], unit: str, bound: float | None) -> None:
    names: dict[str, int] = {}
    for figure in figures:
        label = _feature(figure.name)
        height = names.setdefault(label, len(names))
        if figure.value is not None:
            axes.plot(max(figure.value, 1e-5), height, "o", color=BLUE, ms=6, alpha=0.8)
        else:
            axes.plot(1e-5, height, "x", color=RED)
    if bound is not None:
        axes.axvline(bound, color=RED, ls="--", lw=1)
    axes.set(xscale="log", xlabel=f"error [{unit}]", ylim=(len(names) - 0.5, -0.5))
    axes.set_yticks(list(names.values()), list(names))
    axes.xaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())


def _feature(name: str) -> str:
    """Return target and feature of a figure's name, without source and seed."""
    parts = [
        part
        for part in name.split(":", maxsplit=1)[0].split(", ")[1:]
        if not part.startswith("seed")
    ]
    return ", ".join(parts)


def hull_picture(name: str, caption: str, shown: Sequence[Measured]) -> Picture:
    """Return a picture of hulls from two sides, with lines as they are and as measured."""

    def draw(canvas: Canvas) -> None:
        grid = canvas.subplots(len(shown), 2, squeeze=False)
        for row, one in zip(grid, shown, strict=True):
            for axes, (across, up) in zip(row, ((0, 1), (0, 2)), strict=True):
                _draw_hull(axes, one, across, up)
                axes.set_title(f"{one.case.name}, {'xyz'[across]}–{'xyz'[up]}")

    return Picture(name=name, caption=caption, draw=draw, size_in=(11.0, 4.4 * len(shown)))


def _draw_hull(axes: Axes, one: Measured, across: int, up: int) -> None:
    vertices = one.surface.vertices_m[:: max(1, len(one.surface.vertices_m) // MOST_DOTS)]
    axes.plot(vertices[:, across], vertices[:, up], ".", color="#7d8796", ms=1.2, alpha=0.5)
    for feature, result in zip(one.case.features, one.results, strict=True):
        if isinstance(result, Lost) or len(result.points_m) != 2:
            continue
        ends = result.points_m
        axes.plot(ends[:, across], ends[:, up], "-", color=ORANGE, lw=2.2)
        if feature.value is not None and result.unit == "m" and len(result.axes):
            size = feature.value if len(result.sizes_m) and _is_line(result) else result.sizes_m[0]
            true = ends.mean(axis=0) + np.outer([-0.5, 0.5], size * feature.direction)
            axes.plot(true[:, across], true[:, up], "--", color=BLUE, lw=1.2)
        axes.annotate(feature.spec.name, ends[1][[across, up]], color=ORANGE, fontsize=8)
    axes.set(aspect="equal", xlabel=f"{'xyz'[across]} [m]", ylabel=f"{'xyz'[up]} [m]")


def _is_line(result: Measurement) -> bool:
    """Whether the value is the line's own length, not a diameter."""
    return bool(np.isclose(result.sizes_m.sum(), result.value))


def coverage_picture(figures: Sequence[Figure]) -> Picture:
    """Return a picture of how often the stated 95 % intervals hold the truth."""
    end = ": intervals that hold it"
    shown = [figure for figure in figures if figure.name.endswith(end)]

    def draw(canvas: Canvas) -> None:
        axes = canvas.subplots()
        heights = list(range(len(shown)))
        axes.set_axisbelow(True)
        axes.axvspan(90, 99, color=GREEN, alpha=0.15, lw=0)
        axes.axvline(95, color=GREEN, ls="--", lw=1)
        values = [figure.value or 0.0 for figure in shown]
        axes.barh(heights, values, 0.55, color=BLUE)
        for height, value in zip(heights, values, strict=True):
            axes.text(
                value - 0.3, height, f"{value:.1f} %", ha="right", va="center", color="#11151c"
            )
        axes.set_yticks(heights, [figure.name.removesuffix(end) for figure in shown])
        axes.set(xlim=(min(80.0, *values), 100), xlabel="intervals that hold the truth [%]")
        axes.invert_yaxis()

    return Picture(
        name="interval-coverage",
        caption=(
            "Stated 95 % intervals that hold the number of the same views' noise-free outlines. "
            "Green: the 90 to 99 % that are wanted."
        ),
        draw=draw,
        size_in=(9.0, 3.6),
    )


def key_points_picture(
    frames: Sequence[int], sigmas_px: Sequence[float], found_m: Floats, pixel_m: float
) -> Picture:
    """Return a picture of key points' errors, found and predicted: (frames, sigmas, 2)."""

    def draw(canvas: Canvas) -> None:
        axes = canvas.subplots()
        for column, (sigma_px, colour) in enumerate(
            zip(sigmas_px, (GREEN, BLUE, ORANGE), strict=True)
        ):
            error, predicted = 1e3 * found_m[:, column].T
            axes.plot(frames, error, "o-", color=colour, label=f"marks ± {sigma_px:g} px")
            axes.plot(frames, predicted, "--", color=colour, lw=1)
        axes.set(xscale="log", yscale="log", xlabel="frames", ylabel="distance from the truth [mm]")
        axes.set_xticks(list(frames), [str(count) for count in frames])
        axes.minorticks_off()
        axes.set_yticks(
            [5, 10, 20, 50, 100, 200, 500], ["5", "10", "20", "50", "100", "200", "500"]
        )
        axes.legend()

    return Picture(
        name="key-point-accuracy",
        caption=(
            f"Median error of a corner marked in frames from random directions, pixels of "
            f"{1e3 * pixel_m:g} mm. Dashed: the rms error that each point's own covariance states, "
            "in the median; a rms lies above the median of what it describes."
        ),
        draw=draw,
        size_in=(8.0, 4.6),
    )
