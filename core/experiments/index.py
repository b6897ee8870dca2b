"""The page that tells what several experiments found and links their reports."""

import base64
from collections.abc import Sequence
from dataclasses import dataclass, replace
from html import escape
from pathlib import Path
from typing import Any, Literal
from urllib.parse import quote

import cv2

from core.experiments.pictures import Picture
from core.experiments.report import table_html, write_page
from core.experiments.results import Figure, Results, Table

Outcome = Literal["done", "failed", "skipped"]

LONGEST_MIN = 30.0
"""That all experiments may take."""

THUMBNAIL_PX = 760
"""Width of a thumbnail, for screens of two pixels to a point too."""

MOST_ROWS = 12
"""Of an experiment's table on the page; the rest stands in its report."""

STYLE = """
body { max-width: 1720px; }
.overview { max-width: 720px; } .overview td { padding: .15rem .7rem; }
a { color: #58b4ff; text-decoration: none; } a:hover { text-decoration: underline; }
section { display: grid; grid-template-columns: minmax(280px, 27%) 1fr; gap: 1.6rem;
          border-top: 1px solid #2b3340; padding: 1.4rem 0; margin-top: 1.4rem; }
section > div { min-width: 0; } section img { width: 100%; border-radius: 6px; display: block; }
section header { display: flex; flex-wrap: wrap; gap: .3rem 1rem; align-items: baseline; }
section h2 { margin-top: 1rem; font-size: 1rem; color: #98a5b8; }
section header h2 { margin: 0; font-size: 1.3rem; color: #eef1f6; }
section td, section th { padding: .2rem .6rem; font-size: 14px; }
.meta { color: #98a5b8; } .badge { border-radius: 4px; padding: 0 .5rem; font-size: 13px; }
.badge.done { background: #17351f; color: #7bd88f; } .note { color: #98a5b8; }
.badge.failed { background: #43211a; color: #ff9a76; }
.badge.skipped { background: #2b3340; color: #c3ccd9; }
@media (max-width: 800px) { section { grid-template-columns: 1fr; } }
"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Entry:
    """How one experiment went.

    Attributes:
        name: of the experiment and of its folder beside the page.
        wall_s: how long it ran, its report included.
        results: what it found; None where it failed or was skipped.
        pictures: names of the pictures in its folder, in order.
        has_hull: whether its folder holds hull.glb.
        problem: the sentence that says why there are no results.
        is_skipped: whether that is because it was not run.
    """

    name: str
    wall_s: float = 0.0
    results: Results | None = None
    pictures: tuple[str, ...] = ()
    has_hull: bool = False
    problem: str = ""
    is_skipped: bool = False

    @property
    def outcome(self) -> Outcome:
        """Whether it was done, failed or was skipped."""
        if self.results is not None:
            return "done"
        return "skipped" if self.is_skipped else "failed"

    def targets(self) -> tuple[int, int]:
        """Return how many targets are met, of how many."""
        verdicts = [figure.met for figure in self.results.figures] if self.results else []
        return verdicts.count(True), verdicts.count(True) + verdicts.count(False)

    def to_json(self) -> dict[str, Any]:
        """Return the entry as plain JSON values, its results' own object inside."""
        found = {} if self.results is None else self.results.to_json()
        return {
            "name": self.name,
            "outcome": self.outcome,
            "wall_s": round(self.wall_s, 1),
            "finding": "" if self.results is None else self.results.finding,
            "problem": self.problem,
            "settings": found.get("settings", {}),
            "figures": found.get("figures", []),
        }


def names_of(pictures: Sequence[Picture]) -> tuple[str, ...]:
    """Return pictures' names, first what tells most at a glance: curves, or else the hull."""
    telling = ("-curves", "-hull")

    def rank(name: str) -> int:
        return next((place for place, part in enumerate(telling) if part in name), len(telling))

    return tuple(sorted((each.name for each in pictures), key=rank))


def summary(entries: Sequence[Entry]) -> Results:
    """Return how all experiments went as results of their own: a table, wall time and failures."""
    outcomes = [each.outcome for each in entries]
    met, wanted = (
        sum(counts) for counts in zip(*(each.targets() for each in entries), strict=True)
    )
    minutes = sum(each.wall_s for each in entries) / 60
    skipped = outcomes.count("skipped")
    return Results(
        name="all",
        settings={"experiments": [each.name for each in entries]},
        figures=(
            Figure(name="wall time", value=minutes, unit="min", wanted=f"<= {LONGEST_MIN:g} min"),
            Figure(name="experiments failed", value=outcomes.count("failed"), wanted="<= 0"),
            Figure(name="experiments skipped", value=skipped),
            Figure(name="targets met", value=met),
            Figure(name="targets missed", value=wanted - met),
        ),
        tables=(_overview(entries),),
        finding=(
            f"{outcomes.count('done')} of {len(entries)} experiments ran in "
            f"{_duration(60 * minutes)}"
            f"{f', {skipped} skipped' if skipped else ''}: {met} of {wanted} targets met."
        ),
    )


