"""Measuring by clicks in the real view in space."""

import re
from typing import Any

import httpx
import numpy as np
import pytest
from playwright.sync_api import Page, expect

from app.camera import FAR_FIELD_OF_VIEW_RAD
from tests.app.synthetic import source
from tests.browser.test_space import drawn, light, share_changed, until


class Space:
    """A page whose view looks down on the hull from far away, and its server's state."""

    def __init__(self, page: Page, address: str) -> None:
        self.page = page
        self.client = httpx.Client(base_url=address, trust_env=False)
        self.box = page.locator("#viewport").bounding_box()
        source = page.locator("#viewport").get_attribute("src")
        self.name = re.search(r"/viewport/([\w-]+)/", source)[1]
        self.camera_m = self.look_down()

    def look_down(self) -> np.ndarray:
        """Look from above, and return where the camera then stands."""
        answer = self.client.put(f"/api/viewport/{self.name}/view", json={"view": "-z"})
        return np.array(answer.json()["position"])

    def at(self, x_m: float, y_m: float, z_m: float = 0.0) -> tuple[float, float]:
        """Where a point of the target frame lies in the window; x is up, y to the right."""
        distance_m = np.linalg.norm(self.camera_m) + z_m
        per_m = self.box["height"] / (2 * distance_m * np.tan(FAR_FIELD_OF_VIEW_RAD / 2))
        return (
            self.box["x"] + self.box["width"] / 2 + y_m * per_m,
            self.box["y"] + self.box["height"] / 2 - x_m * per_m,
        )

    def click(self, x_m: float, y_m: float) -> None:
        self.page.mouse.click(*self.at(x_m, y_m))

    def state(self) -> dict[str, Any]:
        return self.client.get("/api/state").json()

    def picked(self, count: int) -> None:
        expect(self.page.locator("#pick-bar")).to_have_attribute("data-picked", str(count))


@pytest.fixture
def space(visit):
    visited = visit(source(6), playing=True, viewport=True)
    page = visited.page
    page.set_viewport_size({"width": 1300, "height": 800})
    expect(page.locator("#status")).to_have_text("All 6 frames received")
    until(page, lambda image: light(image).mean() > 0.02)
    space = Space(page, visited.address)
    # The camera has moved once the picture has: from above the fuselage is at the middle.
    until(page, lambda image: light(image)[95:105, 95:105].mean() > 0.9)
    yield space
    space.client.close()
    # viser's own, each time that a node is dragged.
    passive = "Unable to preventDefault inside passive event listener invocation."
    assert [text for text in visited.complaints if text != passive] == []


def test_two_clicks_measure_a_span_whose_end_can_then_be_dragged(space: Space) -> None:
    page, bar = space.page, space.page.locator("#pick-bar")
    page.keyboard.press("m")
    expect(page.locator("#pick-hint")).to_have_text("Length: click the first end – Esc cancels")
    # The view in space is told over a link of its own that clicks are wanted.
    for _ in range(40):
        space.click(11.0, 11.0)
        page.wait_for_timeout(250)
        if page.locator("#pick-complaint").is_visible():
            break
    expect(page.locator("#pick-complaint")).to_have_text(
        "There is no hull under the pointer; click on its surface."
    )
    space.click(2.2, -6.5)
    space.picked(1)
    expect(page.locator("#pick-complaint")).to_be_hidden()

    space.click(2.2, -6.5)
    expect(page.locator("#pick-complaint")).to_contain_text("That is the same point again")

    # A drag turns the view and picks nothing.
    before = drawn(page)
    page.mouse.move(*space.at(-9.0, -9.0))
    page.mouse.down()
    page.mouse.move(*space.at(-9.0, 0.0), steps=4)
    page.mouse.up()
    until(page, lambda image: share_changed(image, before) > 0.05)
    # The view swings on for a moment after a drag, whatever is ordered meanwhile.
    for _ in range(20):
        page.wait_for_timeout(400)
        if share_changed(drawn(page), before) < 0.01:
            break
        space.look_down()
    space.picked(1)
    space.click(2.2, 6.5)
    space.picked(0)
    (item,) = measured(space, 1)
    assert item["name"] == "length 1"
    assert item["value"] == pytest.approx(13.0, abs=0.5)

    page.keyboard.press("Escape")
    expect(bar).to_be_hidden()
    assert space.state()["picking"] == {}
    space.click(2.2, 0.0)
    assert len(space.state()["measurements"]["items"]) == 1

    # An end is dragged along the hull.
    near_m = -0.6
    page.mouse.move(*space.at(2.2, 6.5, near_m))
    page.wait_for_timeout(300)
    page.mouse.down()
    page.mouse.move(*space.at(2.2, 5.0, near_m), steps=8)
    page.mouse.move(*space.at(2.2, 3.0, near_m), steps=8)
    page.wait_for_timeout(200)
    page.mouse.up()
    for _ in range(100):
        (item,) = measured(space, 1)
        if item["value"] < 11.0:
            break
        page.wait_for_timeout(50)
    assert item["value"] == pytest.approx(9.5, abs=0.5)
    assert space.state()["measurements"]["can_undo"]


def measured(space: Space, count: int) -> list[dict[str, Any]]:
    """The rows of the table once all are measured."""
    for _ in range(200):
        items = space.state()["measurements"]["items"]
        if len(items) == count and all(item["value"] is not None for item in items):
            return items
        space.page.wait_for_timeout(50)
    raise AssertionError(f"there are not {count} values: {items}")


def test_the_menu_chooses_what_is_measured_and_keys_what_a_click_snaps_to(space: Space) -> None:
    page = space.page
    page.get_by_role("button", name="Measure", exact=True).click()
    page.get_by_role("button", name="Polyline").click()
    expect(page.locator("#pick-hint")).to_contain_text("Polyline: click the first point")
    page.get_by_role("button", name="Extreme").click()
    expect(page.locator("#pick-hint")).to_contain_text("farthest out within 1.6 m")
    page.wait_for_timeout(500)
    # viser sends at most one click in 20 ms.
    for count, place in enumerate(((2.2, -6.5), (0.0, 0.0), (2.2, 6.5)), 1):
        space.click(*place)
        space.picked(count)
    page.keyboard.press("Backspace")
    space.picked(2)
    page.keyboard.press("Enter")
    space.picked(0)
    assert [item["name"] for item in space.state()["measurements"]["items"]] == ["polyline 1"]
