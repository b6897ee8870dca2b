"""A scripted session of real edits in a real browser: from a pointer let go to the hull drawn.

    python -m tests.browser.edit_session --sizes 128x60 256x60 --edits 200

Each edit is a vertex dragged, a stroke of the brush or one of the eraser, made with the pointer on
the page that a person uses. It ends when the viewport has drawn the hull of that edit: its mesh was
handed to WebGL, drawn, and `finish` had come back. Server, browser and a renderer in software share
the machine's processors.
"""

import argparse
import json
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np
from playwright.sync_api import Browser, Frame, Page, sync_playwright

from app.loop_benchmark import WANTED_HZ, WANTED_MS, satellite_source
from app.playback import Playback
from core.benchmarks.measuring import machine, percentile
from core.benchmarks.workload import GRID_SIDE_M
from core.experiments.results import Figure, Results
from core.reconstruction import ReconstructionSettings
from core.silhouettes.extraction import ExtractionSettings
from tests.app.running import running
from tests.chromium import FLAGS, installed_chromium

WATCH = """(() => {
  const now = () => performance.timeOrigin + performance.now();
  window.ups = [];
  window.draws = [];
  addEventListener("pointerup", () => window.ups.push(now()), true);
  const { prototype } = WebGL2RenderingContext;
  const { bufferData, drawElements } = prototype;
  let isFresh = false;
  prototype.bufferData = function (target, data, ...rest) {
    if (data?.byteLength > 4000) isFresh = true;
    return bufferData.call(this, target, data, ...rest);
  };
  prototype.drawElements = function (mode, count, ...rest) {
    drawElements.call(this, mode, count, ...rest);
    if (!isFresh || count < 300) return;
    isFresh = false;
    this.finish();
    window.draws.push({ faces: count / 3, ms: now() });
  };
})()"""
"""Notes when the pointer was let go, and when each new mesh had been drawn."""

PATIENCE_MS = 60_000

WHAT = "pointer up to hull drawn"

IS_FINISHED = "() => document.querySelector('#status').dataset.status === 'finished'"


@dataclass(frozen=True, slots=True, kw_only=True)
class EditTime:
    """What one edit took.

    Attributes:
        hull_ms: from the pointer let go to the hull drawn; None where the hull stayed as it was.
        drag_s: how long the pointer was down.
        previews: meshes drawn meanwhile.
    """

    hull_ms: float | None
    drag_s: float
    previews: int


def run_session(
    browser: Browser, *, size: int = 128, views: int = 60, edits: int = 200, seed: int = 1
) -> list[Figure]:
    """Edit the test satellite on a grid of `size` voxels a side, and return what was seen."""
    random = np.random.default_rng(seed)
    with _opened(browser, size, views, seed) as (page, space):
        for _ in range(3):  # the first edits compile
            _edit(page, space, random)
        times = [_edit(page, space, random) for _ in range(edits)]
    return _figures(f"{size}³×{views}", (size, views), times)


def _figures(title: str, key: tuple[int, int], times: list[EditTime]) -> list[Figure]:
    hulls = [each.hull_ms for each in times if each.hull_ms is not None]
    drags = [each for each in times if each.drag_s > 0.5]
    rate_hz = sum(each.previews for each in drags) / max(sum(each.drag_s for each in drags), 1e-9)
    return [
        Figure(name=f"{title}: edits made", value=float(len(times)), unit=""),
        Figure(name=f"{title}: edits that changed the hull", value=float(len(hulls)), unit=""),
        Figure(
            name=f"{title}: pointer up to hull drawn, median",
            value=percentile(hulls, 50),
            unit="ms",
        ),
        Figure(
            name=f"{title}: {WHAT}, p95",
            value=percentile(hulls, 95),
            unit="ms",
            wanted=WANTED_MS.get(key),
        ),
        Figure(
            name=f"{title}: previews drawn while dragging",
            value=rate_hz,
            unit="Hz",
            wanted=WANTED_HZ,
        ),
    ]


@contextmanager
def _opened(browser: Browser, size: int, views: int, seed: int) -> Iterator[tuple[Page, Frame]]:
    """Serve the test satellite and open its page, with all frames received."""
    settings = ReconstructionSettings(
        side_m=GRID_SIDE_M,
        spacing_m=GRID_SIDE_M / size,
        extraction=ExtractionSettings(censoring_factor=2.5),
    )
    playback = Playback(speed_hz=None)
    with running(satellite_source(views, seed), settings, playback) as address:
        page = browser.new_page(viewport={"width": 1440, "height": 900}, bypass_csp=True)
        page.set_default_timeout(PATIENCE_MS)
        page.add_init_script(WATCH)
        page.goto(address)
        page.wait_for_function(
            "() => document.querySelector('#status').dataset.status === 'finished'"
        )
        space = next(frame for frame in page.frames if "/viewport" in frame.url)
        space.wait_for_function("() => window.draws.length > 0")
        yield page, space
        page.close()