def write_index(path: Path, entries: Sequence[Entry]) -> None:
    """Write the page of several experiments, whose folders stand beside it.

    Thumbnails are part of the page; only its links lead to other files.

    Args:
        path: of the page.
        entries: how the experiments went; at least one.

    Raises:
        ValueError: the page cannot be written.
    """
    told = summary(entries)
    sections = "".join(_section(each, path.parent) for each in entries)
    body = (
        f"<p><strong>{escape(told.finding)}</strong></p>"
        f'<table class="overview">{"".join(map(_overview_row, entries))}</table>{sections}'
    )
    write_page(path, "radarhull experiments", body, style=STYLE)


def _overview(entries: Sequence[Entry]) -> Table:
    rows = [(each.name, each.outcome, _targets(each), _duration(each.wall_s)) for each in entries]
    total = _duration(sum(each.wall_s for each in entries))
    return Table(
        title="Experiments",
        columns=("experiment", "outcome", "targets met", "wall time"),
        rows=(*rows, ("all", "", "", total)),
    )


def _overview_row(entry: Entry) -> str:
    met, wanted = entry.targets()
    verdict = "" if not wanted else f' class="{"met" if met == wanted else "missed"}"'
    targets = f"{met} of {wanted} targets met" if wanted else ""
    return (
        f'<tr><td><a href="#{quote(entry.name)}">{escape(entry.name)}</a></td>'
        f"<td>{_badge(entry)}</td><td{verdict}>{targets}</td><td>{_duration(entry.wall_s)}</td></tr>"
    )


def _badge(entry: Entry) -> str:
    return f'<span class="badge {entry.outcome}">{entry.outcome}</span>'


def _section(entry: Entry, folder: Path) -> str:
    place = quote(entry.name)
    meta = [f"targets met: {_targets(entry)}"] if entry.targets()[1] else []
    meta += [_duration(entry.wall_s)] if entry.outcome != "skipped" else []
    head = (
        f"<header><h2>{escape(entry.name)}</h2>"
        f"{_badge(entry)}"
        f'<span class="meta">{escape(" · ".join(meta))}</span>{_links(entry)}</header>'
    )
    told = entry.problem if entry.results is None else entry.results.finding
    table = "" if entry.results is None else _main_table(entry.results)
    return (
        f'<section id="{place}"><div>{_thumbnail(entry, folder)}</div>'
        f"<div>{head}<p>{escape(told)}</p>{table}</div></section>"
    )


def _links(entry: Entry) -> str:
    if entry.results is None:
        return ""
    files = ["report.html", "results.json", *(["hull.glb"] if entry.has_hull else [])]
    place = quote(entry.name)
    return " ".join(f'<a href="{place}/{name}">{name}</a>' for name in files)


def _main_table(results: Results) -> str:
    """Return the first table of an experiment, or else its figures that have a target."""
    if results.tables:
        table = results.tables[0]
    else:
        held = tuple(figure for figure in results.figures if figure.wanted)
        # What is missed comes first, so that it is on the page.
        ordered = sorted(held or results.figures, key=lambda figure: figure.met is not False)
        table = replace(results, figures=tuple(ordered)).figures_table()
    left = len(table.rows) - MOST_ROWS
    note = f'<p class="note">{left} more rows in the report.</p>' if left > 0 else ""
    return table_html(replace(table, rows=table.rows[:MOST_ROWS])) + note


def _thumbnail(entry: Entry, folder: Path) -> str:
    for name in entry.pictures[:1]:
        image = cv2.imread(str(folder / entry.name / f"{name}.png"))
        if image is None:
            break
        size = (THUMBNAIL_PX, max(1, round(THUMBNAIL_PX * image.shape[0] / image.shape[1])))
        _, png = cv2.imencode(".png", cv2.resize(image, size, interpolation=cv2.INTER_AREA))
        data = base64.b64encode(png.tobytes()).decode("ascii")
        return (
            f'<a href="{quote(entry.name)}/report.html"><img alt="{escape(name)}" '
            f'src="data:image/png;base64,{data}"></a>'
        )
    return ""


def _targets(entry: Entry) -> str:
    met, wanted = entry.targets()
    return f"{met} of {wanted}" if wanted else ""


def _duration(seconds: float) -> str:
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes} min {rest:02d} s" if minutes else f"{rest} s"
