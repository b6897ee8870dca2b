"""Reviewing frames by keys, and carving by other settings, in a real browser."""

import re

from playwright.sync_api import expect

from tests.app.synthetic import source
from tests.browser.outlines import frame_facts, go_to, hull_revision, info, origin


def test_frames_are_reviewed_leafed_through_and_excluded_by_keys(editing) -> None:
    page = editing()
    page.keyboard.press("PageUp")
    expect(page.locator("#frame-canvas")).to_have_attribute("data-frame", "2")
    page.keyboard.press("3")
    expect(page.locator("#frame-2")).to_have_attribute("data-state", "fix")
    page.keyboard.press("PageDown")
    expect(page.locator("#frame-canvas")).to_have_attribute("data-frame", "3")
    page.keyboard.press("Enter")
    expect(page.locator("#frame-3")).to_have_attribute("data-state", "ok")
    # The next to do after the last, frame 2 being one to fix.
    expect(page.locator("#frame-canvas")).to_have_attribute("data-frame", "1")
    assert [info(page, number)["state"] for number in (1, 2, 3)] == ["todo", "fix", "ok"]
    expect(page.locator("#frame-2")).to_have_attribute(
        "title", re.compile("^Frame 2, 6.0\u202fs, to fix")
    )
    go_to(page, 3)
    page.locator("#frame-canvas").focus()
    expect(page.locator("#space-stamp")).to_contain_text("hull of 3 views")
    before = hull_revision(page)
    page.keyboard.press("x")
    expect(page.locator("#frame-3")).to_have_attribute("data-state", "excluded")
    expect(page.locator("#space-stamp")).to_contain_text("hull of 2 views")
    assert info(page, 3)["votes"] is False
    assert hull_revision(page) > before
    page.keyboard.press("x")
    expect(page.locator("#space-stamp")).to_contain_text("hull of 3 views")


def test_carving_is_set_and_a_refusal_is_the_servers_sentence(editing) -> None:
    page = editing()
    expect(page.locator("#threshold")).to_have_text("inside all 3 views")
    page.get_by_role("button", name="Carving").click()
    expect(page.get_by_label("Last frame that votes")).to_be_in_viewport(ratio=1)
    misses = page.get_by_label("Tolerated misses")
    misses.fill("1")
    misses.press("Enter")
    expect(page.locator("#threshold")).to_have_text("inside at least 2 of 3 views")
    spacing = page.get_by_label("Voxel size, cm")
    spacing.fill("0.6")
    spacing.press("Enter")
    answer = page.request.put(f"{origin(page)}/api/carving", data={"spacing_m": 0.006})
    assert answer.status == 422
    expect(page.get_by_role("alert").first).to_contain_text(answer.json()["detail"])


def test_frames_that_emptied_the_hull_are_named_and_excluded(visit) -> None:
    page = visit(source(3), playing=True).page
    expect(page.locator("#frame-canvas")).to_have_attribute("data-frame", "3")
    silhouette = frame_facts(page, 3)["silhouette"]
    corner = [[[2.0, 2.0], [2.0, 8.0], [8.0, 8.0], [8.0, 2.0]]]
    body = {
        "rings": corner,
        "claim": silhouette["claim"],
        "component": silhouette["component"],
        "tool": "test",
        "base_revision": silhouette["revision"],
    }
    page.request.put(f"{origin(page)}/api/frames/3/silhouette", data=body)
    expect(page.locator("#hull-empty")).to_contain_text("The hull is empty")
    page.get_by_role("button", name="Exclude frame 3").click()
    expect(page.locator("#frame-3")).to_have_attribute("data-state", "excluded")
    expect(page.locator("#hull-body")).to_be_visible()


def test_the_sheet_names_the_keys_and_nothing_typed_elsewhere_is_one(editing) -> None:
    page = editing()
    page.keyboard.press("?")
    sheet = page.get_by_role("dialog", name="Keys")
    expect(sheet).to_be_visible()
    expect(sheet).to_contain_text("Accept and go to the next frame to do")
    # All of it can be read without scrolling.
    assert sheet.evaluate("(sheet) => sheet.scrollHeight <= sheet.clientHeight")
    page.keyboard.press("x")
    page.keyboard.press("Escape")
    expect(sheet).to_be_hidden()
    fields = page.get_by_label("Tolerated misses"), page.get_by_role("combobox", name="Part")
    for field in fields:
        field.press("x")
        field.press("2")
    page.wait_for_timeout(200)
    assert info(page, 3)["state"] == "todo"
    page.locator("#viewport").evaluate("(frame) => frame.contentWindow.focus()")
    assert page.evaluate("document.activeElement.id") == "viewport"
    page.keyboard.press("Escape")
    assert page.evaluate("document.activeElement.id") == "frame-canvas"


def test_no_key_means_two_things(editing) -> None:
    """Two rows with one binding would silently leave only the latter."""
    page = editing(1)
    twice = page.evaluate(
        """async () => {
          const { allBindings } = await import("/modules/shortcuts.js");
          const keys = allBindings();
          return keys.filter((key, index) => keys.indexOf(key) !== index);
        }"""
    )
    assert twice == []
