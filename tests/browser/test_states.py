"""What the page shows when there is nothing, too little, or something went wrong."""

import re
import time
from pathlib import Path

import pytest
from playwright.sync_api import Page, expect

from app import source_api
from app.playback import Playback
from app.source import NO_SOURCE, Source
from core.formats.pass_file import RecordedPass, write_pass
from tests.app.running import running
from tests.app.synthetic import SETTINGS, frames, source

AXE = Path(__file__).parent / "vendor" / "axe.min.js"

DROP = """([name, text]) => {
  const files = new DataTransfer();
  files.items.add(new File([text], name));
  const send = (kind) => document.body.dispatchEvent(
    new DragEvent(kind, { dataTransfer: files, bubbles: true, cancelable: true }),
  );
  send("dragenter");
  const isOver = !document.querySelector("#drop-zone").hidden;
  send("drop");
  return isOver && document.querySelector("#drop-zone").hidden;
}"""
"""Drop a file on the page; tells whether the page said that it would take it."""


def finished(page: Page, count: int) -> None:
    expect(page.locator("#status")).to_have_text(re.compile(rf"All {count} frames? received"))
    expect(page.locator("#frame-canvas")).to_have_attribute("data-frame", str(count))


def check_accessible(page: Page) -> None:
    # The page's policy lets no foreign script in; evaluating one is the debugger's right.
    page.evaluate(AXE.read_text("utf-8"))
    found = page.evaluate("axe.run(document, { iframes: false })")
    grave = [each for each in found["violations"] if each["impact"] in ("serious", "critical")]
    assert [(each["id"], each["nodes"][0]["html"]) for each in grave] == []


def state(page: Page) -> dict:
    return page.request.get(f"{page.url}api/state").json()


def claim_the_other(page: Page) -> None:
    """Edit the outline on show: claim that it is complete."""
    page.locator("#frame-canvas").focus()
    page.keyboard.press("k")


def failing(count: int) -> Source:
    def broken():
        yield from frames(count)
        raise ValueError("the tape is torn; copy it again.")

    return Source(name="torn pass", frames=broken, expected_frames=5)


@pytest.fixture
def pass_file(tmp_path: Path) -> Path:
    path = tmp_path / "three.h5"
    write_pass(path, RecordedPass(frames=tuple(frames(3))))
    return path


def test_from_nothing_to_the_demo_to_a_file_and_no_edit_lost_unasked(
    visit, pass_file, monkeypatch
) -> None:
    monkeypatch.setattr(source_api, "demo_source", lambda: source(2))
    page = visit(NO_SOURCE, playing=True).page
    expect(page.get_by_role("heading", name="No pass is loaded")).to_be_visible()
    expect(page.locator("main")).not_to_be_visible()
    expect(page.locator("#saved")).to_be_hidden()
    check_accessible(page)
    page.get_by_role("button", name="Load the demo").click()
    finished(page, 2)
    expect(page.locator("#welcome")).to_be_hidden()
    expect(page.locator("#saved")).to_have_text(re.compile(r"^Saved · rev \d+$"))
    expect(page.locator("#banner")).to_contain_text(
        "This pass gives 2 views; a hull takes its form"
    )

    before = state(page)
    assert page.evaluate(DROP, ["notes.h5", "no HDF5"])
    expect(page.locator("#banner")).to_contain_text("notes.h5 is not a whole HDF5 file")
    assert state(page) == before

    claim_the_other(page)
    expect(page.locator("#undo")).to_be_enabled()
    page.locator("#pass-file").set_input_files(pass_file)
    dialog = page.get_by_role("dialog", name="Load another pass?")
    expect(dialog).to_contain_text("discards 1 edited outline. Export them first.")
    expect(dialog.get_by_role("button", name="Cancel")).to_be_focused()
    check_accessible(page)
    page.keyboard.press("Enter")
    expect(dialog).to_have_count(0)
    page.locator("#pass-file").set_input_files(pass_file)
    expect(dialog).to_be_visible()
    page.keyboard.press("Escape")
    expect(dialog).to_have_count(0)
    assert state(page)["source"] == before["source"]
    page.locator("#pass-file").set_input_files(pass_file)
    dialog.get_by_role("button", name="Discard it and load").click()
    finished(page, 3)
    expect(page.locator("#source-name")).to_have_text("three.h5")
    expect(page.locator("#undo")).to_be_disabled()
    expect(page.locator("#banner")).to_be_hidden()


def test_an_upload_is_given_up(visit, pass_file) -> None:
    page = visit(NO_SOURCE).page
    expect(page.locator("#welcome")).to_be_visible()
    page.route("**/api/source?**", lambda _: None)
    page.locator("#pass-file").set_input_files(pass_file)
    expect(page.locator("#loading")).to_contain_text("three.h5")
    page.get_by_role("button", name="Cancel").click()
    expect(page.locator("#loading")).to_be_hidden()
    expect(page.locator("#banner")).to_be_hidden()
    page.unroute("**/api/source?**")
    page.locator("#pass-file").set_input_files(pass_file)
    expect(page.locator("#welcome")).to_be_hidden()


