"""What a method makes of known line features, and the tables that hold it against the truth."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from core.arrays import Floats
from core.experiments.results import Table
from core.factorization.alignment import LineComparison
from core.measurement.lines import angle_between_lines_rad
from core.targets import LineFeature

Item = TypeVar("Item")


@dataclass(frozen=True, slots=True, kw_only=True)
class LinesFound:
    """The lines of one method.

    Attributes:
        method: what a person calls it.
        lines: one for each feature; None where the method lost it.
        note: why it has none, empty if it has.
    """

    method: str
    lines: tuple[LineComparison | None, ...]
    note: str = ""

    def mean_error_percent(self) -> float | None:
        """Return the mean size of the length errors, None where a line is lost."""
        found = [line for line in self.lines if line is not None]
        if len(found) < len(self.lines) or not found:
            return None
        return 100 * float(np.mean([abs(line.length_error) for line in found]))

    def attitude_errors_deg(self) -> tuple[float | None, ...]:
        """Return each line's attitude error, None where it is lost."""
        return tuple(
            None if line is None else float(np.rad2deg(line.attitude_error_rad))
            for line in self.lines
        )

    def worst_attitude_deg(self) -> float | None:
        """Return the largest attitude error, None where a line is lost."""
        angles = [angle for angle in self.attitude_errors_deg() if angle is not None]
        return max(angles) if len(angles) == len(self.lines) and angles else None


def line_found(feature: LineFeature, ends_m: Floats | None) -> LineComparison | None:
    """Return a line between two end points (2, 3) beside the truth; None stays lost."""
    if ends_m is None or not np.all(np.isfinite(ends_m)):
        return None
    line = ends_m[1] - ends_m[0]
    length_m = float(np.linalg.norm(line))
    if not length_m > 0:
        return None
    return LineComparison(
        name=feature.name,
        length_m=length_m,
        true_length_m=feature.length_m,
        attitude_error_rad=angle_between_lines_rad(line, feature.direction),
    )


def lines_table(title: str, found: Sequence[LinesFound], features: Sequence[LineFeature]) -> Table:
    """Return lengths with errors, attitude errors and scale factors, one row for each method.

    A scale factor b is the true over the measured length.
    """
    columns = [f"{feature.name}, {feature.length_m:g} m" for feature in features]
    return Table(
        title=title,
        columns=("method", *columns, "mean error", "scale factors b", *_ratio_names(features)),
        rows=(_truth_row(features), *(_row(each) for each in found)),
    )


def _ratio_names(features: Sequence[LineFeature]) -> tuple[str, ...]:
    return tuple(f"{one.name}/{two.name}" for one, two in _pairs(features))


def _pairs(items: Sequence[Item]) -> list[tuple[Item, Item]]:
    first, second, third = items
    return [(first, second), (first, third), (second, third)]


def _truth_row(features: Sequence[LineFeature]) -> tuple[str, ...]:
    ratios = [f"{one.length_m / two.length_m:.4f}" for one, two in _pairs(features)]
    return ("truth", *(f"{feature.length_m:.2f}" for feature in features), "", "1", *ratios)


def _row(each: LinesFound) -> tuple[str, ...]:
    mean = each.mean_error_percent()
    if not any(each.lines):
        return (each.method, *([each.note or "lost"] * len(each.lines)), "", "", "", "", "")
    factors = ["lost" if line is None else f"{line.scale_factor:.4f}" for line in each.lines]
    ratios = [
        "lost" if one is None or two is None else f"{one.length_m / two.length_m:.4f}"
        for one, two in _pairs(each.lines)
    ]
    return (
        each.method,
        *map(_line_text, each.lines),
        "" if mean is None else f"{mean:.3f} %",
        ", ".join(factors),
        *ratios,
    )


def _line_text(line: LineComparison | None) -> str:
    if line is None:
        return "lost"
    angle_deg = np.rad2deg(line.attitude_error_rad)
    return f"{line.length_m:.3f}, {100 * line.length_error:+.3f} %, {angle_deg:.3f}°"
