"""Measurements as JSON and CSV, out and in again unchanged.

Both hold the specs, by which a hull is measured anew, and the readings that were taken. In CSV one
row is one measurement; what only the spec knows is JSON in its last column. Numbers that every hull
has by itself, its extents for one, may stand below them: they have no spec, and are read past.
"""

import csv
import io
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from core.formats.files import checked_output, reason, written_aside
from core.formats.measurement_entries import HULL_KINDS, Entry, HullNumber, Reading
from core.formats.measurement_fields import decoded, encoded
from core.measurement.specs import Spec, check_specs

FORMAT = "radarhull measurements"
VERSION = 1
MEASUREMENT_SUFFIXES = (".json", ".csv")
MAX_BYTES = 16 * 2**20
MAX_MEASUREMENTS = 10_000

COLUMNS = (
    *("version", "kind", "name", "value", "unit", "low", "high", "x", "y", "z", "frame"),
    *("epoch_utc", "undirected", "revision", "threshold", "note", "spec"),
)


def spec_from_json(value: object, where: str = "The measurement") -> Spec:
    """Return the spec that JSON values describe, as a file has it but for its reading.

    Raises:
        ValueError: an unknown kind, unknown, missing or wrong fields; the sentence says where.
    """
    found: Spec = decoded(value, Spec, where)
    return found


def measurements_to_json(entries: Sequence[Entry], about: Mapping[str, Any] | None = None) -> str:
    """Return measurements as JSON text.

    Args:
        entries: the measurements.
        about: what else a program may want to know of them, as JSON values; read past.
    """
    check_specs(tuple(entry.spec for entry in entries))
    rows = [
        {**encoded(entry.spec), "reading": _reading_to_json(entry.reading)} for entry in entries
    ]
    content = {"format": FORMAT, "version": VERSION, **(about or {}), "measurements": rows}
    return json.dumps(content, ensure_ascii=False, indent=1, allow_nan=False) + "\n"


def measurements_from_json(text: str) -> tuple[Entry, ...]:
    """Return the measurements of a JSON text.

    Raises:
        ValueError: no such text, another version, unknown kinds, fields or frames, numbers that
            are none, two measurements of one name, or one that refers to a name that is missing.
    """
    content = _parsed(text, "The file")
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        raise ValueError(f'The file holds no measurements: its "format" is not "{FORMAT}".')
    _check_version(content.get("version"))
    rows = content.get("measurements")
    if not isinstance(rows, list):
        raise ValueError('The file holds no list of "measurements".')
    return _checked([_entry(row, f"Measurement {i}") for i, row in enumerate(rows, start=1)])


def measurements_to_csv(entries: Sequence[Entry], hull: Sequence[HullNumber] = ()) -> str:
    """Return measurements as CSV text, one row each, below a row of headings.

    Args:
        entries: the measurements.
        hull: numbers of the hull itself, which come last.
    """
    check_specs(tuple(entry.spec for entry in entries))
    text = io.StringIO(newline="")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    for entry in entries:
        spec = encoded(entry.spec)
        kind, name, note = (spec.pop(name) for name in ("kind", "name", "note"))
        details = json.dumps(spec, ensure_ascii=False, allow_nan=False)
        writer.writerow([VERSION, kind, name, *_reading_cells(entry.reading), note, details])
    for number in hull:
        cells = _reading_cells(number.reading)
        writer.writerow([VERSION, number.kind, number.name, *cells, "", ""])
    return text.getvalue()


def _reading_cells(found: Reading | None) -> list[str]:
    """Return the cells from value to threshold, empty where nothing was read."""
    if found is None:
        return [""] * 12
    reading = encoded(found)
    vector = reading["direction"] or [None] * 3
    before, after = ([reading[name] for name in names] for names in (_BEFORE, _AFTER))
    return [_cell(value) for value in (*before, *vector, *after)]


_BEFORE = ("value", "unit", "low", "high")
_AFTER = ("frame", "epoch_utc", "is_undirected", "revision", "threshold")


def measurements_from_csv(text: str) -> tuple[Entry, ...]:
    """Return the measurements of a CSV text, exactly those that were written.

    Raises:
        ValueError: as `measurements_from_json`, or other columns.
    """
    try:
        rows = list(csv.reader(io.StringIO(text, newline=""), strict=True))
    except csv.Error as error:
        raise ValueError(f"The file is no CSV that can be read: {error}.") from error
    if not rows or tuple(rows[0]) != COLUMNS:
        raise ValueError(f"The first row must hold the headings {','.join(COLUMNS)}.")
    found = [(line, row) for line, row in enumerate(rows[1:], start=2) if row]
    return _checked([_row_entry(row, line) for line, row in found if not _is_of_hull(row)])


def _is_of_hull(row: list[str]) -> bool:
    return len(row) == len(COLUMNS) and row[1] in HULL_KINDS


