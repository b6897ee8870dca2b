"""Undo, claims and labels of outlines in a real browser, and edits that meet others."""

import re

from playwright.sync_api import expect

from tests.browser.outlines import (
    frame_facts,
    go_to,
    near,
    origin,
    place,
    press_at,
    put_square,
    rings_of,
    wait_for_revision,
)


def test_undo_and_redo_belong_to_their_frame(editing) -> None:
    page = editing()
    extracted = rings_of(page, 3)
    put_square(page, 3)
    press_at(page, (60, 60), (50, 50))
    wait_for_revision(page, 2)
    dragged = rings_of(page, 3)
    go_to(page, 2)
    untouched = rings_of(page, 2)
    expect(page.locator("#undo")).to_have_attribute("title", re.compile("Go to frame 3"))
    page.locator("#frame-canvas").focus()
    # The first only goes to the frame of the last edit; the second undoes it there.
    page.keyboard.press("Control+z")
    expect(page.locator("#frame-canvas")).to_have_attribute("data-frame", "3")
    assert rings_of(page, 3) == dragged
    assert frame_facts(page, 3)["silhouette"]["revision"] == 2
    page.keyboard.press("Control+z")
    wait_for_revision(page, 3)
    assert near(rings_of(page, 3), 60, 60, within=1e-3)
    page.get_by_role("button", name="Undo", exact=True).click()
    wait_for_revision(page, 4)
    assert rings_of(page, 3) == extracted
    assert rings_of(page, 2) == untouched
    expect(page.locator("#undo")).to_be_disabled()
    go_to(page, 1)
    page.locator("#frame-canvas").focus()
    page.keyboard.press("Control+Shift+Z")
    expect(page.locator("#frame-canvas")).to_have_attribute("data-frame", "3")
    assert rings_of(page, 3) == extracted
    page.keyboard.press("Control+Shift+Z")
    wait_for_revision(page, 5)
    page.get_by_role("button", name="Redo", exact=True).click()
    wait_for_revision(page, 6)
    assert rings_of(page, 3) == dragged
    expect(page.locator("#redo")).to_be_disabled()


def test_a_claim_is_set_and_leaves_the_rings_as_they_are(editing) -> None:
    page = editing()
    put_square(page, 3)
    page.keyboard.press("k")
    wait_for_revision(page, 2)
    assert frame_facts(page, 3)["silhouette"]["claim"] == "complete"
    expect(page.locator("#claim-text")).to_have_text("Complete")
    assert frame_facts(page, 3)["silhouette"]["provenance"] == "edited with test"


def test_two_pages_in_conflict_lose_neither_outline(editing, browser) -> None:
    page = editing()
    put_square(page, 3)
    other = browser.new_page()
    other.route(re.compile(r":\d+/viewport/"), lambda route: route.fulfill(body=""))
    other.goto(origin(page))
    expect(other.locator("#frame-canvas")).to_have_attribute("data-frame", "3")
    page.mouse.move(*place(page, 60, 60))
    page.mouse.down()
    page.mouse.move(*place(page, 50, 50), steps=2)
    other.mouse.move(*place(other, 100, 100))
    other.mouse.down()
    other.mouse.move(*place(other, 110, 110), steps=2)
    other.mouse.up()
    wait_for_revision(other, 2)
    page.mouse.up()
    banner = page.get_by_role("alert").first
    expect(banner).to_contain_text("yours is the dashed one")
    assert near(rings_of(page, 3), 110, 110)
    page.get_by_role("button", name="Keep mine").click()
    wait_for_revision(page, 3)
    assert near(rings_of(page, 3), 50, 50)
    assert near(rings_of(page, 3), 100, 100)
    expect(banner).to_be_hidden()
    # The other page follows without being asked.
    wait_for_revision(other, 3)
    other.close()


def test_an_outline_that_the_server_did_not_take_is_not_lost(editing) -> None:
    page = editing()
    put_square(page, 3)
    page.route("**/silhouette", lambda route: route.abort())
    press_at(page, (60, 60), (50, 50))
    expect(page.get_by_role("alert").first).to_contain_text("was not saved")
    page.unroute("**/silhouette")
    page.get_by_role("button", name="Keep mine").click()
    wait_for_revision(page, 2)
    assert near(rings_of(page, 3), 50, 50)
