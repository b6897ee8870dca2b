"""Outlines that tools propose, in one frame and in all, in a real browser."""

from itertools import pairwise

import pytest
from playwright.sync_api import Route, expect

from tests.app.synthetic import source
from tests.browser.outlines import frame_facts, near, place, put_square, rings_of, wait_for_revision


def test_a_proposal_is_shown_before_it_is_kept(editing) -> None:
    page = editing()
    extracted = rings_of(page, 3)
    page.get_by_role("tab", name="Tools").click()
    page.get_by_role("button", name="Threshold").click()
    expect(page.locator("#tool-hint")).to_contain_text("Proposes")
    assert rings_of(page, 3) == extracted
    page.get_by_role("button", name="Discard").click()
    expect(page.locator("#tool-form")).to_be_hidden()
    page.locator("#frame-canvas").focus()
    page.keyboard.press("c")
    expect(page.locator("#tool-hint")).to_contain_text("Proposes")
    page.keyboard.press("Enter")
    wait_for_revision(page, 1)
    assert rings_of(page, 3) != extracted
    assert frame_facts(page, 3)["silhouette"]["edited"]


def test_all_frames_are_detected_anew_once_that_is_confirmed(editing) -> None:
    page = editing()
    page.keyboard.press("t")
    detect = page.get_by_role("button", name="Detect in all frames")
    # By the settings that found every outline there is nothing to do.
    expect(detect).to_be_disabled()
    expect(page.locator("#detect-why")).to_contain_text("change one first")
    page.get_by_label("Detection a₂").fill("15")
    expect(detect).to_be_enabled()
    page.get_by_label("Detection a₂").fill("5")
    expect(detect).to_be_disabled()
    page.keyboard.press("Escape")
    square = put_square(page, 2, shown=3)
    before = [rings_of(page, number) for number in (1, 2, 3)]
    page.keyboard.press("t")
    # An outline edited by hand can be overwritten.
    expect(detect).to_be_enabled()
    # GrabCut is for photographs.
    expect(page.get_by_role("button", name="GrabCut")).to_be_hidden()
    page.get_by_label("Detection a₂").fill("15")
    dialog = page.get_by_role("dialog", name="Detect in all frames")
    page.get_by_role("button", name="Detect in all frames").click()
    expect(dialog).to_contain_text("a₂ = 15 and a closing of 5\u202fpx the outlines of 2 frames")
    expect(dialog).to_contain_text("The edited outline of 1 frame is kept.")
    expect(dialog.get_by_role("button", name="Cancel")).to_be_focused()
    page.keyboard.press("Enter")
    expect(dialog).to_be_hidden()
    assert [rings_of(page, number) for number in (1, 2, 3)] == before
    page.get_by_role("button", name="Detect in all frames").click()
    expect(dialog.get_by_role("checkbox")).not_to_be_checked()
    dialog.get_by_role("button", name="Detect in 2 frames").click()
    expect(page.locator("#detect-done")).to_have_text(
        "Detected anew in 2 frames; 1 frame kept the edited outline."
    )
    wait_for_revision(page, 1)
    assert rings_of(page, 2) == square
    assert rings_of(page, 3) != before[2]
    page.get_by_role("button", name="Take it back").click()
    wait_for_revision(page, 2)
    assert [rings_of(page, number) for number in (1, 2, 3)] == before


def test_a_wire_follows_what_the_server_finds_and_a_seed_grows(visit) -> None:
    """The page's side of tools that a server may have: it asks as agreed, and draws the answer."""
    asked = []

    def bend(first: list[float], second: list[float]) -> list[float]:
        return [(first[0] + second[0]) / 2 + 1, (first[1] + second[1]) / 2 - 1]

    def answer(route: Route) -> None:
        order = route.request.post_data_json
        asked.append(order)
        points = order["parameters"].get("points", [])
        # A bend in the middle between each two points.
        path = [
            place for first, second in pairwise(points) for place in (first, bend(first, second))
        ]
        grown = [[[60, 60], [60, 90], [90, 90], [90, 60]]]
        found = {"rings": grown, "claim": "lit side", "note": "", "path": path + points[-1:]}
        route.fulfill(json=found)

    page = visit(source(2), playing=True).page
    page.route("**/api/tools", lambda route: route.fulfill(json=["livewire", "grow"]))
    page.route("**/proposals", answer)
    page.reload()
    expect(page.locator("#frame-canvas")).to_have_attribute("data-frame", "2")
    put_square(page, 2)
    page.keyboard.press("l")
    page.locator("#combining").select_option("replace")
    for corner in [(40, 40), (40, 70), (70, 70)]:
        page.mouse.click(*place(page, *corner))
        page.wait_for_timeout(100)
    page.mouse.click(*place(page, 40, 40))
    wait_for_revision(page, 2)
    assert len(rings_of(page, 2)[0]) == 6
    assert near(rings_of(page, 2), 56, 69)
    page.keyboard.press("f")
    page.mouse.click(*place(page, 75, 75))
    expect(page.locator("#tool-hint")).to_contain_text("Proposes 4 vertices")
    assert asked[-1]["parameters"] == {
        "tolerance_db": 8,
        "row": pytest.approx(75, abs=0.3),
        "column": pytest.approx(75, abs=0.3),
    }
    page.keyboard.press("Enter")
    wait_for_revision(page, 3)
    assert near(rings_of(page, 2), 90, 90, within=1e-3)
