from dataclasses import replace

import numpy as np
import pytest
from playwright.sync_api import Page, expect

from app.pictures import colour_index, colour_table
from app.playback import Playback
from app.source import Source
from tests.app.running import running
from tests.app.synthetic import SETTINGS, empty_frame, frames, source

READ_PIXELS = """(canvas) => {
  const { width, height } = canvas;
  const data = canvas.getContext("2d").getImageData(0, 0, width, height).data;
  return { width, height, data: btoa(Array.from(data, (v) => String.fromCharCode(v)).join("")) };
}"""


def frames_received(page: Page) -> int:
    return int(page.locator("#hull-body").get_attribute("data-frames"))


def hull_fact(page: Page, name: str) -> str:
    row = page.locator("#hull-facts > div").filter(has_text=name)
    return row.locator("dd").inner_text()


def step_to(page: Page, number: int) -> None:
    """Step until `number` frames are received and the last is drawn."""
    while frames_received(page) < number:
        before = frames_received(page)
        page.get_by_role("button", name="Step").click()
        expect(page.locator("#hull-body")).to_have_attribute("data-frames", str(before + 1))
    expect(page.locator("#frame-canvas")).to_have_attribute("data-frame", str(number))


def pixels(page: Page) -> np.ndarray:
    """The frame's canvas as (height, width, RGBA)."""
    from base64 import b64decode

    read = page.locator("#frame-canvas").evaluate(READ_PIXELS)
    flat = np.frombuffer(b64decode(read["data"]), dtype=np.uint8)
    return flat.reshape(read["height"], read["width"], 4)


def test_steps_shrink_the_hull_and_pausing_holds_it(visit) -> None:
    page = visit(source(6)).page
    expect(page.locator("#status")).to_have_text("Paused before the first frame")
    step_to(page, 1)
    first = hull_fact(page, "Vertices"), page.locator("#extents").inner_text()
    assert "not bounded" in first[1]
    assert hull_fact(page, "Volume") == "not bounded"
    expect(page.locator("#unobserved")).to_be_visible()
    step_to(page, 2)
    page.wait_for_timeout(700)
    assert frames_received(page) == 2
    page.get_by_role("button", name="Play").click()
    expect(page.locator("#status")).to_have_text("All 6 frames received")
    expect(page.locator("#hull-stamp")).to_have_text("after 6 frames")
    last = hull_fact(page, "Vertices"), page.locator("#extents").inner_text()
    assert last[0] != first[0]
    assert "not bounded" not in last[1]
    expect(page.locator("#unobserved")).to_be_hidden()
    expect(page.get_by_role("button", name="Step")).to_be_disabled()


def test_the_picture_shows_the_levels_that_the_interface_gives(visit) -> None:
    page = visit(source(3)).page
    step_to(page, 2)
    response = page.request.get(f"{page.url}api/frames/2/image")
    shape = int(response.headers["x-rows"]), int(response.headers["x-columns"])
    numbers = np.frombuffer(response.body(), dtype="<u2").reshape(shape)
    level_db = float(response.headers["x-floor-db"]) + numbers * float(
        response.headers["x-step-db"]
    )
    wanted = colour_table()[colour_index(level_db, -40.0)]
    plot = page.locator("#frame-canvas").evaluate("(canvas) => JSON.parse(canvas.dataset.plot)")
    row, column = np.meshgrid(np.arange(40, 120, 3), np.arange(40, 120, 3), indexing="ij")
    y = plot["y"] + (row - plot["row"]) / plot["rows"] * plot["height"]
    x = plot["x"] + (column - plot["column"]) / plot["columns"] * plot["width"]
    drawn = pixels(page)[np.floor(y).astype(int), np.floor(x).astype(int), :3]
    difference = np.abs(drawn.astype(int) - wanted[row, column]).max(axis=-1)
    # The outline and the smoothing of its edges cover a few of the samples.
    assert np.mean(difference <= 1) > 0.9
    assert wanted[row, column].std() > 20


