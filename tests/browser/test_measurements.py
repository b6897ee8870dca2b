"""The book of measurements in a real browser: added, edited, exported, and taken in again."""

import json
import re

import pytest
from playwright.sync_api import Page, expect

from tests.app.synthetic import source
from tests.browser.outlines import hull_revision, origin, put_square

SPAN = {
    "kind": "line feature",
    "name": "span",
    "start": {"kind": "part end", "near_m": [0, 0, 0], "toward": [0, -1, 0], "reach_m": 5},
    "end": {"kind": "part end", "near_m": [0, 0, 0], "toward": [0, 1, 0], "reach_m": 5},
}


def post(page: Page, path: str, **body: object) -> dict:
    headers = {"Content-Type": "application/json"}
    answer = page.request.post(f"{origin(page)}{path}", data=json.dumps(body), headers=headers)
    return answer.json()


def state_intervals(page: Page) -> None:
    """Ask for intervals as the button does, which is away while they come by themselves."""
    page.request.put(f"{origin(page)}/api/measurements/intervals", data={"action": "start"})


def row(page: Page, name: str):
    return page.locator(f'#book-rows .item[data-name="{name}"]')


def table(page: Page) -> list[str]:
    """What the list shows, but for the changes, which an import knows nothing of."""
    rows = page.locator("#book-rows .item")
    parts = ".item-name, .item-value, .item-interval, .item-vector"
    return [" | ".join(rows.nth(n).locator(parts).all_text_contents()) for n in range(rows.count())]


def test_a_length_follows_an_edit_and_comes_back_from_its_file(editing, tmp_path) -> None:
    page = editing(6)
    post(page, "/api/measurements", spec=SPAN)
    span = row(page, "span")
    expect(span.locator(".item-value")).to_have_text(re.compile(r"^1\d\.\d\d\u202fm$"))
    page.keyboard.press("n")
    page.locator("[data-measure=volume]").click()
    expect(row(page, "volume 1").locator(".item-value")).to_have_text(re.compile("m³$"))
    page.locator("#book-add").click()
    page.locator("[data-pair='scale factor']").click()
    expect(row(page, "span / volume 1")).to_contain_text("scale factor needs lengths")
    before, revision = row(page, "volume 1").inner_text(), hull_revision(page)

    put_square(page, 2, 70.0, 90.0, shown=6)
    volume = row(page, "volume 1")
    expect(volume).to_have_attribute("data-revision", str(hull_revision(page)))
    assert hull_revision(page) > revision
    assert volume.inner_text() != before
    expect(volume.locator(".item-change")).to_have_text(re.compile(r"^−\d+\.\d$"))
    expect(volume).not_to_have_class(re.compile("stale"))

    state_intervals(page)
    expect(span.locator(".item-interval")).to_have_text(re.compile(r"^\[\d+\.\d, \d+\.\d\]$"))
    shown = table(page)
    with page.expect_download() as download:
        page.locator("#book-csv").click()
    path = tmp_path / "all.csv"
    download.value.save_as(path)
    page.locator("#book-clear").click()
    expect(page.locator("#book-rows .item")).to_have_count(0)
    expect(page.locator("#book-empty")).to_be_visible()
    page.locator("#measurements-file").set_input_files(path)
    expect(page.locator("#book-rows .item")).to_have_count(3)
    state_intervals(page)
    expect(span.locator(".item-interval")).to_have_text(re.compile(r"^\["))
    assert table(page) == shown


def test_the_list_is_renamed_hidden_deleted_and_taken_back_where_it_stands(editing) -> None:
    page = editing(6)
    post(page, "/api/measurements", spec=SPAN)
    factor = {"kind": "scale factor", "name": "b", "first": "span", "second": "span"}
    post(page, "/api/measurements", spec=factor)
    span = row(page, "span")
    span.locator(".item-name").click()
    expect(span.locator(".facts")).to_contain_text("undirected")
    expect(span.locator(".facts")).to_contain_text("constrain it well")
    span.locator(".item-name").press("F2")
    page.keyboard.type("l₂")
    page.keyboard.press("Enter")
    expect(row(page, "l₂").locator(".facts")).to_be_visible()
    row(page, "l₂").get_by_role("button", name="Hide").click()
    expect(row(page, "l₂")).to_contain_text("hidden")
    row(page, "l₂").get_by_role("textbox", name="Note").fill("tip to tip")
    row(page, "l₂").get_by_role("textbox", name="Note").press("Tab")
    expect(row(page, "l₂").locator(".item-name")).to_have_attribute("title", "tip to tip")
    row(page, "l₂").get_by_role("button", name="Delete").click()
    expect(page.get_by_role("dialog")).to_contain_text("b is computed from it")
    page.get_by_role("button", name="Delete all of it").click()
    expect(page.locator("#book-rows .item")).to_have_count(0)
    page.locator("#book-undo").click()
    expect(page.locator("#book-rows .item")).to_have_count(2)
    for _ in range(3):
        page.locator("#book-undo").click()
    expect(row(page, "span")).to_be_visible()


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"nothing", "no JSON"),
        (
            json.dumps(
                {
                    "format": "radarhull measurements",
                    "version": 1,
                    "measurements": [
                        {
                            "kind": "volume",
                            "name": "v",
                            "reading": {"value": 1.0, "unit": "m³", "frame": "ECI"},
                        }
                    ],
                }
            ).encode(),
            'the frame must be one of target, RTN, TEME, got "ECI"',
        ),
    ],
)
def test_a_file_that_is_none_is_refused_in_words_and_loses_nothing(editing, content, words) -> None:
    page = editing(6)
    post(page, "/api/measurements", spec=SPAN)
    expect(row(page, "span")).to_be_visible()
    file = {"name": "m.json", "mimeType": "application/json", "buffer": content}
    page.locator("#measurements-file").set_input_files(file)
    expect(page.locator("#book-complaint")).to_contain_text(words)
    expect(page.locator("#book-rows .item")).to_have_count(1)


def test_what_the_views_do_not_observe_has_words_and_no_number(visit) -> None:
    page = visit(source(8, one_pass=True), playing=True).page
    expect(page.locator("#status")).to_have_attribute("data-status", "finished")
    across = {**SPAN, "name": "across"}
    expect(page.locator("#hull-body")).to_be_visible()
    post(page, "/api/measurements", spec=across)
    expect(row(page, "across").locator(".item-value")).to_have_text("not observed")
    expect(row(page, "across")).to_contain_text("These views do not constrain it")
