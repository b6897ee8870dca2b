"""What commands leave behind: files that are checked before the work, and JSON for machines."""

import json
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from app.commands.console import show_table
from core.experiments.pictures import write_pictures
from core.experiments.report import write_report
from core.experiments.results import Results
from core.experiments.study import Study
from core.formats.files import checked_output, reason, written_aside
from core.formats.surfaces import write_surface
from core.radar.phase_history import PhaseHistory

STANDARD_OUTPUT = "-"


def checked_pass(path: Path) -> Path:
    """Return `path` if a pass file can be written there.

    Raises:
        ValueError: another ending than HDF5's, or a folder that cannot be written.
    """
    return checked_output(path, (".h5", ".hdf5"))


def checked_folder(path: Path) -> Path:
    """Return `path` once it is a folder that can be written to, made if it was missing.

    Raises:
        ValueError: it is a file, or cannot be made or written to.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ValueError(f"{path} could not be made a folder: {reason(error)}.") from error
    checked_output(path / "results.json")
    return path


def checked_json(destination: str | None) -> None:
    """Refuse a destination of JSON that cannot be written.

    Raises:
        ValueError: a folder that cannot be written.
    """
    if destination not in (None, STANDARD_OUTPUT):
        checked_output(Path(str(destination)))


def write_json(destination: str, content: Mapping[str, Any]) -> None:
    """Write JSON to a file, or to standard output for "-".

    Raises:
        ValueError: the file cannot be written.
    """
    text = json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False) + "\n"
    if destination == STANDARD_OUTPUT:
        sys.stdout.write(text)
        return
    with written_aside(Path(destination)) as aside:
        aside.write_text(text, encoding="utf-8")


def show_summary(sentence: str, facts: Mapping[str, Any], json_to: str | None) -> None:
    """Print a sentence, or write the same facts as JSON to a file or, for "-", standard output."""
    if json_to is not None:
        write_json(json_to, facts)
    if json_to != STANDARD_OUTPUT:
        print(sentence)


def show_results(results: Results, json_to: str | None) -> None:
    """Print an experiment's tables, or write its JSON to a file or, for "-", standard output."""
    if json_to is not None:
        write_json(json_to, results.to_json())
    if json_to != STANDARD_OUTPUT:
        show_tables(results)


def show_tables(results: Results) -> None:
    """Print an experiment's tables, its figures last, and what was found."""
    for table in (*results.tables, results.figures_table()):
        show_table(table)
    if results.finding:
        print(results.finding)


def write_study(folder: Path, study: Study) -> None:
    """Write an experiment's numbers, pictures, page and, where it has one, its hull in a folder.

    Raises:
        ValueError: a file cannot be written.
    """
    write_pictures(study.pictures, folder)
    write_report(folder / "report.html", study.results, study.pictures)
    write_json(str(folder / "results.json"), study.results.to_json())
    if not study.hull.is_empty:
        write_surface(folder / "hull.glb", study.hull)


def echo_facts(history: PhaseHistory) -> dict[str, Any]:
    """Return what a machine wants to know of echoes, as plain JSON values."""
    return {
        "sensor": history.sensor,
        "pulses": len(history.track),
        "frequencies": len(history.frequency_hz),
        "centre_frequency_hz": float(history.frequency_hz.mean()),
        "bandwidth_hz": history.frequency_step_hz * len(history.frequency_hz),
        "epoch_utc": history.track.epoch_utc or None,
        "duration_s": float(history.track.time_s[-1] - history.track.time_s[0]),
    }
