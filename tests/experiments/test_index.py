import base64
import re

import cv2
import numpy as np
import pytest

from core.experiments.index import MOST_ROWS, Entry, names_of, summary, write_index
from core.experiments.pictures import Picture, write_pictures
from core.experiments.results import Figure, Results, Table


def results(name, *figures, tables=()):
    return Results(
        name=name, settings={"seed": 1}, figures=figures, tables=tables, finding=f"{name} <found>."
    )


MET = Figure(name="a", value=1, wanted="<= 2")
MISSED = Figure(name="b", value=3, wanted="<= 2")


@pytest.fixture
def entries(tmp_path):
    pictures = [
        Picture(name=name, caption="", draw=lambda canvas: None, size_in=(2.0, 1.0))
        for name in ("fine-frames", "fine-hull")
    ]
    write_pictures(pictures, tmp_path / "fine")
    rows = tuple((f"row {number}", "1") for number in range(MOST_ROWS + 3))
    table = Table(title="Main", columns=("", "IoU"), rows=rows)
    return [
        Entry(
            name="fine",
            wall_s=83.4,
            results=results("fine", MET, MISSED, tables=(table,)),
            pictures=names_of(pictures),
            has_hull=True,
        ),
        Entry(name="plain", wall_s=2.0, results=results("plain", *[MET] * 20, MISSED)),
        Entry(name="broken", wall_s=1.0, problem="Wanted <more>, got less."),
        Entry(name="absent", problem="Needs its data.", is_skipped=True),
    ]


@pytest.fixture
def page(entries, tmp_path):
    write_index(tmp_path / "index.html", entries)
    return (tmp_path / "index.html").read_text(encoding="utf-8")


def section(page, name):
    assert page.count(f'<a href="#{name}">{name}</a>') == 1
    return re.search(rf'<section id="{name}">.*?</section>', page, re.DOTALL)[0]


def test_the_page_needs_no_other_file_and_links_what_there_is(page):
    assert not re.findall(r"src=\"(?!data:)", page)
    assert "<script" not in page
    assert set(re.findall(r"href=\"([^#\"]+)\"", page)) == {
        "fine/report.html",
        "fine/results.json",
        "fine/hull.glb",
        "plain/report.html",
        "plain/results.json",
    }


def test_each_experiment_says_what_it_found_or_why_not(page):
    assert "fine &lt;found&gt;." in section(page, "fine")
    assert "targets met: 1 of 2 · 1 min 23 s" in section(page, "fine")
    assert "Wanted &lt;more&gt;, got less." in section(page, "broken")
    assert 'class="badge failed"' in section(page, "broken")
    assert 'class="badge skipped"' in section(page, "absent")
    assert "2 of 4 experiments ran in 1 min 26 s, 1 skipped: 21 of 23 targets met." in page


def test_a_long_table_is_cut_and_says_so(page):
    assert section(page, "fine").count("<tr>") == 1 + MOST_ROWS
    assert "3 more rows in the report" in section(page, "fine")


def test_without_a_table_missed_targets_come_first(page):
    verdicts = re.findall(r'td class="(met|missed)"', section(page, "plain"))
    assert verdicts == ["missed", *["met"] * (MOST_ROWS - 1)]


def test_the_thumbnail_is_the_hull_in_its_proportions(page):
    (data,) = re.findall(r'alt="fine-hull" src="data:image/png;base64,([^"]+)"', page)
    image = cv2.imdecode(np.frombuffer(base64.b64decode(data), np.uint8), cv2.IMREAD_COLOR)
    assert image.shape[1] == 2 * image.shape[0]


def test_the_summary_counts_and_holds_the_time_against_what_is_wanted(entries):
    told = {figure.name: figure for figure in summary(entries).figures}
    assert told["experiments failed"].met is False
    assert told["wall time"].met is True
    assert told["wall time"].value == pytest.approx(86.4 / 60)
    slow = [Entry(name="slow", wall_s=1801.0, results=results("slow", MET))]
    assert next(iter(summary(slow).figures)).met is False


def test_an_entry_holds_its_results_own_json(entries):
    fine, _, broken, _ = (entry.to_json() for entry in entries)
    assert fine["figures"] == entries[0].results.to_json()["figures"]
    assert (broken["outcome"], broken["figures"]) == ("failed", [])