def _edit(page: Page, space: Frame, random: np.random.Generator) -> EditTime:
    """Make one edit on another frame, and wait until the hull after it is drawn."""
    number = _go_on(page)
    facts = _asked(page, f"/api/frames/{number}")
    revision = facts["silhouette"]["revision"]
    before = _state(page)["hull"]
    kind = str(random.choice(["vertex", "brush", "eraser"], p=[0.7, 0.15, 0.15]))
    page.keyboard.press({"vertex": "v", "brush": "b", "eraser": "e"}[kind])
    start, end = _stroke(facts["silhouette"]["rings"], kind, random)
    space.evaluate("window.draws.length = 0")
    down_ms, up_ms = _drag(page, start, end)
    page.wait_for_function(
        "(past) => { const { revision, saving } = document.querySelector('#frame-canvas').dataset;"
        " return Number(revision) > past && saving === 'false'; }",
        arg=revision,
    )
    hull = _state(page)["hull"]
    drawn = _drawn_ms(
        space, hull["faces"], up_ms, may_stay=hull["volume_m3"] == before["volume_m3"]
    )
    previews = space.evaluate("(up) => window.draws.filter(({ ms }) => ms < up).length", up_ms)
    return EditTime(
        hull_ms=None if drawn is None else drawn - up_ms,
        drag_s=1e-3 * (up_ms - down_ms),
        previews=previews,
    )


def _drawn_ms(space: Frame, faces: int, up_ms: float, *, may_stay: bool) -> float | None:
    """Return when a hull of so many faces was drawn; None where it stayed and was not."""
    if may_stay:
        space.wait_for_timeout(300)
        return None
    found = space.wait_for_function(
        "([faces, up]) => window.draws.find((draw) => draw.faces === faces && draw.ms >= up)?.ms",
        arg=[faces, up_ms],
    )
    return float(found.json_value())


def _stroke(
    rings: list[list[list[float]]], kind: str, random: np.random.Generator
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return where a stroke begins, on the outline, and where it ends, in pixels."""
    ring = rings[int(random.integers(len(rings)))]
    row, column = ring[int(random.integers(len(ring)))]
    reach = 3.0 if kind == "vertex" else 6.0
    by = random.normal(0.0, reach, 2)
    return (row, column), (row + by[0], column + by[1])


def _drag(page: Page, start: tuple[float, float], end: tuple[float, float]) -> tuple[float, float]:
    """Drag the pointer over about a second, and return when it went down and up, in ms."""
    first, last = _place(page, *start), _place(page, *end)
    page.mouse.move(*first)
    page.mouse.down()
    down_ms = page.evaluate("performance.timeOrigin + performance.now()")
    for step in range(1, 31):
        share = step / 30
        page.mouse.move(*(a + share * (b - a) for a, b in zip(first, last, strict=True)))
        page.wait_for_timeout(16)
    page.mouse.up()
    return down_ms, page.evaluate("window.ups.at(-1)")


def _place(page: Page, row: float, column: float) -> tuple[float, float]:
    """Return where a pixel of the frame lies in the window."""
    canvas = page.locator("#frame-canvas")
    box = canvas.bounding_box()
    assert box is not None
    plot = canvas.evaluate("(canvas) => JSON.parse(canvas.dataset.plot)")
    x = plot["x"] + (column - plot["column"]) / plot["columns"] * plot["width"]
    y = plot["y"] + (row - plot["row"]) / plot["rows"] * plot["height"]
    return box["x"] + x, box["y"] + y


def _state(page: Page) -> dict[str, Any]:
    return _asked(page, "/api/state")


def _go_on(page: Page) -> int:
    """Show the frame after the one on show, round and round, and return its number."""
    state = _state(page)
    number = state["shown"] % state["frames"] + 1
    order = {"method": "POST", "body": json.dumps({"frame": number})}
    order["headers"] = {"Content-Type": "application/json"}
    page.evaluate("(order) => fetch('/api/shown', order)", order)
    page.wait_for_function(
        "(number) => document.querySelector('#frame-canvas').dataset.frame === String(number)",
        arg=number,
    )
    return number


def _asked(page: Page, path: str) -> dict[str, Any]:
    facts: dict[str, Any] = page.evaluate("(path) => fetch(path).then((a) => a.json())", path)
    return facts


def main() -> None:
    """Run the session for the sizes asked for and print the figures."""
    options = _options()
    before = machine()
    figures: list[Figure] = []
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=installed_chromium(), args=list(FLAGS))
        for size, views in options.sizes:
            figures += run_session(browser, size=size, views=views, edits=options.edits)
    settings = {"edits": options.edits, **before, "load_average_at_end": machine()["load_average"]}
    results = Results(name="edit session", settings=settings, figures=tuple(figures))
    json.dump(results.to_json(), sys.stdout, indent=2)


def _options() -> argparse.Namespace:
    def size(text: str) -> tuple[int, ...]:
        return tuple(int(part) for part in text.split("x"))

    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--sizes", type=size, nargs="+", default=[(128, 60), (256, 60)])
    parser.add_argument("--edits", type=int, default=200)
    return parser.parse_args()


if __name__ == "__main__":
    main()
