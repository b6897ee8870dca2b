"""The form in which every experiment and benchmark hands out its figures."""

import math
import operator
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

_WANTED = re.compile(r"(<=|>=|<|>|≤|≥)\s*([-+−]?\d+(?:\.\d*)?(?:[eE][-+]?\d+)?)\s*(.*)")
_COMPARISONS = {
    "<=": operator.le,
    "≤": operator.le,
    "<": operator.lt,
    ">=": operator.ge,
    "≥": operator.ge,
    ">": operator.gt,
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Figure:
    """One number that an experiment found, and the target it is held against.

    Attributes:
        name: what the number is.
        value: the number; None where there was nothing to measure (an empty hull has no length),
            which misses every target.
        unit: unit of the value, empty for a pure number.
        wanted: the target as text, a comparison, a number and the unit ("<= 0.7 %", ">= 0.75");
            empty or None where the figure is only reported.
    """

    name: str
    value: float | None
    unit: str = ""
    wanted: str | None = None

    def __post_init__(self) -> None:
        if self.value is not None:
            if not math.isfinite(self.value):
                raise ValueError(
                    f'Figure "{self.name}" must be a finite number, got {self.value}; '
                    "give None where there is nothing to measure."
                )
            # NumPy's scalars are no JSON numbers.
            object.__setattr__(self, "value", float(self.value))
        _ = self.met  # a target that cannot be read is an error now, not when it is printed

    @property
    def met(self) -> bool | None:
        """Whether the value meets the target; None without a target.

        Raises:
            ValueError: the target is no comparison with a number, or in another unit.
        """
        if not self.wanted:
            return None
        match = _WANTED.fullmatch(self.wanted.strip())
        if match is None:
            raise ValueError(
                f'Figure "{self.name}": a target reads like "<= 0.7 %" or ">= 0.75", '
                f'got "{self.wanted}".'
            )
        comparison, bound, unit = match.groups()
        if unit.strip() != self.unit:
            raise ValueError(
                f'Figure "{self.name}" has the unit "{self.unit}", its target "{self.wanted}" '
                f'has "{unit.strip()}"; give both the same.'
            )
        if self.value is None:
            return False
        return bool(_COMPARISONS[comparison](self.value, float(bound.replace("−", "-"))))


@dataclass(frozen=True, slots=True, kw_only=True)
class Table:
    """Rows of text for a person to read; the first column names the row.

    Attributes:
        title: what the table shows.
        columns: headings, with units.
        rows: each as long as `columns`.
    """

    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]

    def __post_init__(self) -> None:
        for number, row in enumerate(self.rows):
            if len(row) != len(self.columns):
                raise ValueError(
                    f'Row {number} of the table "{self.title}" has {len(row)} cells for '
                    f"{len(self.columns)} columns."
                )


@dataclass(frozen=True, slots=True, kw_only=True)
class Results:
    """All that one experiment found.

    Attributes:
        name: of the experiment, as on the command line.
        settings: what it ran with; plain JSON values.
        figures: the numbers, with their targets.
        tables: further tables for a person to read; they are not part of the JSON.
        finding: what was found, in a sentence made from the numbers; not part of the JSON.
    """

    name: str
    settings: Mapping[str, Any]
    figures: tuple[Figure, ...]
    tables: tuple[Table, ...] = field(default=())
    finding: str = ""

    @property
    def met(self) -> bool:
        """Whether no figure misses its target."""
        return all(figure.met is not False for figure in self.figures)

    def to_json(self) -> dict[str, Any]:
        """Return the object that `--json` writes, of plain JSON values."""
        return {
            "name": self.name,
            "settings": dict(self.settings),
            "figures": [
                {
                    "name": figure.name,
                    "value": figure.value,
                    "unit": figure.unit,
                    "wanted": figure.wanted,
                    "met": figure.met,
                }
                for figure in self.figures
            ],
        }

    def figures_table(self) -> Table:
        """Return the figures as a table of value, target and verdict."""
        verdict = {True: "met", False: "missed", None: ""}
        return Table(
            title=f"{self.name}: figures",
            columns=("figure", "value", "wanted", ""),
            rows=tuple(
                (figure.name, _value_text(figure), figure.wanted or "", verdict[figure.met])
                for figure in self.figures
            ),
        )


def _value_text(figure: Figure) -> str:
    return "none" if figure.value is None else f"{figure.value:.4g} {figure.unit}".rstrip()
