"""The right pane in a real browser: its tabs, the maps, residuals, and which frames carve."""

import json
from dataclasses import replace
from itertools import pairwise

import pytest
from playwright.sync_api import Locator, Page, Route, expect
from tests.browser.test_editing import AXE, serious_violations

from app import idle_work
from app.source import Source
from tests.app.synthetic import frames, source

COURSE = {
    "passes": [
        {
            "label": "pass 1",
            "time_s": [0, 30, 60],
            "azimuth_deg": [350, 10, 30],
            "elevation_deg": [10, 60, 20],
        }
    ]
}


def tab(page: Page, name: str) -> Locator:
    return page.get_by_role("tab", name=name, exact=True)


def state(page: Page) -> dict:
    return page.evaluate("fetch('/api/state').then((answer) => answer.json())")


def open_page(visit, from_source: Source, count: int, course: dict | None = None) -> Page:
    page = visit(from_source, playing=True).page
    answer = json.dumps(course or {"passes": []})
    page.route("**/api/course", lambda route: route.fulfill(body=answer))
    expect(page.locator("#status")).to_have_text(f"All {count} frames received")
    return page


def places(page: Page) -> dict[int, tuple[float, float]]:
    """Where the sky plot's dots lie, by frame."""
    dots = page.locator("#sky .dot").all()
    centre = ("cx", "cy")
    return {
        int(dot.get_attribute("data-frame")): tuple(float(dot.get_attribute(c)) for c in centre)
        for dot in dots
    }


def test_tabs_fit_and_are_worked_by_keys_and_the_sky_plot_shows_frames(visit) -> None:
    def one_pass():
        for each in frames(4):
            yield replace(each, time_s=2 * each.time_s, label="pass 1")

    page = open_page(visit, Source(name="one pass", frames=one_pass), 4, COURSE)
    tablist = page.get_by_role("tablist")
    names = [each.inner_text() for each in tablist.get_by_role("tab").all()]
    assert names == ["Measurements", "Frame", "Residuals", "Tools"]
    right = tablist.evaluate("(tabs) => tabs.getBoundingClientRect().right")
    assert tab(page, "Tools").evaluate("(tab) => tab.getBoundingClientRect().right") <= right
    tab(page, "Measurements").focus()
    page.keyboard.press("ArrowRight")
    expect(tab(page, "Frame")).to_have_attribute("aria-selected", "true")
    expect(tab(page, "Frame")).to_be_focused()
    expect(page.get_by_role("tabpanel", name="Frame", exact=True)).to_be_visible()
    expect(page.locator("#pane-measurements")).to_be_hidden()
    expect(page.locator("#sky-title")).to_have_text("Sky over the station")
    # At 12 s azimuth is 350° + 12/30 · 20° = 358°, elevation 30°: two thirds of the way out.
    seen = places(page)
    assert seen[2] == pytest.approx((-2.23, -63.96), abs=0.05)
    assert all(one[0] < other[0] for one, other in pairwise(seen[n] for n in (1, 2, 3, 4)))
    page.locator("#sky .dot[data-frame='2']").click()
    expect(page.locator("#frame-canvas")).to_have_attribute("data-frame", "2")
    expect(page.locator("#frame-facts")).to_contain_text("12.0\u202fs into pass 1")
    expect(page.locator("#sky .dot.shown")).to_have_attribute("data-frame", "2")
    expect(page.locator("#coverage .dot.shown")).to_have_attribute("data-frame", "2")
    page.locator("#coverage .dot[data-frame='3']").click(force=True)
    expect(page.locator("#frame-canvas")).to_have_attribute("data-frame", "3")


def test_one_pass_lacks_views_across_its_plane_and_says_so_everywhere(visit) -> None:
    page = open_page(visit, source(5, one_pass=True), 5)
    note = page.locator("#unobserved")
    expect(note).to_contain_text("No view constrains the direction")
    expect(note).to_contain_text("(nearly y cross-track)")
    expect(page.locator("#extents")).to_contain_text("not bounded by these views")
    tab(page, "Frame").click()
    expect(page.locator("#sky-title")).to_have_text("Lines of sight, θ and φ")
    expect(page.locator("#coverage-caption")).to_contain_text(
        "(nearly y cross-track), marked ×: 90°"
    )
    expect(page.locator("#coverage .worst")).to_have_count(1)
    page.evaluate(AXE.read_text("utf-8"))
    assert serious_violations(page) == []
    shade = page.locator("#coverage-shade").evaluate(
        """(canvas) => {
          const at = (x, y) => [...canvas.getContext("2d").getImageData(x, y, 1, 1).data];
          return [at(64, 64), at(112, 64), at(1, 1)];
        }"""
    )
    assert shade[0][:3] == pytest.approx([18, 72, 70], abs=6)
    assert shade[1][0] > 150
    assert shade[2][3] == 0


