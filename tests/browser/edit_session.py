"""A scripted session of real edits in a real browser: from a pointer let go to the hull drawn.

    python -m tests.browser.edit_session --sizes 128x60 256x60 --edits 200
    python -m tests.browser.edit_session --demo --edits 200

The frames are drawn from outlines of a test satellite, or with `--demo` those of the built-in demo:
60 images of simulated echoes, 20 of each of its three passes, carved on 128³ voxels.

Each edit is a vertex dragged, a stroke of the brush or one of the eraser, made with the pointer on
the page that a person uses. It ends when the viewport has drawn the hull of that edit: its mesh was
handed to WebGL, drawn, and a pixel read back. Server, browser and a renderer in software share
the machine's processors; a table on stderr tells apart where the time goes.
"""

import argparse
import json
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from playwright.sync_api import Browser, Frame, Page, sync_playwright

from app.loop_benchmark import SIZES, WANTED_HZ, WANTED_MS, satellite_source
from app.playback import Playback
from app.source import Source
from app.sources import demo_source
from core.benchmarks.measuring import machine, percentile
from core.benchmarks.workload import GRID_SIDE_M
from core.experiments.results import Figure, Results
from core.reconstruction import ReconstructionSettings
from core.silhouettes.extraction import ExtractionSettings
from tests.app.running import running
from tests.browser.edit_stages import WATCH, WORDS, Stages, forget, stages, table
from tests.chromium import FLAGS, installed_chromium

PATIENCE_MS = 60_000

WHAT = "pointer up to hull drawn"

IS_FINISHED = "() => document.querySelector('#status').dataset.status === 'finished'"


@dataclass(frozen=True, slots=True, kw_only=True)
class EditTime:
    """What one edit took.

    Attributes:
        stages: until the hull was drawn; None where it stayed as it was.
        drag_s: how long the pointer was down.
        previews: meshes drawn meanwhile.
        late_previews: meshes drawn after that, before the hull's own.
    """

    stages: Stages | None
    drag_s: float
    previews: int
    late_previews: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Workload:
    """What is edited.

    Attributes:
        title: of its figures.
        source: of the frames.
        settings: by which they are carved.
        size: (voxels a side, frames).
        reach_px: standard deviation by which a vertex is moved; a stroke's is twice that.
        trims: whether strokes go inward from the side that the radar sees, with neighbours pulled.
    """

    title: str
    source: Source
    settings: ReconstructionSettings
    size: tuple[int, int]
    reach_px: float = 3.0
    trims: bool = False


def satellite(size: int = 128, views: int = 60, seed: int = 1) -> Workload:
    """Return frames drawn from outlines of the test satellite."""
    settings = ReconstructionSettings(
        side_m=GRID_SIDE_M,
        spacing_m=GRID_SIDE_M / size,
        extraction=ExtractionSettings(censoring_factor=2.5),
    )
    return Workload(
        title=f"{size}³×{views}",
        source=satellite_source(views, seed),
        settings=settings,
        size=(size, views),
    )


def demo(size: int = 128) -> Workload:
    """Return the built-in demo's frames, in its own grid's extent.

    Their outlines lie outside the hull of them all, but for a few places, and behind the side that
    the radar sees the hull does not care: strokes elsewhere would seldom change anything.
    """
    side_m = ReconstructionSettings().side_m
    source = demo_source()
    views = source.expected_frames
    assert views is not None
    settings = ReconstructionSettings(side_m=side_m, spacing_m=side_m / size)
    return Workload(
        title=f"demo {size}³×{views}",
        source=source,
        settings=settings,
        size=(size, views),
        reach_px=8.0,
        trims=True,
    )


def run_session(
    browser: Browser,
    workload: Workload,
    *,
    edits: int = 200,
    seed: int = 1,
    tell: Callable[[str], None] = lambda _: None,
) -> list[Figure]:
    """Edit a workload's frames, and return what was seen; `tell` is told where the time went."""
    random = np.random.default_rng(seed)
    with _opened(browser, workload) as (page, space):
        for _ in range(3):  # the first edits compile
            _edit(page, space, random, workload)
        times = [_edit(page, space, random, workload) for _ in range(edits)]
    if seen := [each.stages for each in times if each.stages is not None]:
        tell(f"{workload.title}, {len(seen)} edits that changed the hull\n{table(seen)}")
    return _figures(workload, times)


def _figures(workload: Workload, times: list[EditTime]) -> list[Figure]:
    title = workload.title
    changes = [each.stages for each in times if each.stages is not None]
    hulls = [each.drawn_ms for each in changes]
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
            wanted=WANTED_MS.get(workload.size),
        ),
        *(
            Figure(
                name=f"{title}: {WORDS[each.name]}, {name}",
                value=percentile([getattr(stages, each.name) for stages in changes], share),
                unit="ms",
            )
            for each in fields(Stages)
            if each.name != "drawn_ms"
            for name, share in (("median", 50), ("p95", 95))
        ),
        Figure(
            name=f"{title}: previews drawn while dragging",
            value=rate_hz,
            unit="Hz",
            wanted=WANTED_HZ,
        ),
        Figure(
            name=f"{title}: previews drawn after the pointer was let go, of each edit",
            value=sum(each.late_previews for each in times) / len(times),
            unit="",
        ),
    ]


