"""Editing outlines in a real browser: each gesture ends on the server, and the hull follows."""

import re
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Page, Route, expect

from app.source import Source
from core.silhouettes.silhouette import clockwise_area_px
from tests.app.synthetic import empty_frame, frames, source

AXE = Path(__file__).parent / "vendor" / "axe.min.js"

PAINTED = """(colour) => {
  const canvas = document.querySelector("#overlay-canvas");
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  let count = 0;
  for (let at = 0; at < data.length; at += 4) {
    const isClose = colour.every((value, channel) => Math.abs(data[at + channel] - value) < 8);
    count += isClose && Math.abs(data[at + 3] - 128) < 8;
  }
  return count;
}"""
"""How many pixels over the picture are painted half through in a colour."""

Rings = list[list[list[float]]]


@pytest.fixture
def editing(visit) -> Callable[..., Page]:
    """Return a function that opens the page with all of so many frames received."""

    def open_page(count: int = 3, **options: Any) -> Page:
        page = visit(source(count), playing=True, **options).page
        expect(page.locator("#status")).to_have_text(re.compile(rf"All {count} frames? received"))
        expect(page.locator("#frame-canvas")).to_have_attribute("data-frame", str(count))
        return page

    return open_page


def frame_facts(page: Page, number: int) -> dict[str, Any]:
    return page.request.get(f"{origin(page)}/api/frames/{number}").json()


def rings_of(page: Page, number: int) -> Rings:
    return frame_facts(page, number)["silhouette"]["rings"]


def origin(page: Page) -> str:
    return page.evaluate("location.origin")


def hull_revision(page: Page) -> int:
    return page.request.get(f"{origin(page)}/api/state").json()["hull"]["revision"]


def info(page: Page, number: int) -> dict[str, Any]:
    state = page.request.get(f"{origin(page)}/api/state").json()
    return state["frames_info"][number - 1]


def wait_for_revision(page: Page, revision: int) -> None:
    """Wait until the page shows a revision of the outline and has nothing left to save."""
    canvas = page.locator("#frame-canvas")
    expect(canvas).to_have_attribute("data-revision", str(revision))
    expect(canvas).to_have_attribute("data-saving", "false")


def go_to(page: Page, number: int) -> None:
    page.locator(f"#frame-{number}").click()
    expect(page.locator("#frame-canvas")).to_have_attribute("data-frame", str(number))


def place(page: Page, row: float, column: float) -> tuple[float, float]:
    """Where a pixel of the frame lies in the window."""
    canvas = page.locator("#frame-canvas")
    box = canvas.bounding_box()
    plot = canvas.evaluate("(canvas) => JSON.parse(canvas.dataset.plot)")
    x = plot["x"] + (column - plot["column"]) / plot["columns"] * plot["width"]
    y = plot["y"] + (row - plot["row"]) / plot["rows"] * plot["height"]
    return box["x"] + x, box["y"] + y


def press_at(page: Page, *pixels: tuple[float, float]) -> None:
    """Press at a pixel, move through others, let go at the last."""
    page.mouse.move(*place(page, *pixels[0]))
    page.mouse.down()
    for pixel in pixels[1:]:
        page.mouse.move(*place(page, *pixel), steps=3)
    page.mouse.up()


def put_square(page: Page, number: int, low: float = 60.0, high: float = 100.0) -> Rings:
    """Give the frame on show a square for its outline, over the interface."""
    silhouette = frame_facts(page, number)["silhouette"]
    square = [[[low, low], [low, high], [high, high], [high, low]]]
    body = {
        "rings": square,
        "claim": silhouette["claim"],
        "component": silhouette["component"],
        "tool": "test",
        "base_revision": silhouette["revision"],
    }
    answer = page.request.put(f"{origin(page)}/api/frames/{number}/silhouette", data=body)
    assert answer.ok, answer.text()
    wait_for_revision(page, silhouette["revision"] + 1)
    return square


def area_px(page: Page, number: int) -> float:
    return sum(clockwise_area_px(np.array(ring)) for ring in rings_of(page, number))


def near(rings: Rings, row: float, column: float, within: float = 0.3) -> bool:
    """Whether a vertex lies there; a pointer moves by whole CSS pixels."""
    return any(
        abs(vertex[0] - row) < within and abs(vertex[1] - column) < within
        for ring in rings
        for vertex in ring
    )


def test_a_dragged_vertex_moves_the_outline_and_the_hull(editing) -> None:
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


