import cv2
import numpy as np
from playwright.sync_api import Page, expect

from tests.app.synthetic import source


def share_of_hull_coloured_pixels(page: Page) -> float:
    """The share of the viewport's pixels that are light and hardly coloured, as the hull is."""
    shot = page.locator("#viewport").screenshot()
    image = cv2.imdecode(np.frombuffer(shot, np.uint8), cv2.IMREAD_COLOR)
    middle = image[image.shape[0] // 4 : -image.shape[0] // 4].astype(int)
    is_light = middle.min(axis=-1) > 70
    return float(np.mean(is_light & (np.ptp(middle, axis=-1) < 60)))


def test_the_hull_appears_in_space_without_asking_anybody_else(visit) -> None:
    visited = visit(source(5), viewport=True)
    page = visited.page
    inside = page.frame_locator("#viewport")
    expect(inside.locator("canvas").first).to_be_visible()
    page.wait_for_timeout(1500)
    before = share_of_hull_coloured_pixels(page)
    assert before < 0.03
    expect(inside.locator("[data-floating-window]")).to_be_hidden()
    expect(inside.get_by_text("Share")).to_have_count(0)

    page.get_by_role("button", name="Play").click()
    expect(page.locator("#status")).to_have_text("All 5 frames received")
    for _ in range(40):
        if share_of_hull_coloured_pixels(page) > before + 0.03:
            break
        page.wait_for_timeout(250)
    assert share_of_hull_coloured_pixels(page) > before + 0.03

    own = (visited.address, visited.address.replace("http", "ws"), "data:", "blob:")
    assert [url for url in visited.requests if not url.startswith(own)] == []
    assert visited.complaints == []