@contextmanager
def _opened(browser: Browser, workload: Workload) -> Iterator[tuple[Page, Frame]]:
    """Serve a workload and open its page, with all frames received."""
    playback = Playback(speed_hz=None)
    with running(workload.source, workload.settings, playback) as address:
        page = browser.new_page(viewport={"width": 1440, "height": 900}, bypass_csp=True)
        page.set_default_timeout(PATIENCE_MS)
        page.add_init_script(WATCH)
        page.goto(address)
        page.wait_for_function(IS_FINISHED)
        space = next(frame for frame in page.frames if "/viewport" in frame.url)
        space.wait_for_function("() => window.draws.length > 0")
        yield page, space
        page.close()


def _edit(page: Page, space: Frame, random: np.random.Generator, workload: Workload) -> EditTime:
    """Make one edit on another frame, and wait until the hull after it is drawn."""
    number = _go_on(page)
    facts = _asked(page, f"/api/frames/{number}")
    revision = facts["silhouette"]["revision"]
    before = _state(page)["hull"]
    kind = str(random.choice(["vertex", "brush", "eraser"], p=[0.7, 0.15, 0.15]))
    page.keyboard.press({"vertex": "v", "brush": "b", "eraser": "e"}[kind])
    reach_px = workload.reach_px * (1 if kind == "vertex" else 2)
    start, end = _stroke(facts["silhouette"]["rings"], reach_px, random, workload.trims)
    forget(space)
    with _held(page, "Shift" if workload.trims and kind == "vertex" else None):
        down_ms, up_ms = _drag(page, start, end)
    page.wait_for_function(
        "(past) => { const { revision, saving } = document.querySelector('#frame-canvas').dataset;"
        " return Number(revision) > past && saving === 'false'; }",
        arg=revision,
    )
    state = _state(page)
    hull, published_ms = state["hull"], state["latency_ms"]["last"]
    if hull["volume_m3"] == before["volume_m3"]:
        space.wait_for_timeout(300)
        seen = None
    else:
        seen = stages(page, space, up_ms, hull, published_ms)
    drawn_ms = space.evaluate("window.draws.map(({ ms }) => ms)")
    last_ms = up_ms if seen is None else up_ms + seen.drawn_ms
    return EditTime(
        stages=seen,
        drag_s=1e-3 * (up_ms - down_ms),
        previews=sum(ms < up_ms for ms in drawn_ms),
        late_previews=sum(up_ms <= ms < last_ms for ms in drawn_ms),
    )


def _stroke(
    rings: list[list[list[float]]], reach_px: float, random: np.random.Generator, trims: bool
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return where a stroke begins, on the outline, and where it ends, in pixels."""
    ring = np.array(rings[int(random.integers(len(rings)))])
    if trims:
        ring = np.array(max(rings, key=len))
        near = ring[:, 0] < np.median(ring[:, 0])
        inward = ring.mean(axis=0) - ring
        ring, inward = ring[near], inward[near]
    place = int(random.integers(len(ring)))
    by = random.normal(0.0, reach_px, 2)
    if trims:
        by = np.hypot(*by) * inward[place] / np.hypot(*inward[place])
    return (ring[place][0], ring[place][1]), (ring[place][0] + by[0], ring[place][1] + by[1])


@contextmanager
def _held(page: Page, key: str | None) -> Iterator[None]:
    if key is not None:
        page.keyboard.down(key)
    yield
    if key is not None:
        page.keyboard.up(key)


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
    number: int = state["shown"] % state["frames"] + 1
    order = {
        "method": "POST",
        "body": json.dumps({"frame": number}),
        "headers": {"Content-Type": "application/json"},
    }
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
        for workload in _workloads(options):
            figures += run_session(browser, workload, edits=options.edits, tell=_tell)
    settings = {"edits": options.edits, **before, "load_average_at_end": machine()["load_average"]}
    results = Results(name="edit session", settings=settings, figures=tuple(figures))
    json.dump(results.to_json(), sys.stdout, indent=2)


def _workloads(options: argparse.Namespace) -> list[Workload]:
    drawn = [satellite(size, views) for size, views in options.sizes or ()]
    if options.demo:
        return [*drawn, demo()]
    return drawn or [satellite(size, views) for size, views in SIZES]


def _tell(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


def _options() -> argparse.Namespace:
    def size(text: str) -> tuple[int, ...]:
        return tuple(int(part) for part in text.split("x"))

    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--sizes", type=size, nargs="+", help="of the test satellite's sessions")
    parser.add_argument("--demo", action="store_true", help="edit the built-in demo's frames")
    parser.add_argument("--edits", type=int, default=200)
    return parser.parse_args()


if __name__ == "__main__":
    main()
