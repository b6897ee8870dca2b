import base64
import re
from collections.abc import Callable
from itertools import combinations
from pathlib import Path

import cv2
import numpy as np
import pytest
from playwright.sync_api import Browser, Page, expect

from app.camera import FAR_MARGIN
from tests.app.synthetic import SETTINGS, source

COPY = """() => {
  const frames = document.getElementById("viewport").contentDocument;
  const canvases = [...frames.querySelectorAll("canvas")].filter(({ width }) => width > 0);
  if (canvases.length === 0) return null;
  const copy = Object.assign(document.createElement("canvas"), { width: 200, height: 200 });
  const context = copy.getContext("2d");
  context.drawImage(canvases[0], 0, 0, 200, 200);
  return copy.toDataURL("image/png").split(",")[1];
}"""
"""What viser has drawn, on 200 × 200 pixels: much faster than a screenshot of the page."""


def drawn(page: Page) -> np.ndarray:
    """The view in space as (200, 200, 4) BGRA, clear where nothing is drawn."""
    encoded = page.evaluate(COPY)
    if encoded is None:
        return np.zeros((200, 200, 4))
    png = np.frombuffer(base64.b64decode(encoded), np.uint8)
    return cv2.imdecode(png, cv2.IMREAD_UNCHANGED).astype(float)


def until(page: Page, condition: Callable[[np.ndarray], bool]) -> np.ndarray:
    """The view once it fulfils a condition twice in turn."""
    held = False
    for _ in range(200):
        image = drawn(page)
        if held and condition(image):
            return image
        held = condition(image)
        page.wait_for_timeout(50)
    raise AssertionError(f"the view in space did not become so; {image.mean()=}, {image.std()=}")


def is_uniform(image: np.ndarray) -> bool:
    return bool(np.ptp(image.reshape(-1, 4), axis=0).max() == 0)


def share_changed(one: np.ndarray, other: np.ndarray) -> float:
    return float(np.mean(np.abs(one - other).max(axis=-1) > 40))


def light(image: np.ndarray) -> np.ndarray:
    """Where a picture is light and hardly coloured, as the hull is."""
    colours = image[..., :3]
    return (colours.min(axis=-1) > 70) & (np.ptp(colours, axis=-1) < 60)


def press(page: Page, *names: str) -> None:
    for name in names:
        page.locator(f".space [data-layer={name}]").click()


def shown_alone(page: Page) -> dict[str, np.ndarray]:
    """Each layer's picture with all others off, which is how the page is left."""
    press(page, "hull", "picture", "outline", "sights", "grid", "measurements")
    until(page, is_uniform)
    alone = {}
    for name in ("hull", "wireframe", "picture", "outline", "sights", "grid", "uncarved"):
        press(page, name)
        alone[name] = until(page, lambda image: not is_uniform(image))
        press(page, name)
        until(page, is_uniform)
    return alone


def sizes_m(page: Page, seen: np.ndarray) -> np.ndarray:
    """The hull's height and width in an axis view."""
    above = light(seen)
    box = page.locator("#viewport").bounding_box()
    per_pixel_m = FAR_MARGIN * SETTINGS.side_m / min(box["width"], box["height"]) / 200
    spans = [np.ptp(np.flatnonzero(above.any(axis=axis))) + 1 for axis in (1, 0)]
    return np.array([box["height"], box["width"]]) * spans * per_pixel_m


@pytest.fixture
def space(visit):
    """A page whose frames have all arrived and whose view in space shows the hull."""
    visited = visit(source(5), playing=True, viewport=True)
    visited.page.set_viewport_size({"width": 1100, "height": 640})
    expect(visited.page.locator("#status")).to_have_text("All 5 frames received")
    until(visited.page, lambda image: light(image).mean() > 0.02)
    return visited


