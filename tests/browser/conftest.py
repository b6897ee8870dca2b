"""A real Chromium, and pages that note what they ask for and complain of."""

import re
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, Page, expect, sync_playwright

from app.playback import Playback
from app.source import Source
from tests.app.running import running
from tests.app.synthetic import SETTINGS, source
from tests.chromium import FLAGS, installed_chromium

PATIENCE_MS = 20_000
"""A first frame may wait for numba to compile, on a machine that does other things too."""


@dataclass
class Visit:
    """An open page, with everything it asked for and complained of."""

    address: str
    page: Page
    stop_server: Callable[[], None]
    requests: list[str] = field(default_factory=list)
    complaints: list[str] = field(default_factory=list)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Try a browser test again that failed: a real browser on a busy machine misses a click."""
    for item in items:
        if Path(__file__).parent in item.path.parents:
            item.add_marker(pytest.mark.flaky(reruns=2))


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    expect.set_options(timeout=PATIENCE_MS)
    with sync_playwright() as playwright:
        path = installed_chromium()
        browser = playwright.chromium.launch(executable_path=path, args=list(FLAGS))
        yield browser
        browser.close()


@pytest.fixture
def visit(browser: Browser) -> Iterator[Callable[..., Visit]]:
    """Return a function that serves a source and opens its page.

    Without `viewport` viser's client is left out, which saves most of the time.
    """
    with ExitStack() as stack:

        def open_page(source: Source, *, playing: bool = False, viewport: bool = False) -> Visit:
            playback = Playback(speed_hz=None, is_playing=playing)
            server = stack.enter_context(ExitStack())
            address = server.enter_context(running(source, SETTINGS, playback))
            page = browser.new_page(viewport={"width": 1440, "height": 900})
            stack.callback(page.close)
            page.set_default_timeout(PATIENCE_MS)
            visit = Visit(address=address, page=page, stop_server=server.close)
            page.on("request", lambda request: visit.requests.append(request.url))
            page.on("websocket", lambda socket: visit.requests.append(socket.url))
            page.on("pageerror", lambda error: visit.complaints.append(str(error)))
            page.on(
                "console",
                lambda message: (
                    visit.complaints.append(message.text) if message.type == "error" else None
                ),
            )
            if not viewport:
                page.route(re.compile(r":\d+/viewport/"), lambda route: route.fulfill(body=""))
            page.goto(address)
            return visit

        yield open_page


@pytest.fixture
def editing(visit) -> Callable[..., Page]:
    """Return a function that opens the page with all of so many frames received."""

    def open_page(count: int = 3, **options: Any) -> Page:
        page = visit(source(count), playing=True, **options).page
        expect(page.locator("#status")).to_have_text(re.compile(rf"All {count} frames? received"))
        expect(page.locator("#frame-canvas")).to_have_attribute("data-frame", str(count))
        return page

    return open_page
