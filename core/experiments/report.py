"""An experiment's results and pictures as one page that needs no other file."""

import base64
from collections.abc import Sequence
from html import escape
from io import BytesIO
from pathlib import Path

from core.experiments.pictures import Picture, drawn_png
from core.experiments.results import Results, Table
from core.formats.files import written_aside

STYLE = """
body { background: #0d1117; color: #d5dbe5; font: 15px/1.5 system-ui, sans-serif;
       max-width: 1180px; margin: 2rem auto; padding: 0 1.5rem; }
h1 { font-size: 1.6rem; color: #eef1f6; } h2 { font-size: 1.15rem; margin-top: 2.2rem; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
th, td { text-align: right; padding: .3rem .7rem; border-bottom: 1px solid #222b38; }
.scroll { overflow-x: auto; }
th:first-child, td:first-child { text-align: left; }
th { color: #98a5b8; font-weight: 600; }
td.met { color: #7bd88f; } td.missed { color: #ff9a76; font-weight: 700; }
figure { margin: 1.6rem 0; } figure img { width: 100%; border-radius: 6px; }
figcaption { color: #98a5b8; margin-top: .3rem; }
"""


def write_report(path: Path, results: Results, pictures: Sequence[Picture]) -> None:
    """Write a page with every table and picture of an experiment in it, all figures at its end.

    Raises:
        ValueError: the file cannot be written.
    """
    settings = "; ".join(f"{name}: {_text(value)}" for name, value in results.settings.items())
    tables = "".join(map(table_html, results.tables))
    body = tables + "".join(map(_figure, pictures)) + table_html(results.figures_table())
    settings = "; ".join(f"{name}: {_text(value)}" for name, value in results.settings.items())
    title = f"radarhull experiment {results.name}"
    finding = f"<p><strong>{escape(results.finding)}</strong></p>" if results.finding else ""
    write_page(path, title, f"{finding}<p>{escape(settings)}</p>{body}")


def write_page(path: Path, title: str, body: str, *, style: str = "") -> None:
    """Write a page under its title that needs no other file.

    Args:
        path: of the page.
        title: of the page, plain text.
        body: HTML below the title.
        style: further rules of CSS.

    Raises:
        ValueError: the file cannot be written.
    """
    page = (
        f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{escape(title)}</title>'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<style>{STYLE}{style}</style></head><body><h1>{escape(title)}</h1>{body}</body></html>\n"
    )
    with written_aside(path) as aside:
        aside.write_text(page, encoding="utf-8")


def table_html(table: Table) -> str:
    """Return a table under its title; it scrolls where it is wider than its place."""
    head = "".join(f"<th>{escape(column)}</th>" for column in table.columns)
    rows = "".join("<tr>" + "".join(map(_cell, row)) + "</tr>" for row in table.rows)
    return (
        f'<h2>{escape(table.title)}</h2><div class="scroll"><table><tr>{head}</tr>{rows}</table>'
        "</div>"
    )


def _text(value: object) -> str:
    return ", ".join(map(str, value)) if isinstance(value, list | tuple) else str(value)


def _cell(text: str) -> str:
    verdict = f' class="{text}"' if text in ("met", "missed") else ""
    return f"<td{verdict}>{escape(text)}</td>"


def _figure(picture: Picture) -> str:
    content = BytesIO()
    drawn_png(picture, content)
    data = base64.b64encode(content.getvalue()).decode("ascii")
    caption = escape(picture.caption)
    return (
        f'<figure><img alt="{caption}" src="data:image/png;base64,{data}">'
        f"<figcaption>{caption}</figcaption></figure>"
    )
