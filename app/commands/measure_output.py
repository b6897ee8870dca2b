"""What `radarhull measure` prints and writes of the rows that it measured."""

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from core.analysis.measured_body import Body, Orbit, Row
from core.arrays import Floats
from core.experiments.results import Table
from core.formats.measurement_entries import Entry
from core.formats.measurements import measurements_to_json
from core.geometry.directions import Direction, direction_in_frames
from core.measurement.intervals import Interval
from core.measurement.observability import Grade
from core.measurement.results import Lost, Measurement
from core.measurement.specs import BoundingBox, OrientedBox, PrincipalAxes

BOX_AXES = ("x along-track", "y cross-track", "z nadir")
UNOBSERVED = "not observed"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Number:
    """One number of a row: its value, or one of a body's sizes."""

    name: str
    value: float
    interval: Interval | None
    grade: Grade | None
    direction: Floats | None


def rows_table(rows: Sequence[Row], body: Body, orbit: Orbit | None) -> Table:
    """Return the rows as people read them, directions in every frame that is known."""
    of_hull, frames = body.grid is not None, 3 if orbit else 1
    has_intervals = any(row.interval is not None for row in rows)
    wanted = [True, True, has_intervals, of_hull, *[True] * frames]
    columns = ("measurement", "value", "95 % interval", "seen", "direction", "in RTN", "in TEME")
    title = f"Hull of {len(body.views)} views, {body.threshold} votes" if of_hull else "Mesh"
    if orbit:
        title += f", directions at {orbit.at_utc.isoformat().replace('+00:00', 'Z')}"
    return Table(
        title=title,
        columns=_chosen(columns, wanted),
        rows=tuple(_chosen(cells, wanted) for row in rows for cells in _cells(row, orbit)),
    )


def _chosen(cells: Sequence[str], wanted: Sequence[bool]) -> tuple[str, ...]:
    filled = [*cells, *[""] * (len(wanted) - len(cells))]
    return tuple(cell for cell, is_wanted in zip(filled, wanted, strict=False) if is_wanted)


def _cells(row: Row, orbit: Orbit | None) -> Iterator[list[str]]:
    result = row.result
    if isinstance(result, Lost):
        yield [row.spec.name, f"lost: {result.reason}"]
        return
    for number in _numbers(row, result):
        if number.grade == "unobserved":
            yield [number.name, UNOBSERVED, "", "unobserved"]
            continue
        ends, value = _ends(number.interval, result.unit), _value(number.value, result.unit)
        vectors = [] if number.direction is None else _vectors(number.direction, result, orbit)
        yield [number.name, value, ends, number.grade or "", *vectors]


def _numbers(row: Row, result: Measurement) -> Iterator[_Number]:
    """Yield each number that a row shows: its value, or all three sizes of a body."""
    name = row.spec.name
    if not isinstance(row.spec, BoundingBox | OrientedBox | PrincipalAxes):
        yield _Number(
            name=name,
            value=result.value,
            interval=row.interval,
            grade=row.observability,
            direction=result.direction,
        )
        return
    parts = BOX_AXES if isinstance(row.spec, BoundingBox) else ("longest", "middle", "shortest")
    for number, part in enumerate(parts):
        yield _Number(
            name=f"{name}, {part}",
            value=float(result.sizes_m[number]),
            interval=row.size_intervals[number] if row.size_intervals else None,
            grade=row.size_grades[number] if row.size_grades else None,
            direction=result.axes[number],
        )


def _vectors(direction: Floats, result: Measurement, orbit: Orbit | None) -> list[str]:
    known = direction_in_frames(
        direction,
        satellite=None if orbit is None else orbit.satellite,
        at_utc=None if orbit is None else orbit.at_utc,
    )
    sign = "±" if result.is_undirected else ""
    vectors = [vector for vector in (known.target, known.rtn, known.teme) if vector is not None]
    # Adding zero turns a rounded −0 into 0.
    rounded = [[round(float(part), 4) + 0.0 for part in vector] for vector in vectors]
    return [f"{sign}({x:+.4f}, {y:+.4f}, {z:+.4f})" for x, y, z in rounded]


def _value(value: float, unit: str) -> str:
    """Return a number as people read it: angles in degrees."""
    return f"{np.rad2deg(value):.3f}°" if unit == "rad" else f"{value:.3f} {unit}".rstrip()


def _ends(interval: Interval | None, unit: str) -> str:
    if interval is None:
        return ""
    if not interval.is_stated:
        return interval.note
    scale = np.rad2deg(1.0) if unit == "rad" else 1.0
    return f"[{scale * interval.low:.3f}, {scale * interval.high:.3f}]"


def facts(
    rows: Sequence[Row],
    entries: Sequence[Entry],
    body: Body,
    files: Sequence[Path],
    notes: Sequence[str],
) -> dict[str, Any]:
    """Return a file of measurements, which --spec reads again, and beside it what else is known."""
    content: dict[str, Any] = json.loads(measurements_to_json(entries))
    return content | {
        "files": [path.name for path in files],
        "views": len(body.views),
        "threshold": body.threshold,
        "notes": list(notes),
        "details": [_details(row) for row in rows],
    }


def _details(row: Row) -> dict[str, Any]:
    if isinstance(row.result, Lost):
        return {"name": row.spec.name, "lost": row.result.reason}
    angles = row.result.angles_to_axes_rad()
    seen = [grade != "unobserved" for grade in row.size_grades] or [True] * len(row.result.sizes_m)
    return {
        "name": row.spec.name,
        "lost": None,
        "observability": row.observability,
        "sizes_m": [
            float(size) if is_seen else None
            for size, is_seen in zip(row.result.sizes_m, seen, strict=True)
        ],
        "axes": row.result.axes.tolist(),
        "size_intervals_m": [
            _pair(interval) if is_seen else None
            for interval, is_seen in zip(row.size_intervals, seen, strict=False)
        ],
        "interval_method": row.interval.method if row.interval else None,
        "interval_note": row.interval.note if row.interval else None,
        "residual_m": row.result.residual_m,
        "angles_to_axes_rad": None if angles is None else angles.tolist(),
        **_in_frames(row.direction),
    }


def _pair(interval: Interval) -> list[float] | None:
    return [interval.low, interval.high] if interval.is_stated else None


def _in_frames(direction: Direction | None) -> dict[str, Any]:
    if direction is None:
        return {"direction": None, "is_undirected": None}
    return {
        "direction": direction.target.tolist(),
        "rtn": None if direction.rtn is None else direction.rtn.tolist(),
        "teme": None if direction.teme is None else direction.teme.tolist(),
        "epoch_utc": direction.epoch_utc,
        "is_undirected": direction.is_undirected,
    }
