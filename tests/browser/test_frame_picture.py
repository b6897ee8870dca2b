"""The picture of a frame in a real browser: levels, layers, zoom, and a file of it."""

import re
from pathlib import Path

import cv2
import numpy as np
import pytest
from playwright.sync_api import Page, expect

from app.source import Source
from tests.app.synthetic import empty_frame, frames
from tests.browser.outlines import go_to, place, put_square, wait_until

AXE = Path(__file__).parent / "vendor" / "axe.min.js"

PAINTED = """(colour) => {
  const canvas = document.querySelector("#overlay-canvas");
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  let count = 0;
  for (let at = 0; at < data.length; at += 4) {
    const isClose = colour.every((value, channel) => Math.abs(data[at + channel] - value) < 12);
    count += isClose && data[at + 3] > 20 && data[at + 3] < 90;
  }
  return count;
}"""
"""How many pixels over the picture are tinted in a colour, as hatched areas are between lines."""

GREEN = [95, 214, 138]


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
    page.keyboard.press("0")
    assert abs(place(page, 70, 91)[0] - place(page, 70, 90)[0]) < 0.6 * scale


def test_levels_and_colours_are_kept_from_frame_to_frame_and_over_reloads(editing) -> None:
    page = editing()
    page.get_by_label("Colours").first.select_option("grey")
    preset = page.get_by_label("Window", exact=True)
    preset.select_option("30")
    expect(page.locator("#floor-value")).to_have_text("−30\u202fdB")
    preset.select_option("auto")
    expect(page.locator("#floor-value")).not_to_have_text("−30\u202fdB")
    page.get_by_label("Floor").fill("-25")
    expect(page.locator("#floor-value")).to_have_text("−25\u202fdB")
    expect(preset).to_have_value("own")
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
    page.reload()
    expect(page.locator("#frame-canvas")).to_have_attribute("data-frame", "1")
    expect(page.locator("#floor-value")).to_have_text("−25\u202fdB")
    expect(page.get_by_label("Colours").first).to_have_value("grey")


def test_hatches_tell_shadow_and_disagreement_apart_and_are_saved(editing, tmp_path) -> None:
    page = editing(6)
    put_square(page, 6, 45.0, 115.0)
    assert page.evaluate(PAINTED, GREEN) == 0
    shadow = shadow_pixels(page)
    assert shadow > 0
    # It follows a drag: the near edge of what is unseen comes down, and less is left behind it.
    page.mouse.move(*place(page, 115, 80))
    page.mouse.down()
    page.mouse.move(*place(page, 135, 80), steps=3)
    wait_until(page, lambda: shadow_pixels(page) < 0.9 * shadow)
    page.keyboard.press("Escape")
    page.mouse.up()
    wait_until(page, lambda: shadow_pixels(page) > 0.9 * shadow)
    page.keyboard.press("r")
    wait_until(page, lambda: page.evaluate(PAINTED, GREEN) > 500)
    legend = page.get_by_role("list", name="What lies over the picture")
    expect(legend).to_contain_text("shadow")
    expect(legend).to_contain_text(re.compile(r"outline only \d+\.\d\u202fm²"))
    with page.expect_download() as saved:
        page.get_by_role("button", name="Save the picture").click()
    assert saved.value.suggested_filename == "radarhull-synthetic-body-frame6.png"
    saved.value.save_as(tmp_path / "frame.png")
    picture = cv2.imread(str(tmp_path / "frame.png"))
    width, height = page.locator("#frame-canvas").evaluate(
        "(canvas) => [canvas.width, canvas.height]"
    )
    assert picture.shape[1] == width
    assert picture.shape[0] > height + 60
    outline = np.abs(picture.astype(int) - [208, 224, 64]).max(axis=2) < 8
    assert outline.sum() > 300
    page.locator("#frame-canvas").focus()
    page.keyboard.down("h")
    wait_until(page, lambda: page.evaluate(PAINTED, GREEN) == 0)
    page.keyboard.up("h")
    wait_until(page, lambda: page.evaluate(PAINTED, GREEN) > 500)
    page.keyboard.press("r")
    page.keyboard.press("d")
    # What is left are the soft edges of lines.
    wait_until(page, lambda: shadow_pixels(page) < 0.2 * shadow)
    expect(legend).to_be_hidden()
    page.keyboard.press("d")
    wait_until(page, lambda: shadow_pixels(page) > 0.9 * shadow)
    page.keyboard.press("k")
    wait_until(page, lambda: shadow_pixels(page) < 0.2 * shadow)


def shadow_pixels(page: Page) -> int:
    """How many pixels are painted thinly, as hatches are, right of the words on the canvas."""
    return page.evaluate(
        """() => {
          const canvas = document.querySelector("#overlay-canvas");
          const plot = JSON.parse(document.querySelector("#frame-canvas").dataset.plot);
          const { data } = canvas.getContext("2d")
            .getImageData(plot.x + 120, plot.y, plot.width - 120, plot.height);
          let count = 0;
          for (let at = 3; at < data.length; at += 4) count += data[at] > 4 && data[at] < 110;
          return count;
        }"""
    )


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