def test_the_hull_previews_a_drag_and_escape_takes_it_back(editing) -> None:
    page = editing()
    square = put_square(page, 3)
    page.mouse.move(*place(page, 60, 60))
    page.mouse.down()
    page.mouse.move(*place(page, 75, 75), steps=4)
    expect(page.locator("#preview-chip")).to_be_visible()
    page.keyboard.press("Escape")
    page.mouse.up()
    expect(page.locator("#preview-chip")).to_be_hidden()
    assert rings_of(page, 3) == square
    assert frame_facts(page, 3)["silhouette"]["revision"] == 1


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
    page.keyboard.press("l")
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


def test_undo_and_redo_belong_to_their_frame(editing) -> None:
    page = editing()
    extracted = rings_of(page, 3)
    put_square(page, 3)
    press_at(page, (60, 60), (50, 50))
    wait_for_revision(page, 2)
    dragged = rings_of(page, 3)
    go_to(page, 2)
    expect(page.locator("#undo")).to_be_disabled()
    go_to(page, 3)
    page.keyboard.press("Control+z")
    wait_for_revision(page, 3)
    assert near(rings_of(page, 3), 60, 60, within=1e-3)
    page.get_by_role("button", name="Undo").click()
    wait_for_revision(page, 4)
    assert rings_of(page, 3) == extracted
    expect(page.locator("#undo")).to_be_disabled()
    page.locator("#frame-canvas").focus()
    page.keyboard.press("Control+Shift+Z")
    wait_for_revision(page, 5)
    page.get_by_role("button", name="Redo").click()
    wait_for_revision(page, 6)
    assert rings_of(page, 3) == dragged
    expect(page.locator("#redo")).to_be_disabled()


def test_the_claim_is_toggled_and_shown(editing) -> None:
    page = editing()
    put_square(page, 3)
    page.keyboard.press("k")
    wait_for_revision(page, 2)
    assert frame_facts(page, 3)["silhouette"]["claim"] == "complete"
    expect(page.locator("#claim-text")).to_have_text("Complete")


def test_frames_are_reviewed_and_leafed_through_by_keys(editing) -> None:
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
    expect(page.locator("#frame-2")).to_have_attribute("title", "Frame 2, 6.0\u202fs, to fix")


def test_an_excluded_frame_does_not_vote(editing) -> None:
    page = editing()
    expect(page.locator("#space-stamp")).to_contain_text("hull of 3 views")
    before = hull_revision(page)
    page.keyboard.press("x")
    expect(page.locator("#frame-3")).to_have_attribute("data-state", "excluded")
    expect(page.locator("#space-stamp")).to_contain_text("hull of 2 views")
    assert info(page, 3)["votes"] is False
    assert hull_revision(page) > before
    page.keyboard.press("x")
    expect(page.locator("#space-stamp")).to_contain_text("hull of 3 views")


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


def test_carving_is_set_and_a_refusal_is_the_servers_sentence(editing) -> None:
    page = editing()
    expect(page.locator("#threshold")).to_have_text("inside all 3 views")
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


def test_the_sheet_names_the_keys_and_no_key_acts_under_it(editing) -> None:
    page = editing()
    page.keyboard.press("?")
    sheet = page.get_by_role("dialog", name="Keys")
    expect(sheet).to_be_visible()
    expect(sheet).to_contain_text("Accept and go to the next frame to do")
    page.keyboard.press("x")
    page.keyboard.press("Escape")
    expect(sheet).to_be_hidden()
    assert info(page, 3)["state"] == "todo"


def test_keys_typed_into_a_field_are_no_shortcuts(editing) -> None:
    page = editing()
    page.get_by_label("Tolerated misses").press("x")
    page.get_by_label("Tolerated misses").press("2")
    page.wait_for_timeout(200)
    assert info(page, 3)["state"] == "todo"


def test_the_wheel_zooms_about_the_cursor_and_space_moves_the_picture(editing) -> None:
    page = editing()
    before = place(page, 70, 90)
    page.mouse.move(*before)
    page.mouse.wheel(0, -600)
    after = place(page, 70, 90)
    assert after == pytest.approx(before, abs=0.5)
    scale = abs(place(page, 70, 91)[0] - after[0])
    page.keyboard.down("Space")
    page.mouse.down()
    page.mouse.move(before[0] + 40, before[1] - 25)
    page.mouse.up()
    page.keyboard.up("Space")
    moved = place(page, 70, 90)
    assert moved == pytest.approx((before[0] + 40, before[1] - 25), abs=0.5)
    expect(page.locator("#status")).to_have_text("All 3 frames received")
    page.keyboard.press("f")
    assert abs(place(page, 70, 91)[0] - place(page, 70, 90)[0]) < 0.6 * scale


