"""Accuracy against one factor at a time: its figures, its table and its curves."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from matplotlib.figure import Figure as Canvas
from matplotlib.ticker import LogLocator

from core.experiments.accuracy_conditions import Accuracy
from core.experiments.pictures import Picture
from core.experiments.results import Figure, Table

MEASURES: Mapping[str, tuple[str, Callable[[Accuracy], float | None]]] = {
    "IoU": ("", lambda each: each.intersection_over_union),
    "coverage": ("", lambda each: each.coverage),
    "mean length error": ("%", lambda each: each.length_error_percent),
    "mean attitude error": ("°", lambda each: each.attitude_error_deg),
}
"""What is told of an accuracy: its unit, and how it is read."""


COLOURS = ("#58b4ff", "#ffb454")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Curve:
    """Accuracy while one factor runs and the others stay at the centre.

    Attributes:
        factor: its name.
        unit: of the factor's values.
        centre: its value at the centre.
        found: for each value of the factor the accuracies, one for each seed.
    """

    factor: str
    unit: str
    centre: float
    found: Mapping[float, Sequence[Accuracy]]

    def spread(self, value: float, measure: str) -> tuple[float, float, float] | None:
        """Return mean, least and greatest of a measure over the seeds; None if any lost it."""
        read = MEASURES[measure][1]
        numbers = [number for each in self.found[value] if (number := read(each)) is not None]
        if len(numbers) < len(self.found[value]):
            return None
        return sum(numbers) / len(numbers), min(numbers), max(numbers)

    def mean(self, value: float, measure: str) -> float | None:
        """Return the mean of a measure over the seeds, None if any of them lost it."""
        spread = self.spread(value, measure)
        return None if spread is None else spread[0]

    def named(self, value: float) -> str:
        """Return a value as a person reads it."""
        return f"{value:g} {self.unit}".replace("-", "−")

    def figures(self) -> list[Figure]:
        """Return the means over the seeds as figures named after the factor's value."""
        return [
            Figure(name=f"{self.named(value)}: {measure}", value=self.mean(value, measure), unit=u)
            for value in self.found
            for measure, (u, _) in MEASURES.items()
        ]

    def table(self) -> Table:
        """Return mean and range over the seeds, one row for each value."""
        columns = [f"{name} ({unit})" if unit else name for name, (unit, _) in MEASURES.items()]
        return Table(
            title=f"Accuracy against {self.factor}: mean and range over the seeds",
            columns=(self.factor, *columns),
            rows=tuple(
                (self.named(value), *(self._cell(value, measure) for measure in MEASURES))
                for value in self.found
            ),
        )

    def _cell(self, value: float, measure: str) -> str:
        spread = self.spread(value, measure)
        if spread is None:
            return "lost"
        digits = 2 if MEASURES[measure][0] else 3
        mean, least, greatest = (f"{number:.{digits}f}" for number in spread)
        return mean if least == greatest else f"{mean} ({least} … {greatest})"


def curves_picture(curves: Sequence[Curve], *, name: str, caption: str) -> Picture:
    """Picture every curve: agreement, lengths and attitude, with the range over the seeds.

    Args:
        curves: one row of pictures each.
        name: of the picture's file.
        caption: what stays and what runs.
    """
    groups = (("IoU", "coverage"), ("mean length error",), ("mean attitude error",))

    def draw(canvas: Canvas) -> None:
        cells = canvas.subplots(len(curves), len(groups), squeeze=False)
        for row, curve in zip(cells, curves, strict=True):
            for cell, group in zip(row, groups, strict=True):
                _show(cell, curve, group)

    return Picture(name=name, caption=caption, draw=draw, size_in=(12.0, 3.1 * len(curves)))


def _show(cell: Any, curve: Curve, measures: Sequence[str]) -> None:
    for measure, colour in zip(measures, COLOURS, strict=False):
        spreads = {value: curve.spread(value, measure) for value in curve.found}
        known = {value: spread for value, spread in spreads.items() if spread is not None}
        mean, least, greatest = (
            zip(*known.values(), strict=True) if known else ((), (), ())  # all lost
        )
        cell.plot(list(known), mean, "o-", color=colour, markersize=4, label=measure)
        cell.fill_between(list(known), least, greatest, color=colour, alpha=0.25, linewidth=0)
    cell.axvline(curve.centre, color="#8b96a6", linestyle=":", linewidth=1, label="centre")
    unit = MEASURES[measures[0]][0]
    if unit:  # errors run over two decades, agreement from nothing to all
        cell.set_yscale("log")
        cell.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        cell.yaxis.set_major_formatter("{x:g}")
        cell.yaxis.set_minor_formatter("")
    else:
        cell.set_ylim(0, 1.03)
    cell.set_xlabel(f"{curve.factor} ({curve.unit})" if curve.unit != "frames" else "frames")
    cell.set_ylabel(f"{measures[0]} ({unit})" if unit else "share")
    cell.legend()