def test_what_came_before_a_failure_stays_usable(visit) -> None:
    page = visit(failing(2), playing=True).page
    banner = page.locator("#banner")
    expect(banner).to_contain_text("The tape is torn; copy it again.")
    expect(banner).to_contain_text("The 2 frames before that can still be edited and measured.")
    expect(page.locator("#status")).to_have_text("Failed after frame 2 of 5")
    check_accessible(page)
    expect(page.locator("#frame-canvas")).to_have_attribute("data-frame", "2")
    claim_the_other(page)
    expect(page.locator("#undo")).to_be_enabled()
    assert state(page)["frames_info"][1]["edited"]
    run = state(page)["run"]
    banner.get_by_role("button", name="Try again").click()
    expect(page.locator("#hull-body")).to_have_attribute("data-run", str(run + 1))
    expect(banner).to_contain_text("The tape is torn")
    banner.get_by_role("button", name="Dismiss").click()
    expect(banner).to_be_hidden()


def test_files_are_downloaded_and_outlines_come_back(visit, tmp_path) -> None:
    page = visit(source(3), playing=True).page
    finished(page, 3)
    button = page.get_by_role("button", name="Export")
    revision = state(page)["hull"]["revision"]
    for name, end in (("GLB", "hull.glb"), ("labelme", "labelme.zip"), ("CSV", "measurements.csv")):
        button.focus()
        page.keyboard.press("Enter")
        if name == "GLB":
            check_accessible(page)
        with page.expect_download() as download:
            page.locator("#export-menu").get_by_role("link", name=name).press("Enter")
        assert download.value.suggested_filename.startswith(f"synthetic-body-rev{revision}-")
        assert download.value.suggested_filename.endswith(end)
        if name == "labelme":
            download.value.save_as(tmp_path / "outlines.zip")
        expect(page.locator("#export-menu")).to_be_hidden()
    claim_the_other(page)
    expect(page.locator("#undo")).to_be_enabled()
    page.locator("#outlines-file").set_input_files(tmp_path / "outlines.zip")
    banner = page.locator("#banner")
    expect(banner).to_contain_text("1 frame took over an outline from outlines.zip")
    expect(banner).to_have_attribute("data-kind", "note")
    expect(page.locator("#claim-text")).to_have_text("Lit side")
    page.locator("#outlines-file").set_input_files(
        {"name": "wrong.json", "mimeType": "application/json", "buffer": b"{}"}
    )
    expect(banner).to_contain_text("neither COCO nor labelme")
    expect(banner).to_have_attribute("data-kind", "bad")


def test_a_single_view_is_called_too_few(visit) -> None:
    page = visit(source(1), playing=True).page
    banner = page.locator("#banner")
    expect(banner).to_contain_text("This pass holds 1 frame; a hull takes its form")
    expect(banner).to_contain_text("Not bounded so far: ")
    assert "NaN" not in page.locator(".panel.hull").inner_text()
    banner.get_by_role("button", name="Dismiss").click()
    expect(banner).to_be_hidden()
    claim_the_other(page)
    expect(page.locator("#undo")).to_be_enabled()
    expect(banner).to_be_hidden()


def test_imaging_is_stopped_and_goes_on(visit) -> None:
    def slow():
        for each in frames(6):
            yield each
            time.sleep(0.3)

    page = visit(Source(name="slow", frames=slow, expected_frames=6)).page
    expect(page.locator("#status")).to_have_text("Paused before the first frame")
    page.get_by_role("button", name="Play").click()
    expect(page.locator("#status")).to_have_text(re.compile("Imaging frame [1-5] of 6"))
    page.get_by_role("button", name="Stop").click()
    expect(page.locator("#status")).to_have_text(re.compile("Paused at frame [1-5] of 6"))
    expect(page.locator("#stop-imaging")).to_be_hidden()
    page.wait_for_timeout(700)  # the frame in work is still received
    received = state(page)["frames"]
    page.wait_for_timeout(700)
    assert state(page)["frames"] == received
    page.get_by_role("button", name="Play").click()
    finished(page, 6)


def test_an_edit_without_a_connection_is_kept_and_marked_until_the_server_is_back(visit) -> None:
    opened = visit(source(3), playing=True)
    page = opened.page
    finished(page, 3)
    claim_the_other(page)
    expect(page.locator("#undo")).to_be_enabled()
    serial = state(page)["serial"]
    opened.stop_server()
    expect(page.locator("#link")).to_have_text("connection lost")
    claim_the_other(page)
    expect(page.locator("#saved-text")).to_have_text("Not saved: no connection")
    expect(page.locator("#banner")).to_contain_text("Your outline of frame 3 is kept on this page")
    expect(page.locator("#claim-text")).to_have_text("Lit side")
    page.get_by_role("button", name="Export").click()
    expect(page.locator("#export-note")).to_have_text("The server does not answer.")
    page.keyboard.press("Escape")
    port = int(opened.address.rpartition(":")[2])
    with running(source(2), SETTINGS, Playback(speed_hz=None), port=port):
        finished(page, 2)
        assert state(page)["serial"] < serial
        expect(page.locator("#banner")).to_contain_text("The server was started anew: the edits of")
        expect(page.locator("#saved-text")).to_have_text("Saved")
        claim_the_other(page)
        expect(page.locator("#undo")).to_be_enabled()