def test_levels_and_colours_are_kept_from_frame_to_frame(editing) -> None:
    page = editing()
    page.get_by_label("Colours").first.select_option("grey")
    page.get_by_label("Floor").fill("-25")
    expect(page.locator("#floor-value")).to_have_text("−25\u202fdB")
    go_to(page, 1)
    grey = page.locator("#frame-canvas").evaluate(
        """(canvas) => {
          const plot = JSON.parse(canvas.dataset.plot);
          const context = canvas.getContext("2d");
          const { data } = context.getImageData(plot.x, plot.y, plot.width, plot.height);
          let coloured = 0;
          for (let at = 0; at < data.length; at += 4) coloured += data[at] !== data[at + 2];
          return coloured / (data.length / 4);
        }"""
    )
    assert grey < 0.02
    expect(page.locator("#floor-value")).to_have_text("−25\u202fdB")


def test_panes_are_resized_by_keys_and_remembered(editing) -> None:
    page = editing(1)
    separator = page.get_by_role("separator", name="Width of the frame's pane")
    width = page.locator(".panel.frame").bounding_box()["width"]
    for _ in range(5):
        separator.press("ArrowRight")
    wider = page.locator(".panel.frame").bounding_box()["width"]
    assert wider > width + 50
    page.reload()
    expect(page.locator("#frame-canvas")).to_have_attribute("data-frame", "1")
    assert page.locator(".panel.frame").bounding_box()["width"] == pytest.approx(wider, abs=1)


def test_axe_finds_nothing_serious(visit) -> None:
    def with_an_empty_one():
        first, second = frames(2)
        yield from (first, second, empty_frame())

    page = visit(Source(name="a gap", frames=with_an_empty_one), playing=True).page
    expect(page.locator("#frame-canvas")).to_have_attribute("data-frame", "3")
    # The page's policy lets no foreign script in; evaluating one is the debugger's right.
    page.evaluate(AXE.read_text("utf-8"))
    assert serious_violations(page) == []
    page.keyboard.press("t")
    expect(page.locator("#tool-form")).to_be_visible()
    assert serious_violations(page) == []
    page.keyboard.press("Escape")
    page.keyboard.press("?")
    expect(page.get_by_role("dialog")).to_be_visible()
    assert serious_violations(page) == []


def serious_violations(page: Page) -> list[tuple[str, str]]:
    found = page.evaluate("axe.run(document, { iframes: false })")
    return [
        (each["id"], each["nodes"][0]["html"])
        for each in found["violations"]
        if each["impact"] in ("serious", "critical")
    ]


def test_the_disagreement_of_hull_and_outline_is_painted_and_hidden(editing) -> None:
    page = editing(6)
    put_square(page, 6, 45.0, 115.0)
    green = [95, 214, 138]
    assert page.evaluate(PAINTED, green) == 0
    page.keyboard.press("r")
    wait_until(page, lambda: page.evaluate(PAINTED, green) > 500)
    page.keyboard.down("h")
    wait_until(page, lambda: page.evaluate(PAINTED, green) == 0)
    page.keyboard.up("h")
    wait_until(page, lambda: page.evaluate(PAINTED, green) > 500)


def wait_until(page: Page, holds: Callable[[], bool]) -> None:
    for _ in range(100):
        if holds():
            return
        page.wait_for_timeout(100)
    pytest.fail("waited ten seconds in vain")


def test_escape_gives_the_keys_back_from_the_view_in_space(editing) -> None:
    page = editing(1)
    page.locator("#viewport").evaluate("(frame) => frame.contentWindow.focus()")
    assert page.evaluate("document.activeElement.id") == "viewport"
    page.keyboard.press("Escape")
    assert page.evaluate("document.activeElement.id") == "frame-canvas"


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


def test_a_wire_follows_what_the_server_finds_and_a_seed_grows(visit) -> None:
    """The page's side of tools that a server may have: it asks as agreed, and draws the answer."""
    asked = []

    def answer(route: Route) -> None:
        order = route.request.post_data_json
        asked.append(order)
        points = order["parameters"].get("points", [])
        # A bend in the middle between each two points.
        path = [
            place
            for first, second in pairwise(points)
            for place in (first, [(a + b) / 2 + 1 for a, b in zip(first, second, strict=True)])
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
    page.keyboard.press("w")
    page.locator("#combining").select_option("replace")
    for corner in [(40, 40), (40, 70), (70, 70)]:
        page.mouse.click(*place(page, *corner))
        page.wait_for_timeout(100)
    page.mouse.click(*place(page, 40, 40))
    wait_for_revision(page, 2)
    assert len(rings_of(page, 2)[0]) == 6
    assert near(rings_of(page, 2), 56, 71)
    page.keyboard.press("i")
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
