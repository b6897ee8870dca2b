"""Files handed out, and outlines that come back from them."""

import csv
import io
import json
import time
from collections.abc import Iterator

import httpx
import pytest
import trimesh

from app.playback import Playback
from app.source import NO_SOURCE
from core.formats.archive import packed, unpacked
from core.formats.masks import read_mask
from tests.app.running import running
from tests.app.synthetic import SETTINGS, source

SQUARE = [[60.0, 60.0], [60.0, 100.0], [100.0, 100.0], [100.0, 60.0]]


@pytest.fixture(scope="module")
def page() -> Iterator[httpx.Client]:
    with (
        running(source(4), SETTINGS, Playback(speed_hz=None)) as address,
        httpx.Client(base_url=address, trust_env=False) as page,
    ):
        for _ in range(1000):
            if state(page)["status"] == "finished":
                break
            time.sleep(0.02)
        yield page


def state(page: httpx.Client) -> dict:
    return page.get("/api/state").json()


def silhouette(page: httpx.Client, number: int) -> dict:
    return page.get(f"/api/frames/{number}").json()["silhouette"]


def take_in(page: httpx.Client, content: bytes, name: str = "outlines") -> httpx.Response:
    return page.post("/api/silhouettes", params={"name": name}, content=content)


def edit(page: httpx.Client, number: int, rings: list) -> None:
    order = {"rings": rings, "claim": "lit side", "tool": "vertex"}
    revision = silhouette(page, number)["revision"]
    path = f"/api/frames/{number}/silhouette"
    assert page.put(path, json={**order, "base_revision": revision}).status_code == 200


@pytest.mark.parametrize("kind", ["glb", "ply", "stl"])
def test_the_hull_is_given_as_it_stands(page, kind) -> None:
    hull = state(page)["hull"]
    answer = page.get(f"/api/export/hull.{kind}")
    name = f"synthetic-body-rev{hull['revision']}-hull.{kind}"
    assert answer.headers["Content-Disposition"] == f'attachment; filename="{name}"'
    assert answer.headers["Content-Type"].startswith("model/")
    mesh = trimesh.load(io.BytesIO(answer.content), file_type=kind, force="mesh")
    assert len(mesh.faces) == hull["faces"]
    if hull["volume_m3"] is not None:
        assert mesh.volume == pytest.approx(hull["volume_m3"], rel=1e-4)


def test_measurements_carry_the_hull_that_they_belong_to(page) -> None:
    hull = state(page)["hull"]
    facts = page.get("/api/export/measurements.json").json()
    assert facts["hull"] == hull
    answer = page.get("/api/export/measurements.csv")
    assert f"-rev{hull['revision']}-measurements.csv" in answer.headers["Content-Disposition"]
    assert answer.text == page.get("/api/measurements.csv").text
    rows = [row for row in csv.DictReader(io.StringIO(answer.text)) if row["value"]]
    assert {row["revision"] for row in rows} == {str(hull["revision"])}
    assert {row["threshold"] for row in rows} == {str(hull["threshold"])}
    extents = [row for row in rows if row["kind"] == "hull extent"]
    told = [extent for extent in hull["extents"] if extent["value_m"] is not None]
    for row, extent in zip(extents, told, strict=True):
        assert row["name"] == extent["name"]
        assert float(row["value"]) == extent["value_m"]
        assert [float(row[axis]) for axis in "xyz"] == extent["direction"]


@pytest.mark.parametrize("kind", ["coco.json", "labelme.zip", "masks.zip"])
def test_outlines_come_back_from_their_own_file_as_no_edit(page, kind) -> None:
    before = state(page)
    exported = page.get(f"/api/export/silhouettes-{kind}")
    answer = take_in(page, exported.content)
    assert answer.json() == {"changed": [], "unchanged": [1, 2, 3, 4]}
    after = state(page)
    assert [info["revision"] for info in after["frames_info"]] == [
        info["revision"] for info in before["frames_info"]
    ]


