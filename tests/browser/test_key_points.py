"""A corner marked frame by frame in a real browser, and what the page tells of its place."""

import re

import numpy as np
import pytest
from playwright.sync_api import Page, expect

from tests.app.synthetic import frames
from tests.browser.outlines import go_to, origin, place, press_at

CORNER_M = np.array([3.5, 8.0, 0.2])
"""Of the panel's outer edge, which frames 1 to 4 of the synthetic source all show."""

PROJECTIONS = [frame.projection for frame in frames(4)]


def seen(number: int, *, by: tuple[float, float] = (0.0, 0.0)) -> tuple[float, float]:
    row, column = PROJECTIONS[number - 1].image_points(CORNER_M)
    return row + by[0], column + by[1]


def key_points(page: Page) -> dict:
    return page.request.get(f"{origin(page)}/api/key_points").json()


def row_of(page: Page, name: str):
    return page.locator(f".key-point[data-name='{name}']")


def mark(page: Page, number: int, *, by: tuple[float, float] = (0.0, 0.0)) -> None:
    go_to(page, number)
    press_at(page, seen(number, by=by))
    expect(page.locator(".key-point.active [aria-current]")).to_have_text(str(number))


def test_a_corner_marked_in_three_frames_is_found_and_marks_can_be_changed(editing) -> None:
    page = editing(4)
    page.locator("#frame-canvas").focus()
    page.keyboard.press("j")
    expect(page.locator("[data-tool=keypoint]")).to_have_attribute("aria-pressed", "true")
    expect(page.locator("#key-points")).to_be_visible()
    mark(page, 4, by=(0.4, -0.3))
    expect(row_of(page, "point 1")).to_contain_text("mark the same corner in at least two frames")
    mark(page, 3, by=(-0.5, 0.2))
    mark(page, 2, by=(0.2, 0.5))
    row = row_of(page, "point 1")
    expect(row).to_contain_text("3 marks")
    expect(row.locator("p").nth(1)).to_have_text(
        re.compile(r"worst residual \d\.\d\u202fpx, frame \d")
    )
    (point,) = key_points(page)["key_points"]
    assert np.linalg.norm(np.array(point["position_m"]) - CORNER_M) < 0.3
    assert [m["frame"] for m in point["marks"]] == [2, 3, 4]
    assert all(0 < m["residual_px"] < 2 for m in point["marks"])
    x, y, z = point["position_m"]
    shown = row.locator(".place").inner_text().replace("\u2212", "-").split()
    values = [float(text) for text in shown if re.fullmatch(r"-?\d+\.\d\d", text)]
    assert [values[0], values[2], values[4]] == [round(x, 2), round(y, 2), round(z, 2)]
    page.keyboard.press("Control+z")
    expect(row).to_contain_text("2 marks")
    assert [m["frame"] for m in key_points(page)["key_points"][0]["marks"]] == [3, 4]
    page.locator("#key-point-redo").click()
    expect(row).to_contain_text("3 marks")
    assert key_points(page)["key_points"] == [point]
    # A mark that is dragged to another corner is doubted, and can be taken away.
    press_at(page, seen(2, by=(0.2, 0.5)), seen(2, by=(9.2, 0.5)))
    expect(row.locator(".bad")).to_contain_text(["is it the same corner?", "2"])
    moved = next(m for m in key_points(page)["key_points"][0]["marks"] if m["frame"] == 2)
    assert (moved["row"], moved["column"]) == pytest.approx(seen(2, by=(9.2, 0.5)), abs=0.3)
    page.keyboard.press("Delete")
    expect(row).to_contain_text("2 marks")
    expect(row.locator(".bad")).to_have_count(0)


def test_points_are_begun_renamed_measured_and_deleted(editing) -> None:
    page = editing(4)
    page.locator("#frame-canvas").focus()
    page.keyboard.press("j")
    for number in (4, 3):
        mark(page, number)
    page.keyboard.press("Shift+J")
    expect(row_of(page, "point 2")).to_contain_text("click its corner")
    other_m = np.array([1.0, -8.0, 0.2])
    for number in (3, 4):
        go_to(page, number)
        press_at(page, tuple(PROJECTIONS[number - 1].image_points(other_m)))
        expect(page.locator(".key-point.active [aria-current]")).to_have_text(str(number))
    expect(page.locator("#key-point-value")).to_contain_text(re.compile(r"16\.\d\d\u202fm \["))
    page.get_by_role("button", name="Add to measurements").click()
    expect(page.locator("#key-point-measure")).to_have_text("Added to measurements")
    (item,) = page.request.get(f"{origin(page)}/api/measurements").json()["items"]
    assert item["low"] < np.linalg.norm(CORNER_M - other_m) < item["high"]
    assert "from the marks of its key points" in item["interval_note"]
    row_of(page, "point 2").get_by_role("button", name="Rename").click()
    name = page.get_by_role("textbox", name="Name of point 2")
    name.fill("panel's far corner")
    name.press("Enter")
    expect(page.locator(".key-point.active .choose")).to_have_text("panel's far corner")
    assert [p["name"] for p in key_points(page)["key_points"]] == ["point 1", "panel's far corner"]
    row_of(page, "point 1").get_by_role("button", name="Delete").click()
    expect(page.locator(".key-point")).to_have_count(1)
    expect(page.locator("#key-point-length")).to_be_hidden()


def test_where_a_corner_should_be_is_drawn_in_the_other_frames(editing) -> None:
    page = editing(4)
    page.locator("#frame-canvas").focus()
    page.keyboard.press("j")
    mark(page, 4)
    go_to(page, 2)
    amber = """(canvas, [x, y]) => {
      const scale = devicePixelRatio;
      const { data } = canvas.getContext("2d").getImageData(scale * x - 12, scale * y - 12, 24, 24);
      let count = 0;
      for (let at = 0; at < data.length; at += 4) {
        count += data[at] > 230 && data[at + 1] > 150 && data[at + 1] < 200 && data[at + 2] < 110;
      }
      return count;
    }"""
    box = page.locator("#frame-canvas").bounding_box()
    x, y = place(page, *seen(2))
    at = [x - box["x"], y - box["y"]]
    page.wait_for_function(
        f"(at) => ({amber})(document.querySelector('#overlay-canvas'), at) > 5", arg=at
    )
    on_line = page.locator("#overlay-canvas").evaluate(amber, at)
    page.keyboard.press("v")
    page.wait_for_function(
        f"(at) => ({amber})(document.querySelector('#overlay-canvas'), at) === 0", arg=at
    )
    page.keyboard.press("j")
    mark(page, 3)
    go_to(page, 2)
    page.wait_for_function(
        f"([at, past]) => ({amber})(document.querySelector('#overlay-canvas'), at) > past",
        arg=[at, on_line],
    )
