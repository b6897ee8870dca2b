"""What tests of editing do on the page, and what they ask the server for."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Page, expect

from core.silhouettes.silhouette import clockwise_area_px

Rings = list[list[list[float]]]


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


def put_square(
    page: Page, number: int, low: float = 60.0, high: float = 100.0, *, shown: int | None = None
) -> Rings:
    """Give a frame, the one on show if not told otherwise, a square over the interface."""
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
    if shown in (None, number):
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


def wait_until(page: Page, holds: Callable[[], bool]) -> None:
    for _ in range(100):
        if holds():
            return
        page.wait_for_timeout(100)
    pytest.fail("waited ten seconds in vain")