@pytest.mark.parametrize("kind", ["coco.json", "labelme.zip", "masks.zip"])
def test_outlines_of_a_file_are_edits_that_can_be_undone(page, kind) -> None:
    whole = silhouette(page, 2)
    edit(page, 2, [SQUARE])
    exported = page.get(f"/api/export/silhouettes-{kind}").content
    revision = silhouette(page, 2)["revision"]
    page.post("/api/frames/2/undo", json={"base_revision": revision})
    hull = state(page)["hull"]
    assert take_in(page, exported, "mine.zip").json() == {"changed": [2], "unchanged": [1, 3, 4]}
    again = silhouette(page, 2)
    # The square's corners lie on pixel centres, which a mask counts by half.
    assert again["area_px"] == pytest.approx(1600, abs=90 if kind == "masks.zip" else 1e-6)
    assert again["provenance"] == "imported from mine.zip"
    assert state(page)["hull"]["revision"] > hull["revision"]
    page.post("/api/frames/2/undo", json={"base_revision": again["revision"]})
    assert silhouette(page, 2)["rings"] == whole["rings"]
    assert state(page)["hull"]["vertices"] == hull["vertices"]


def test_a_file_is_taken_in_whole_or_not_at_all(page) -> None:
    edit(page, 1, [SQUARE])
    masks = dict(unpacked(page.get("/api/export/silhouettes-masks.zip").content))
    page.post("/api/frames/1/undo", json={"base_revision": silhouette(page, 1)["revision"]})
    before = [info["revision"] for info in state(page)["frames_info"]]
    first = masks["frame-000001.png"]
    assert read_mask(first, "1.png").image_shape == (160, 160)
    unknown = packed([("1.png", first), ("9.png", first)])
    assert "There is no frame 9" in take_in(page, unknown).json()["detail"]
    shape = {"label": "target", "shape_type": "polygon", "points": [[0, 0], [9, 0], [9, 9]]}
    other = {"shapes": [shape], "imageHeight": 100, "imageWidth": 160}
    small = take_in(page, packed([("1.json", json.dumps(other).encode())]), "small.zip")
    assert "160 × 160 pixels, its image in small.zip 100 × 160" in small.json()["detail"]
    thin = {**other, "imageHeight": 160, "shapes": [{**shape, "points": [[1, 1], [5, 5], [9, 9]]}]}
    whole = {**other, "imageHeight": 160}
    mixed = [("1.json", json.dumps(whole).encode()), ("2.json", json.dumps(thin).encode())]
    assert "Frame 2 in mixed.zip" in take_in(page, packed(mixed), "mixed.zip").json()["detail"]
    assert take_in(page, b"nothing").status_code == 422
    assert [info["revision"] for info in state(page)["frames_info"]] == before


def test_what_does_not_exist_is_refused_with_a_sentence(page) -> None:
    assert "measurements.csv" in page.get("/api/export/hull.obj").json()["detail"]
    with (
        running(NO_SOURCE, SETTINGS, Playback(speed_hz=None)) as address,
        httpx.Client(base_url=address, trust_env=False) as empty,
    ):
        for what in ("hull.glb", "silhouettes-coco.json", "measurements.csv"):
            answer = empty.get(f"/api/export/{what}")
            assert answer.status_code == 409
            assert "yet; wait for" in answer.json()["detail"]
        assert (
            take_in(empty, page.get("/api/export/silhouettes-coco.json").content).status_code == 422
        )


def test_a_preview_is_not_exported(page) -> None:
    order = {"rings": [SQUARE], "claim": "lit side", "tool": "vertex"}
    revision = silhouette(page, 3)["revision"]
    page.put("/api/frames/3/preview", json={**order, "base_revision": revision})
    assert page.get("/api/export/hull.glb").status_code == 409
    assert "not kept yet" in page.get("/api/export/measurements.csv").json()["detail"]
    assert page.get("/api/export/silhouettes-coco.json").status_code == 200
    page.delete("/api/frames/3/preview")
    assert page.get("/api/export/hull.glb").status_code == 200
