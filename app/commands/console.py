"""What commands show: progress on standard error, tables and JSON on standard output."""

import json
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TaskID,
    TextColumn,
    TimeElapsedColumn,
)
from rich.table import Table as RichTable

from core.experiments.results import Results, Table

Report = Callable[[str, int, int], None]


@contextmanager
def progress_bars() -> Iterator[Report]:
    """Show one bar per stage and give the function that stages report to: (stage, done, total)."""
    tasks: dict[str, TaskID] = {}
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
    )
    with Progress(*columns, console=Console(stderr=True)) as progress:

        def report(stage: str, done: int, total: int) -> None:
            if stage not in tasks:
                tasks[stage] = progress.add_task(stage, total=total)
            progress.update(tasks[stage], completed=done, total=total)

        yield report


def show_results(results: Results, json_to: str | None) -> None:
    """Print an experiment's tables, or write its JSON to a file or, for "-", standard output."""
    if json_to is not None:
        text = json.dumps(results.to_json(), indent=2, ensure_ascii=False, allow_nan=False)
        write_text(json_to, text)
    if json_to == "-":
        return
    for table in (*results.tables, results.figures_table()):
        show_table(table)


def write_text(destination: str, text: str) -> None:
    """Write a text to a file, or to standard output for "-".

    Raises:
        ValueError: the file cannot be written.
    """
    if destination == "-":
        sys.stdout.write(text + "\n")
        return
    try:
        Path(destination).write_text(text + "\n", encoding="utf-8")
    except OSError as error:
        raise ValueError(f"{destination} could not be written: {error.strerror}.") from error


def show_table(table: Table) -> None:
    """Print a table, numbers to the right of the first column."""
    shown = RichTable(title=table.title, title_justify="left", header_style="bold")
    for number, column in enumerate(table.columns):
        shown.add_column(column, justify="left" if number == 0 else "right")
    for row in table.rows:
        shown.add_row(*row)
    Console().print(shown)