def test_the_cursor_reads_range_cross_range_and_level(visit) -> None:
    page = visit(source(2)).page
    step_to(page, 1)
    canvas = page.locator("#frame-canvas")
    plot = canvas.evaluate("(canvas) => JSON.parse(canvas.dataset.plot)")
    middle = {"x": plot["x"] + plot["width"] / 2, "y": plot["y"] + plot["height"] / 2}
    canvas.hover(position=middle)
    reading = page.locator("#readout").inner_text()
    assert "range 0.0" in reading.replace("−", "")
    assert "dB" in reading
    page.mouse.move(5, 5)
    expect(page.locator("#readout")).to_have_text("Point at the picture to read it.")


def test_principal_lines_are_measured_once_every_extent_is_bounded(visit) -> None:
    page = visit(source(6)).page
    step_to(page, 1)
    expect(page.locator("#lines tr")).to_have_count(0)
    expect(page.get_by_text("Measured once the views bound every extent.")).to_be_visible()
    page.get_by_role("button", name="Play").click()
    expect(page.locator("#hull-stamp")).to_have_text("after 6 frames")
    hull = page.request.get(f"{page.url}api/state").json()["hull"]
    shown = [row.inner_text().split() for row in page.locator("#lines tr").all()]
    assert len(shown) == len(hull["lines"]) == 3
    for words, line in zip(shown, hull["lines"], strict=True):
        numbers = [*line["direction"], line["length_m"]]
        written = " ".join(words).replace("−", "-").replace(",", "").split()
        assert written[0] == line["name"]
        assert [float(word) for word in written[1:5]] == pytest.approx(numbers, abs=0.006)
        assert written[5] == "m"
    expect(page.get_by_text("Measured once the views bound every extent.")).to_be_hidden()
    panel = page.locator(".panel.hull")
    assert panel.evaluate("(panel) => panel.scrollWidth <= panel.clientWidth")
    tabs = page.get_by_role("tablist")
    assert tabs.evaluate("(tabs) => tabs.scrollWidth <= tabs.clientWidth")


def test_a_frame_is_named_with_its_pass_and_its_angles_with_their_frame(visit) -> None:
    def second_pass():
        for each in frames(2):
            yield replace(each, time_s=213.44, label="pass 2")

    page = visit(Source(name="two passes", frames=second_pass)).page
    step_to(page, 1)
    expect(page.locator("#frame-stamp")).to_have_text("1, pass 2, 213.4 s")
    facts = page.locator("#frame-facts")
    expect(facts).to_contain_text("213.4 s into pass 2")
    expect(facts).to_contain_text("° in the target frame")
    expect(facts).not_to_contain_text("azimuth")
    cell = page.locator("#cells").get_by_role("option").first
    assert cell.get_attribute("title") == "Frame 1, 213.4\u202fs into pass 2"


def test_a_frame_without_a_target_is_noted_and_does_not_vote(visit) -> None:
    def with_an_empty_one():
        first, second = frames(2)
        yield from (first, empty_frame(), second)

    page = visit(Source(name="a gap", frames=with_an_empty_one)).page
    step_to(page, 1)
    expect(page.locator("#frame-note")).to_be_hidden()
    step_to(page, 2)
    expect(page.locator("#frame-note")).to_have_text("Frame 2 shows no target and does not vote.")
    expect(page.locator("#space-stamp")).to_have_text("hull of 1 view, frame 2")
    step_to(page, 3)
    expect(page.locator("#frame-note")).to_be_hidden()
    expect(page.locator("#reel-text")).to_have_text("Showing the latest, frame 3; hull of 2 views")


def test_no_hull_is_claimed_before_a_frame_shows_the_target(visit) -> None:
    page = visit(Source(name="nothing", frames=lambda: iter([empty_frame()]))).page
    step_to(page, 1)
    expect(page.locator("#hull-empty")).to_have_text(
        "There is no hull: no frame so far shows the target."
    )


