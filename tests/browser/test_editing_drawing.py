"""Drawing outlines in a real browser: each gesture ends on the server, and the hull follows."""

import pytest
from playwright.sync_api import Page, expect

from tests.app.synthetic import source
from tests.browser.outlines import (
    area_px,
    frame_facts,
    hull_revision,
    near,
    origin,
    place,
    press_at,
    put_square,
    rings_of,
    wait_for_revision,
    wait_until,
)


def test_a_dragged_vertex_moves_the_hull_and_escape_takes_a_drag_back(editing) -> None:
    page = editing()
    put_square(page, 3)
    before = hull_revision(page)
    volume = page.locator("#hull-facts").inner_text()
    press_at(page, (60, 60), (70, 75))
    wait_for_revision(page, 2)
    rings = rings_of(page, 3)
    assert near(rings, 70, 75)
    assert not near(rings, 60, 60)
    assert near(rings, 100, 100, within=1e-3)
    expect(page.locator("#hull-facts")).not_to_have_text(volume)
    assert hull_revision(page) > before
    assert page.locator("#revision").inner_text() == f"rev {hull_revision(page)}"
    expect(page.locator("#frame-3")).to_have_class("received latest shown edited")
    dragged = rings
    page.mouse.move(*place(page, 100, 100))
    page.mouse.down()
    page.mouse.move(*place(page, 85, 85), steps=4)
    expect(page.locator("#preview-chip")).to_be_visible()
    # Keys that keep something wait for the end of the stroke.
    page.keyboard.press("k")
    page.keyboard.press("Control+z")
    page.keyboard.press("Escape")
    page.mouse.up()
    expect(page.locator("#preview-chip")).to_be_hidden()
    silhouette = frame_facts(page, 3)["silhouette"]
    assert silhouette["rings"] == dragged
    assert (silhouette["revision"], silhouette["claim"]) == (2, "lit side")


def test_a_frame_that_arrives_does_not_end_a_drag(visit) -> None:
    page = visit(source(2)).page
    page.get_by_role("button", name="Step").click()
    expect(page.locator("#frame-canvas")).to_have_attribute("data-frame", "1")
    put_square(page, 1)
    page.mouse.move(*place(page, 60, 60))
    page.mouse.down()
    page.mouse.move(*place(page, 55, 55), steps=2)
    page.request.post(f"{origin(page)}/api/playback", data={"action": "step"})
    expect(page.locator("#status")).to_have_text("All 2 frames received")
    page.mouse.move(*place(page, 50, 50), steps=2)
    page.mouse.up()
    expect(page.locator("#frame-canvas")).to_have_attribute("data-frame", "2")
    wait_until(page, lambda: near(rings_of(page, 1), 50, 50))


def test_vertices_are_put_in_at_middles_and_taken_out(editing) -> None:
    page = editing()
    put_square(page, 3)
    press_at(page, (60, 80), (55, 80))
    wait_for_revision(page, 2)
    assert len(rings_of(page, 3)[0]) == 5
    assert near(rings_of(page, 3), 55, 80)
    page.keyboard.press("Delete")
    wait_for_revision(page, 3)
    assert len(rings_of(page, 3)[0]) == 4
    page.keyboard.down("Alt")
    page.mouse.click(*place(page, 100, 100))
    page.keyboard.up("Alt")
    wait_for_revision(page, 4)
    assert len(rings_of(page, 3)[0]) == 3
    assert not near(rings_of(page, 3), 100, 100)


def test_a_polygon_adds_to_the_outline_or_cuts_out_of_it(editing) -> None:
    page = editing()
    put_square(page, 3)
    page.keyboard.press("p")
    for corner in [(90, 90), (90, 120), (120, 120)]:
        page.mouse.click(*place(page, *corner))
    page.keyboard.press("Enter")
    wait_for_revision(page, 2)
    rings = rings_of(page, 3)
    assert len(rings) == 1
    assert near(rings, 120, 120)
    assert near(rings, 60, 60)
    page.locator("#combining").select_option("cut")
    page.locator("#frame-canvas").focus()
    for corner in [(70, 70), (70, 80), (80, 80), (80, 70)]:
        page.mouse.click(*place(page, *corner))
    page.mouse.click(*place(page, 70, 70))
    wait_for_revision(page, 3)
    assert len(rings_of(page, 3)) == 2
    # The square, the triangle without their common corner, and the hole.
    assert area_px(page, 3) == pytest.approx(1600 + 450 - 50 - 100, rel=0.03)


def test_lasso_brush_and_eraser_reach_the_server(editing) -> None:
    page = editing()
    put_square(page, 3)
    area = area_px(page, 3)
    page.keyboard.press("a")
    press_at(page, (95, 70), (115, 70), (115, 90), (95, 90))
    wait_for_revision(page, 2)
    with_lasso = area_px(page, 3)
    assert with_lasso == pytest.approx(area + 15 * 20, rel=0.02)
    page.keyboard.press("b")
    press_at(page, (80, 98), (80, 112))
    wait_for_revision(page, 3)
    with_brush = area_px(page, 3)
    assert with_brush > with_lasso + 50
    page.keyboard.press("e")
    press_at(page, (62, 62), (62, 70))
    wait_for_revision(page, 4)
    assert area_px(page, 3) < with_brush - 20


def test_the_hull_follows_a_stroke_that_is_not_kept_yet(editing) -> None:
    page = editing()
    put_square(page, 3)
    rings, hull = rings_of(page, 3), faces(page)
    page.keyboard.press("e")
    page.mouse.move(*place(page, 62, 62))
    page.mouse.down()
    page.mouse.move(*place(page, 62, 85), steps=6)
    expect(page.locator("#preview-chip")).to_be_visible()
    wait_until(page, lambda: faces(page) != hull)
    page.keyboard.press("Escape")
    page.mouse.up()
    expect(page.locator("#preview-chip")).to_be_hidden()
    assert faces(page) == hull
    assert rings_of(page, 3) == rings


def faces(page: Page) -> int:
    return page.request.get(f"{origin(page)}/api/state").json()["hull"]["faces"]