def test_layers_and_views_are_the_pages_own_and_a_link_carries_them(
    space, browser: Browser
) -> None:
    page = space.page
    alone = shown_alone(page)
    for one, other in combinations(alone.values(), 2):
        assert share_changed(one, other) > 1e-3
    assert light(alone["hull"]).mean() > 0.02
    assert light(alone["wireframe"]).mean() < 0.002

    # From above the hull is as long and as wide as the measured extents.
    press(page, "hull")
    page.locator("[data-view='-z']").click()
    at_home = alone["hull"]
    seen = until(page, lambda i: not is_uniform(i) and share_changed(i, at_home) > 0.01)
    extents = page.locator("#extents tr").all_inner_texts()
    measured = [float(re.findall(r"\d+\.\d+", text)[0]) for text in extents]
    np.testing.assert_allclose(sizes_m(page, seen), measured[:2], rtol=0.06)

    # A link, opened elsewhere, shows the same; where the page cannot copy, it is shown.
    page.keyboard.press("ArrowLeft")
    expect(page.locator("#frame-canvas")).to_have_attribute("data-frame", "4")
    page.evaluate("() => { navigator.clipboard.writeText = () => Promise.reject(); }")
    page.get_by_role("button", name="Link").click()
    text = page.locator("#link-text")
    expect(text).to_have_value(
        re.compile(r"#frame=4&camera=[-\d.,e]+,1&layers=hull,key-points,frame.shadow$")
    )
    link = text.input_value()
    page.keyboard.press("Escape")
    page.keyboard.press("ArrowRight")
    expect(page.locator("#frame-canvas")).to_have_attribute("data-frame", "5")
    permissions = ["clipboard-read", "clipboard-write"]
    context = browser.new_context(viewport=page.viewport_size, permissions=permissions)
    other = context.new_page()
    other.goto(link)
    expect(other.locator("#frame-canvas")).to_have_attribute("data-frame", "4")
    expect(other.locator(".space [data-layer=grid]")).to_have_attribute("aria-pressed", "false")
    # viser lowers its resolution on a busy machine: edges of the same view differ by up to 0.7 %.
    until(other, lambda image: share_changed(image, seen) < 0.01)
    assert "#" not in other.url
    other.get_by_role("button", name="Link").click()
    expect(other.get_by_role("button", name="Copied")).to_be_visible()
    copied = other.evaluate("() => navigator.clipboard.readText()")
    assert copied == link

    # What one page does in space, the other does not see.
    page.locator("[data-view=home]").click()
    press(page, "grid")
    until(page, lambda image: share_changed(image, seen) > 0.01)
    assert share_changed(drawn(other), seen) < 0.01
    assert space.complaints == []
    context.close()


def test_a_picture_is_saved_and_the_keyboard_has_a_chip(space, tmp_path: Path) -> None:
    page = space.page
    with page.expect_download() as download:
        page.get_by_role("button", name="Picture", exact=True).click()
    assert re.fullmatch(
        r"radarhull-synthetic-body-frame5-rev\d+\.png", download.value.suggested_filename
    )
    download.value.save_as(tmp_path / "view.png")
    image = cv2.imread(str(tmp_path / "view.png")).astype(float)
    box = page.locator("#viewport").bounding_box()
    assert image.shape[:2] == (round(box["height"]), round(box["width"]))
    assert light(image).mean() > 0.02
    np.testing.assert_array_equal(image[2, 2], [0x14, 0x0E, 0x0B])

    chip = page.locator("#space-chip")
    expect(chip).to_be_hidden()
    page.locator("#viewport").click(position={"x": 40, "y": 40})
    expect(chip).to_be_visible()
    expect(chip).to_contain_text("3D view has the keyboard")
    page.keyboard.press("Escape")
    expect(chip).to_be_hidden()
    expect(page.locator("#frame-canvas")).to_be_focused()
    assert space.complaints == []


def test_a_link_that_is_not_ours_is_ignored_with_a_sentence(visit) -> None:
    page = visit(source(3), playing=True).page
    expect(page.locator("#status")).to_have_text("All 3 frames received")
    for hash_part, sentence in (
        ("frame=99", "there is no frame 99; this source has 3"),
        ("frame=-1&access_token=abc", "“frame=-1” is not understood"),
        ("camera=1,2,3", "“camera=1,2,3” is not understood"),
        ("camera=0,0,0,0,0,0,0,0,1,30", "must look somewhere"),
        ("layers=hull,clouds,%E0", "is not understood"),
        ("layers=hull,clouds", "there is no layer clouds"),
        ("__proto__=1", "“__proto__=1” is not understood"),
    ):
        page.evaluate("(hash) => { location.hash = hash; }", hash_part)
        expect(page.locator("#banner")).to_contain_text(sentence)
        assert "#" not in page.url
    expect(page.locator("#frame-canvas")).to_have_attribute("data-frame", "3")


def test_without_webgl_the_page_says_so_and_the_frames_go_on(browser: Browser, visit) -> None:
    visited = visit(source(3), playing=True)
    page = browser.new_page(viewport={"width": 1440, "height": 900})
    page.add_init_script(
        """const native = HTMLCanvasElement.prototype.getContext;
        HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
          return kind.startsWith("webgl") ? null : native.call(this, kind, ...more);
        };"""
    )
    asked = []
    page.on("request", lambda request: asked.append(request.url))
    page.goto(visited.address)
    expect(page.locator("#space-empty")).to_contain_text("This browser draws no 3D")
    expect(page.locator("#frame-canvas")).to_have_attribute("data-frame", "3")
    expect(page.locator("#viewport")).to_be_hidden()
    expect(page.get_by_role("button", name="Picture", exact=True)).to_be_disabled()
    expect(page.locator("#extents tr")).to_have_count(3)
    assert not any(re.search(r":\d+/viewport/", url) for url in asked)
    page.close()
