"""The plots over the passes and the row of frames, in a real browser."""

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Page, expect

from app.source import Source
from tests.app.courses import COURSE
from tests.app.synthetic import frames, source

AXE = Path(__file__).parent / "vendor" / "axe.min.js"

COUNT = 6

INK = """(colours) => [...document.querySelectorAll(".u-wrap > canvas")].map((canvas) => {
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  const counts = colours.map(() => 0);
  for (let at = 0; at < data.length; at += 4) {
    if (data[at + 3] < 200) continue;
    colours.forEach((colour, index) => {
      counts[index] += colour.every((value, channel) => Math.abs(data[at + channel] - value) < 12);
    });
  }
  return counts;
})"""
"""How many pixels of each plot have each colour."""

SKY, ORANGE, PURPLE, YELLOW = [86, 180, 233], [230, 159, 0], [204, 121, 167], [240, 228, 66]


def observed() -> Source:
    """Frames of two passes, evenly over each; the second pass is as long as the first."""

    def come():
        for number, each in enumerate(frames(COUNT)):
            label = f"pass {1 + number // 3}"
            yield replace(each, time_s=16.0 + 32.0 * (number % 3), label=label)

    courses = (COURSE, replace(COURSE, label="pass 2", epoch_utc="2016-03-12T19:27:40Z"))
    return Source(name="two passes", frames=come, expected_frames=COUNT, course=lambda: courses)


@pytest.fixture
def timeline(visit) -> Callable[..., Page]:
    """Return a function that opens the page with every frame received."""

    def open_page(of: Source, count: int) -> Page:
        page = visit(of, playing=True).page
        expect(page.locator("#status")).to_have_text(re.compile(f"All {count} frames received"))
        return page

    return open_page


def expect_shown(page: Page, number: int) -> None:
    expect(page.locator("#frame-canvas")).to_have_attribute("data-frame", str(number))


def place_of(page: Page, number: int) -> tuple[float, float]:
    """Where a frame lies in the upper plot: the passes fill it but for 2 % of both between them."""
    box = page.locator("#course-plots .u-over").first.bounding_box()
    assert box is not None
    index = number - 1
    time_s = 16.0 + 32.0 * (index % 3) + (104.0 if index >= 3 else 0.0)
    return box["x"] + box["width"] * time_s / 204.0, box["y"] + box["height"] / 2


def marked(page: Page) -> float:
    box = page.locator("#course-plots .frame-mark").first.bounding_box()
    assert box is not None
    return box["x"] + box["width"] / 2


def reading(page: Page) -> dict[str, str]:
    rows = page.locator("#course-readout > div")
    return {row.locator("dt").inner_text(): row.locator("dd").inner_text() for row in rows.all()}


def test_plots_are_read_clicked_scrubbed_and_put_away(timeline) -> None:
    page = timeline(observed(), COUNT)
    expect(page.locator("#course-plots .uplot")).to_have_count(2)
    expect(page.locator("#course-plots .frame-mark").first).to_be_visible()
    upper, lower = page.evaluate(INK, [SKY, ORANGE, PURPLE, YELLOW])
    assert min(upper[:2]) > 200
    assert max(upper[2:]) == 0
    assert max(lower[:2]) == 0
    assert min(lower[2:]) > 200
    assert abs(marked(page) - place_of(page, COUNT)[0]) < 2

    page.mouse.move(*place_of(page, 5))
    expect(page.locator("#course-readout .title")).to_have_text(
        re.compile(r"pass 2, (47|48)\.\d.s *frame 5")
    )
    assert reading(page)["Interval"] == "shortened"
    expect(page.locator("#course-note")).to_contain_text("shortened to 0.")
    expect(page.locator("#course-note")).to_contain_text("Judged for 6 m about the origin")
    assert re.fullmatch(r"[\d.]+\u202f°/s", reading(page)["Rotation rate"])
    expect_shown(page, COUNT)

    page.mouse.click(*place_of(page, 2))
    expect_shown(page, 2)
    assert abs(marked(page) - place_of(page, 2)[0]) < 2
    page.mouse.down()
    for number in range(3, 6):
        page.mouse.move(*place_of(page, number))
    page.mouse.up()
    expect_shown(page, 5)
    page.mouse.move(10, 10)
    expect(page.locator("#course-note")).to_be_hidden()
    expect(page.locator("#course-readout .title")).to_contain_text("frame 5")

    page.evaluate(AXE.read_text("utf-8"))
    found = page.evaluate("axe.run(document, { iframes: false })")["violations"]
    assert [each["id"] for each in found if each["impact"] in ("serious", "critical")] == []

    page.get_by_role("button", name="Plots").click()
    expect(page.locator("#course")).to_be_hidden()
    page.reload()
    expect_shown(page, 5)
    expect(page.get_by_role("button", name="Plots")).to_have_attribute("aria-pressed", "false")
    page.get_by_role("button", name="Plots").click()
    expect(page.locator("#course-plots canvas").first).to_be_visible()
    assert page.evaluate("document.documentElement.scrollHeight <= innerHeight")


