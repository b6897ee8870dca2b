"""`radarhull experiment all`: every experiment in turn, and the page that lists them."""

import sys
import traceback
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from time import perf_counter
from typing import Any

from app.commands.console import progress_bars, sentence_of
from app.commands.outputs import (
    STANDARD_OUTPUT,
    checked_folder,
    show_tables,
    write_json,
    write_study,
)
from core.experiments.index import Entry, names_of, summary, write_index
from core.experiments.study import Study

EXIT_FAILED = 1


def run_all(
    studies: Mapping[str, Callable[..., Study]],
    needed_data: Mapping[str, str],
    data: Path | None,
    out: Path,
    json: str | None,
) -> None:
    """Run every experiment into a folder of its own, and write index.html and results.json.

    One that fails is told on the page, and the others run all the same; then the command ends
    with exit code 1. Page and JSON are written after each experiment, so that what was done is
    there if the run is stopped.

    Args:
        studies: by name.
        needed_data: what the data folder must hold, of those that cannot run without it.
        data: that folder, None to skip those.
        out: folder for everything.
        json: where the JSON goes besides.

    Raises:
        ValueError: the folder cannot be written.
        SystemExit: an experiment failed.
    """
    checked_folder(out)
    entries: list[Entry] = []
    for number, (name, run) in enumerate(studies.items(), start=1):
        print(f"{name} ({number} of {len(studies)})", file=sys.stderr)
        if name in needed_data and data is None:
            problem = f"Needs its data: --data FOLDER with {needed_data[name]}."
            entries.append(Entry(name=name, problem=problem, is_skipped=True))
        else:
            given = {"data": data} if name in needed_data else {}
            entries.append(_entry(name, partial(run, **given), out / name))
        write_index(out / "index.html", entries)
        write_json(str(out / "results.json"), _facts(entries))
    _tell(entries, json)
    if any(each.outcome == "failed" for each in entries):
        raise SystemExit(EXIT_FAILED)


def _entry(name: str, run: Callable[..., Study], folder: Path) -> Entry:
    start_s = perf_counter()
    try:
        checked_folder(folder)
        with progress_bars() as report:
            study = run(progress=report)
        write_study(folder, study)
    except Exception as error:  # whatever one does must not cost the others
        if not isinstance(error, ValueError | MemoryError | OSError):
            traceback.print_exc()
        return Entry(name=name, wall_s=perf_counter() - start_s, problem=sentence_of(error))
    return Entry(
        name=name,
        wall_s=perf_counter() - start_s,
        results=study.results,
        pictures=names_of(study.pictures),
        has_hull=not study.hull.is_empty,
    )


def _tell(entries: Sequence[Entry], json: str | None) -> None:
    if json is not None:
        write_json(json, _facts(entries))
    if json == STANDARD_OUTPUT:
        return
    show_tables(summary(entries))
    for each in entries:
        if each.problem:
            print(f"{each.name} {each.outcome}: {each.problem}")


def _facts(entries: Sequence[Entry]) -> dict[str, Any]:
    told = summary(entries).to_json()
    return told | {"experiments": [each.to_json() for each in entries]}