def test_an_earlier_frame_is_shown_while_the_hull_stays(visit) -> None:
    page = visit(source(4), playing=True).page
    expect(page.locator("#frame-canvas")).to_have_attribute("data-frame", "4")
    page.locator("#cells").get_by_role("option").nth(1).click()
    expect(page.locator("#frame-canvas")).to_have_attribute("data-frame", "2")
    expect(page.locator("#space-stamp")).to_have_text("hull of 4 views, frame 2")
    expect(page.locator("#hull-stamp")).to_have_text("after 4 frames")
    page.get_by_role("button", name="Follow latest").click()
    expect(page.locator("#frame-canvas")).to_have_attribute("data-frame", "4")


def test_keys_play_step_and_leaf_through_frames(visit) -> None:
    page = visit(source(4)).page
    expect(page.locator("#status")).to_have_text("Paused before the first frame")
    page.keyboard.press("ArrowRight")
    expect(page.locator("#frame-canvas")).to_have_attribute("data-frame", "1")
    page.keyboard.press("ArrowRight")
    expect(page.locator("#frame-canvas")).to_have_attribute("data-frame", "2")
    page.keyboard.press("ArrowLeft")
    expect(page.locator("#frame-canvas")).to_have_attribute("data-frame", "1")
    page.keyboard.press("ArrowRight")
    expect(page.locator("#frame-canvas")).to_have_attribute("data-frame", "2")
    page.keyboard.press("Space")
    expect(page.locator("#status")).to_have_text("All 4 frames received")


def test_restart_clears_the_page_and_plays_again(visit) -> None:
    page = visit(source(3), playing=True).page
    expect(page.locator("#status")).to_have_text("All 3 frames received")
    expect(page.locator("#hull-body")).to_have_attribute("data-run", "1")
    page.get_by_role("button", name="Restart").click()
    expect(page.locator("#hull-body")).to_have_attribute("data-run", "2")
    expect(page.locator("#status")).to_have_text("All 3 frames received")
    expect(page.locator("#frame-canvas")).to_have_attribute("data-frame", "3")


def test_the_description_is_given_whole_where_the_bar_cuts_it(visit) -> None:
    page = visit(source(1)).page
    expect(page.locator("#source")).to_have_attribute("title", source(1).description)


def test_a_failure_is_one_sentence_on_the_page(visit) -> None:
    def breaks():
        yield from frames(2)
        raise ValueError("The echoes of frame 3 hold NaN; mend the file.")

    page = visit(Source(name="broken pass", frames=breaks), playing=True).page
    expect(page.get_by_role("alert")).to_contain_text(
        "The echoes of frame 3 hold NaN; mend the file."
    )
    expect(page.locator("#status")).to_have_text("Failed after frame 2")


def test_a_lost_link_is_told_and_comes_back(visit) -> None:
    visited = visit(source(2), playing=True)
    page = visited.page
    expect(page.locator("#status")).to_have_text("All 2 frames received")
    visited.stop_server()
    expect(page.get_by_role("alert")).to_contain_text("The connection to the server is lost")
    expect(page.locator("#link")).to_have_text("connection lost")
    port = int(visited.address.rsplit(":", 1)[1])
    with running(source(3), SETTINGS, Playback(speed_hz=None), port=port):
        expect(page.locator("#link")).to_have_text("connected")
        expect(page.get_by_role("alert")).to_be_hidden()
        expect(page.locator("#status")).to_have_text("All 3 frames received")
        expect(page.locator("#frame-canvas")).to_have_attribute("data-frame", "3")


@pytest.mark.parametrize("path", ["api/live", "viewport"])
def test_a_page_from_elsewhere_gets_no_socket(visit, browser, path: str) -> None:
    visited = visit(source(1))
    stranger = browser.new_page()
    outcome = stranger.evaluate(
        """(url) => new Promise((resolve) => {
             const socket = new WebSocket(url, url.endsWith("viewport") ? ["viser-v1.1.1"] : []);
             socket.onopen = () => resolve("opened");
             socket.onerror = () => resolve("refused");
           })""",
        f"{visited.address.replace('http', 'ws')}/{path}",
    )
    stranger.close()
    assert outcome == "refused"
