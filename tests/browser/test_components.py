"""Parts of the target in a real browser: outlined in frames, they get hulls of their own."""

import re

from playwright.sync_api import Page, expect

from tests.browser.outlines import go_to, near, origin, place, press_at, wait_until

SQUARE = [(70, 70), (70, 90), (90, 90), (90, 70)]


def state(page: Page) -> dict:
    return page.request.get(f"{origin(page)}/api/state").json()


def rings_of_part(page: Page, number: int, label: str) -> list:
    path = f"{origin(page)}/api/frames/{number}?component={label}"
    return page.request.get(path).json()["silhouette"]["rings"]


def draw_square(page: Page) -> None:
    page.keyboard.press("p")
    for corner in SQUARE:
        page.mouse.click(*place(page, *corner))
    page.keyboard.press("Enter")
    expect(page.locator("#frame-canvas")).to_have_attribute("data-saving", "false")


def begin_part(page: Page, name: str) -> None:
    page.locator("#component").select_option(label="New part…")
    page.locator("#new-part-name").fill(name)
    page.keyboard.press("Enter")


def test_a_part_drawn_in_three_frames_gets_a_hull_and_numbers_of_its_own(editing) -> None:
    page = editing(4)
    before = state(page)["hull"]
    whole = lengths(page)
    go_to(page, 1)
    begin_part(page, " ")
    expect(page.locator("#new-part-complaint")).to_contain_text("1 to 40 printable characters")
    page.locator("#new-part-name").fill("knife")
    page.keyboard.press("Enter")
    expect(page.locator("#new-part")).to_be_hidden()
    expect(page.locator("#component")).to_have_value("knife")
    hint = "Draw the knife in this frame; frames without it don’t count."
    expect(page.locator("#part-hint")).to_have_text(hint)
    for number in (1, 2, 3):
        go_to(page, number)
        expect(page.locator("#component")).to_have_value("knife")
        draw_square(page)
        expect(page.locator("#part-hint")).to_be_hidden()
    part = page.locator("[data-part=knife]")
    expect(part.locator("h3")).to_contain_text(re.compile(r"knife3 views, rev \d+"))
    (knife,) = state(page)["components"]
    expect(part).to_have_attribute("data-revision", str(knife["hull"]["revision"]))
    expect(part.locator(".extents").first).to_contain_text("m")
    assert state(page)["hull"] == before
    assert lengths(page) == whole
    # A vertex of the part moves the part's hull, and undo is of this layer only.
    page.keyboard.press("v")
    press_at(page, SQUARE[0], (60, 60))
    expect(part).not_to_have_attribute("data-revision", str(knife["hull"]["revision"]))
    wait_until(page, lambda: near(rings_of_part(page, 3, "knife"), 60, 60))
    expect(page.locator("#frame-canvas")).to_have_attribute("data-saving", "false")
    page.keyboard.press("Control+z")
    wait_until(page, lambda: near(rings_of_part(page, 3, "knife"), *SQUARE[0]))
    assert state(page)["hull"] == before


def lengths(page: Page) -> list[str]:
    """The whole's lengths on the page, without the intervals that come when it is quiet."""
    cells = page.locator("#hull-body .extents td").all_inner_texts()
    return [cell.split("\u202fm")[0] for cell in cells]


def test_layers_are_switched_and_a_part_is_deleted_after_a_question(editing) -> None:
    page = editing(2)
    begin_part(page, "solar panel")
    expect(page.locator("#new-part")).to_be_hidden()
    expect(page.locator("#component")).to_have_value("solar panel")
    draw_square(page)
    expect(page.locator("#component option:checked")).to_have_text("solar panel (1 frame)")
    page.locator("#component").select_option("target")
    expect(page.locator("#overlay-legend")).to_contain_text("solar panel")
    expect(page.locator("#delete-part")).to_be_hidden()
    expect(page.locator("#undo")).to_be_disabled()
    page.locator("#component").select_option("solar panel")
    expect(page.locator("#overlay-legend")).to_contain_text("target")
    expect(page.locator("#undo")).to_be_enabled()
    page.locator("#delete-part").click()
    expect(page.get_by_role("dialog")).to_contain_text("goes from 1 frame")
    page.keyboard.press("Enter")
    expect(page.get_by_role("dialog")).to_be_hidden()
    assert len(state(page)["components"]) == 1
    page.locator("#delete-part").click()
    page.get_by_role("button", name="Delete", exact=True).click()
    expect(page.locator("[data-part]")).to_have_count(0)
    expect(page.locator("#part-hint")).to_contain_text("Draw the solar panel in this frame")
    expect(page.get_by_role("dialog")).to_be_hidden()
    page.wait_for_load_state("networkidle")  # the frame comes anew, with what can be undone
    page.keyboard.press("Control+z")
    expect(page.locator("[data-part]")).to_have_count(1)