def picture(page: Page, number: int) -> dict[str, Any]:
    return page.locator(f"#frame-{number} img").evaluate(
        "(image) => ({ width: image.naturalWidth, source: image.getAttribute('src') })"
    )


def test_cells_show_pictures_that_follow_edits_and_what_frames_do_to_the_hull(visit) -> None:
    visited = visit(source(4))
    page = visited.page
    expect(page.locator("#cells > div")).to_have_count(4)
    expect(page.locator("#cells img")).to_have_count(0)
    expect(page.get_by_role("button", name="Plots")).to_be_disabled()
    page.get_by_role("button", name="Play").click()
    expect(page.locator("#status")).to_have_text("All 4 frames received")
    for number in range(1, 5):
        expect(page.locator(f"#frame-{number} img")).to_have_js_property("naturalWidth", 80)
    before = picture(page, 2)["source"]
    corners = [[40.0, 40.0], [40.0, 120.0], [120.0, 120.0], [120.0, 40.0]]
    edit = {"rings": [corners], "claim": "lit side", "base_revision": 0}
    answer = page.request.put(f"{page.url}api/frames/2/silhouette", data=edit)
    assert answer.ok
    expect(page.locator("#frame-2 img")).not_to_have_attribute("src", before)
    expect(page.locator("#frame-2")).to_have_class(re.compile("edited"))
    expect(page.locator("#frame-2 img")).to_have_js_property("complete", True)
    asked = [each for each in visited.requests if "/frames/2/thumbnail" in each]
    assert len(asked) == 2
    page.request.put(f"{page.url}api/frames/2/state", data={"state": "excluded"})
    expect(
        page.get_by_role("option", name=re.compile("Frame 2,.*excluded, edited"))
    ).to_be_visible()
    assert visited.complaints == []


def test_bars_tell_causes_and_suffers_grey_once_the_hull_has_moved_on(timeline) -> None:
    page = timeline(source(4), 4)
    shares = """async (revision) => {
      const { Cells } = await import("./modules/cells.js");
      const state = await (await fetch("/api/state")).json();
      const frames = [[1, 0.5, 0.0], [2, 2.0, 3.0]].map(
        ([number, causes_m3, suffers_m2]) => ({ number, causes_m3, suffers_m2, outline_m2: 9 }));
      state.residuals = { revision: state.hull.revision + revision, frames };
      const host = document.querySelector("#cells").cloneNode();
      document.body.append(host);
      new Cells(host, () => {}).update(state);
      const share = (bar) => bar.style.getPropertyValue("--share");
      const bars = [...host.querySelectorAll(".bars i")].map(share);
      const found = { bars, classes: host.className, title: host.children[1].title };
      host.remove();
      return found;
    }"""
    fresh = page.evaluate(shares, 0)
    assert fresh["bars"] == ["0.25", "0", "1", "1", "0", "0", "0", "0"]
    assert "causes 2.00\u202fm³, suffers 3.00\u202fm²" in fresh["title"]
    assert "old-residuals" not in fresh["classes"]
    assert "old-residuals" in page.evaluate(shares, -1)["classes"]
