"""The built-in demo's simulated echoes, corrected by hand in a real browser."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Browser, Frame, Page, expect

from app.playback import Playback
from app.sources import demo_source
from core.reconstruction import ReconstructionSettings
from tests.app.running import running
from tests.browser.edit_stages import WATCH, forget
from tests.browser.outlines import frame_facts, go_to, info, origin, place, rings_of

ENOUGH_FRAMES = 21
"""Of two passes; the rest of the demo is not waited for."""

PATIENCE_MS = 60_000

Pixel = tuple[float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Workstation:
    """A page on the demo, paused, with the viewport's frame in it."""

    page: Page
    space: Frame

    def hull(self) -> dict[str, Any]:
        """What the server tells of the hull."""
        return self.page.request.get(f"{origin(self.page)}/api/state").json()["hull"]

    def wait_until_drawn(self, faces: int) -> None:
        """Wait until WebGL has drawn a mesh of so many faces since it was last forgotten."""
        self.space.wait_for_function(
            "(faces) => window.draws.some((draw) => draw.faces === faces)", arg=faces
        )


@pytest.fixture(scope="module")
def demo(browser: Browser) -> Iterator[Workstation]:
    settings = ReconstructionSettings(spacing_m=0.3)
    with running(demo_source(), settings, Playback(speed_hz=None)) as address:
        page = browser.new_page(viewport={"width": 1440, "height": 900}, bypass_csp=True)
        page.set_default_timeout(PATIENCE_MS)
        page.add_init_script(WATCH)
        page.goto(address)
        page.wait_for_function(
            "(enough) => Number(document.querySelector('#hull-body').dataset.frames) >= enough",
            arg=ENOUGH_FRAMES,
        )
        page.get_by_role("button", name="Pause").click()
        expect(page.locator("#status")).to_have_attribute("data-status", "paused")
        space = next(frame for frame in page.frames if "/viewport" in frame.url)
        space.wait_for_function("() => window.draws.length > 0")
        yield Workstation(page=page, space=space)
        page.close()


def notch(rings: list[list[list[float]]]) -> tuple[Pixel, Pixel]:
    """Return a vertex of the side that the radar sees, and where to drag it for a deep notch."""
    ring = np.array(max(rings, key=len))
    row, column = ring[np.argmin(ring[:, 0])].tolist()
    return (row, column), (row + 40.0, column)


def test_an_outline_of_the_demo_is_notched_and_the_hull_follows_it_and_its_undo(demo) -> None:
    page, number = demo.page, 8
    go_to(page, number)
    before, rings = demo.hull(), rings_of(page, number)
    revision = frame_facts(page, number)["silhouette"]["revision"]
    start, end = notch(rings)
    page.locator("#frame-canvas").focus()
    for _ in range(5):
        page.keyboard.press("]")
    forget(demo.space)
    page.keyboard.down("Shift")
    page.mouse.move(*place(page, *start))
    page.mouse.down()
    page.mouse.move(*place(page, *end), steps=6)
    expect(page.locator("#preview-chip")).to_be_visible()
    # What is tried out is not saved, and raises no revision.
    expect(page.locator("#revision")).to_have_text(f"rev {before['revision']}")
    page.mouse.up()
    page.keyboard.up("Shift")
    expect(page.locator("#frame-canvas")).to_have_attribute("data-revision", str(revision + 1))
    expect(page.locator("#preview-chip")).to_be_hidden()
    cut = demo.hull()
    assert cut["revision"] == before["revision"] + 1
    expect(page.locator("#revision")).to_have_text(f"rev {cut['revision']}")
    demo.wait_until_drawn(cut["faces"])
    assert cut["volume_m3"] < before["volume_m3"] - 0.05
    assert cut["frames"] == before["frames"]
    page.keyboard.press("Control+z")
    expect(page.locator("#frame-canvas")).to_have_attribute("data-revision", str(revision + 2))
    demo.wait_until_drawn(before["faces"])
    assert demo.hull()["volume_m3"] == before["volume_m3"]
    assert rings_of(page, number) == rings


def test_a_frame_of_the_demo_is_left_out_and_taken_back(demo) -> None:
    page, number = demo.page, 5
    go_to(page, number)
    before = demo.hull()
    page.locator("#frame-canvas").focus()
    page.keyboard.press("x")
    expect(page.locator(f"#frame-{number}")).to_have_attribute("data-state", "excluded")
    expect(page.locator("#space-stamp")).to_contain_text(f"hull of {before['views'] - 1} views")
    assert info(page, number)["votes"] is False
    assert demo.hull()["volume_m3"] >= before["volume_m3"]
    page.keyboard.press("x")
    expect(page.locator("#space-stamp")).to_contain_text(f"hull of {before['views']} views")
    assert demo.hull()["volume_m3"] == before["volume_m3"]