def test_residuals_point_to_a_spoiled_frame_and_frames_are_held_back(visit, monkeypatch) -> None:
    monkeypatch.setattr(idle_work, "QUIET_S", 0.3)
    page = open_page(visit, source(6), 6)
    tab(page, "Residuals").click()
    expect(page.locator("#residuals-status")).to_be_hidden()
    before = {each["number"]: each["causes_m3"] for each in state(page)["residuals"]["frames"]}
    silhouette = page.request.get(f"{page.url}api/frames/2").json()["silhouette"]
    (ring,) = [silhouette["rings"][0]]
    half = [[row, min(column, 78.0)] for row, column in ring]
    body = {"rings": [half], "claim": "complete", "tool": "test", "base_revision": 0}
    page.request.put(f"{page.url}api/frames/2/silhouette", data=body)
    expect(page.locator("#residuals")).to_have_class("residuals stale")
    expect(page.locator("#residuals-status")).to_contain_text("Computing…")
    expect(page.locator("#residuals-status")).to_be_hidden()
    after = {each["number"]: each["causes_m3"] for each in state(page)["residuals"]["frames"]}
    assert max(after, key=lambda number: after[number] - before[number]) == 2
    first = page.locator("#residuals tbody tr").first
    top = max(after, key=after.get)
    expect(first).to_have_attribute("data-frame", str(top))
    page.evaluate(AXE.read_text("utf-8"))
    assert serious_violations(page) == []
    page.get_by_role("button", name="Suffers, m²").click()
    heads = page.locator("#residuals thead th")
    expect(heads.nth(2)).to_have_attribute("aria-sort", "descending")
    expect(heads.nth(1)).to_have_attribute("aria-sort", "none")
    page.get_by_role("button", name="Show frame 2", exact=True).click()
    expect(page.locator("#frame-canvas")).to_have_attribute("data-frame", "2")
    hull = state(page)["hull"]
    promised = hull["volume_m3"] + after[2]
    expect(page.locator("#without")).to_contain_text(
        f"Without frame 2 the hull would have {promised:.1f}"
    )
    page.locator("#frame-canvas").focus()
    page.keyboard.press("x")
    expect(page.locator("#without")).to_have_text("Frame 2 does not vote.")
    assert state(page)["hull"]["volume_m3"] == pytest.approx(promised, rel=0.02)

    tab(page, "Measurements").click()
    last = page.get_by_label("Last frame that votes")
    last.fill("4")
    last.press("Enter")
    expect(page.locator("#threshold")).to_have_text("inside all 3 views")
    first_field = page.get_by_label("First frame that votes")
    first_field.fill("5")
    first_field.press("Enter")
    expect(page.locator("#carving-complaint")).to_contain_text("not before it; got 5 to 4")
    expect(first_field).to_have_value("1")
    last.fill("")
    last.press("Enter")
    expect(page.locator("#threshold")).to_have_text("inside all 5 views")
    expect(page.locator("#carving-complaint")).to_be_hidden()


def test_an_empty_hull_names_its_frame_and_is_mended_by_excluding_it(visit) -> None:
    page = open_page(visit, source(3), 3)
    corner = [[2.0, 2.0], [2.0, 8.0], [8.0, 8.0], [8.0, 2.0]]
    body = {"rings": [corner], "claim": "complete", "tool": "test", "base_revision": 0}
    page.request.put(f"{page.url}api/frames/3/silhouette", data=body)
    expect(page.locator("#hull-empty")).to_contain_text("The hull is empty")
    page.get_by_role("button", name="Exclude frame 3").click()
    expect(page.locator("#hull-body")).to_be_visible()
    held: list[Route] = []

    def hold(route: Route) -> None:
        held.append(route)

    page.route("**/api/carving", hold)
    page.get_by_label("Tolerated misses").fill("1")
    page.get_by_label("Tolerated misses").press("Enter")
    expect(page.locator("#hull-body")).to_have_class("stale")
    held[0].continue_()
    expect(page.locator("#hull-body")).not_to_have_class("stale")
    expect(page.locator("#threshold")).to_have_text("inside at least 1 of 2 views")
    page.unroute("**/api/carving")
    side = page.get_by_label("Grid side, m")
    side.fill("900")
    side.press("Enter")
    expect(page.locator("#carving-complaint")).to_contain_text("Use a larger spacing")
    first = page.get_by_label("First frame that votes")
    first.fill("9")
    first.press("Enter")
    expect(page.locator("#hull-empty")).to_contain_text("no frame votes. Take frames back in")