def write_measurements(path: Path, entries: Sequence[Entry]) -> None:
    """Write measurements to a .json or .csv file, whole or not at all.

    Raises:
        ValueError: another ending, a path that cannot be written, or names that clash.
    """
    checked_output(path, MEASUREMENT_SUFFIXES)
    is_csv = path.suffix.lower() == ".csv"
    text = measurements_to_csv(entries) if is_csv else measurements_to_json(entries)
    with written_aside(path) as aside:
        aside.write_bytes(text.encode())


def read_measurements(path: Path) -> tuple[Entry, ...]:
    """Read measurements from a .json or .csv file: all of them or none.

    Raises:
        ValueError: another ending, a file that cannot be read or is too large, or as
            `measurements_from_json`.
    """
    if path.suffix.lower() not in MEASUREMENT_SUFFIXES:
        raise ValueError(f'A file of measurements ends in .json or .csv; got "{path.name}".')
    try:
        if path.stat().st_size > MAX_BYTES:
            raise ValueError(f"{path.name} is larger than {MAX_BYTES >> 20} MiB.")
        content = path.read_bytes()
    except OSError as error:
        raise ValueError(f"{path} could not be read: {reason(error)}.") from error
    return measurements_from_bytes(content, path.name)


def measurements_from_bytes(content: bytes, name: str) -> tuple[Entry, ...]:
    """Return the measurements of a file's content: CSV where its name ends so, else JSON.

    Raises:
        ValueError: no text, or as `measurements_from_json`.
    """
    try:
        text = content.decode()
    except UnicodeDecodeError as error:
        raise ValueError(f"{name} is no text in UTF-8: {error.reason}.") from error
    is_csv = name.lower().endswith(".csv")
    return measurements_from_csv(text) if is_csv else measurements_from_json(text)


def _checked(entries: list[Entry]) -> tuple[Entry, ...]:
    if len(entries) > MAX_MEASUREMENTS:
        raise ValueError(
            f"The file holds {len(entries)} measurements; at most {MAX_MEASUREMENTS} are read."
        )
    check_specs(tuple(entry.spec for entry in entries))
    return tuple(entries)


def _entry(row: object, where: str) -> Entry:
    if not isinstance(row, dict):
        raise ValueError(f"{where} is no object with a kind and a name.")
    spec = {name: value for name, value in row.items() if name != "reading"}
    found = decoded(spec, Spec, where)
    return Entry(spec=found, reading=_reading(row.get("reading"), f'{where}, "{found.name}"'))


def _reading_to_json(reading: Reading | None) -> dict[str, Any] | None:
    return None if reading is None else encoded(reading)


def _reading(row: object, where: str) -> Reading | None:
    return None if row is None else decoded(row, Reading, f"{where}: its reading")


def _row_entry(cells: list[str], line: int) -> Entry:
    where = f"Row {line}"
    if len(cells) != len(COLUMNS):
        raise ValueError(f"{where} has {len(cells)} cells for {len(COLUMNS)} columns.")
    row = dict(zip(COLUMNS, cells, strict=True))
    _check_version(row["version"])
    details = _parsed(row["spec"], f"{where}, column spec,")
    if not isinstance(details, dict) or {"kind", "name", "note", "reading"} & set(details):
        raise ValueError(f"{where}, column spec, holds no object of the spec's own fields.")
    common = {name: row[name] for name in ("kind", "name", "note")}
    return _entry({**common, **details, "reading": _row_reading(row, where)}, where)


def _row_reading(row: dict[str, str], where: str) -> dict[str, Any] | None:
    if not any(row[name] for name in COLUMNS[3:15]):
        return None
    numbers = {
        name: None if row[name] == "" else _parsed(row[name], f"{where}, column {name},")
        for name in ("value", "low", "high", "x", "y", "z", "undirected", "revision", "threshold")
    }
    vector = [numbers.pop(axis) for axis in "xyz"]
    numbers["is_undirected"] = numbers.pop("undirected")
    numbers["direction"] = None if vector == [None] * 3 else vector
    return numbers | {name: row[name] for name in ("unit", "frame", "epoch_utc")}


def _cell(value: object) -> str:
    if isinstance(value, str):
        return value
    return "" if value is None else json.dumps(value, allow_nan=False)


def _check_version(version: object) -> None:
    if str(version) != str(VERSION):
        raise ValueError(f"The file is of version {version}; this program reads version {VERSION}.")


def _parsed(text: str, where: str) -> Any:
    try:
        return json.loads(text, parse_constant=_refuse, object_pairs_hook=_no_twice)
    except (json.JSONDecodeError, RecursionError) as error:
        raise ValueError(f"{where} is no JSON that can be read: {error}.") from error


def _refuse(constant: str) -> float:
    raise ValueError(f"The file holds {constant}; every number must be finite.")


def _no_twice(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) < len(pairs):
        raise ValueError("The file gives a field twice: " + ", ".join(name for name, _ in pairs))
    return found
