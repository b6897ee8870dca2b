import json
import zipfile
from dataclasses import replace

import numpy as np
import pytest

from core.formats import archive
from core.formats.annotation import frame_number
from core.formats.annotations import read_annotations
from core.formats.archive import packed, unpacked
from core.formats.coco import coco_json
from core.formats.labelme import labelme_zip
from core.formats.masks import mask_png, masks_zip
from core.silhouettes.silhouette import Silhouette

MASK = mask_png(np.ones((4, 4), dtype=bool))


@pytest.mark.parametrize(
    ("name", "number"),
    [("frame-000012.png", 12), ("12.json", 12), ("a/b2/mask_7.png", 7), ("pass2\\3.png", 3)],
)
def test_frames_are_told_by_the_last_number_in_the_name(name, number) -> None:
    assert frame_number(name) == number


@pytest.mark.parametrize("name", ["", "frame.png", "2.d/frame.png", "1" * 12 + ".png"])
def test_names_without_a_number_are_refused(name) -> None:
    with pytest.raises(ValueError, match="number of its frame"):
        frame_number(name)


@pytest.mark.parametrize("write", [coco_json, labelme_zip, masks_zip])
def test_the_parts_of_a_frame_come_back_beside_the_target(write) -> None:
    square = np.array([[1.0, 1.0], [1.0, 3.0], [3.0, 3.0], [3.0, 1.0]])
    labels = ["target", "Solar panel/2 %", "knife"]
    outlines = [
        (number, Silhouette(rings=(square + n,), image_shape=(9, 9), claim=claim, component=label))
        for number in (7, 12)
        for n, (label, claim) in enumerate(
            zip(labels, ["lit side", *2 * ["complete"]], strict=True)
        )
    ]
    found = read_annotations(write(outlines), "file")
    known = {(each.number, each.component or "target"): each for each in found}
    assert len(found) == len(known) == 6
    for number, silhouette in outlines:
        each = known[number, silhouette.component]
        again = replace(silhouette, rings=each.rings)
        assert np.array_equal(again.mask(), silhouette.mask())
        assert each.is_mask or each.claim == silhouette.claim


def test_images_beside_labelme_files_are_not_taken_for_masks() -> None:
    shape = {"label": "a", "shape_type": "polygon", "points": [[0, 0], [3, 0], [3, 3]]}
    labelme = {"shapes": [shape], "imageHeight": 4, "imageWidth": 4}
    content = packed([("x/1.json", json.dumps(labelme).encode()), ("x/2.png", MASK)])
    assert [each.number for each in read_annotations(content, "x.zip")] == [1]


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (b"", "not understood"),
        (b"\xff\xfe", "not understood"),
        (b"[" * 100_000, "not understood"),
        (b"{}", "neither COCO nor labelme"),
        (b"PK\x03\x04 and no more", "cannot be read"),
        (packed([]), "no outline"),
        (packed([("1.png", MASK), ("mask-1.png", MASK)]), "two outlines of frame 1"),
        (packed([("notes.txt", b"")]), "no outline"),
    ],
)
def test_other_files_are_refused(content, sentence) -> None:
    with pytest.raises(ValueError, match=sentence):
        read_annotations(content, "file")


def test_an_archive_that_unpacks_to_too_much_is_refused(monkeypatch) -> None:
    monkeypatch.setattr(archive, "MOST_UNPACKED_BYTES", 2**20)
    content = packed([("1.png", bytes(2**19)), ("2.png", bytes(2**19 + 1))])
    assert len(content) < 2**13
    with pytest.raises(ValueError, match="unpacks to more than 1 MiB"):
        list(unpacked(content))


def test_a_damaged_archive_is_refused() -> None:
    content = bytearray(packed([("1.png", np.random.default_rng(1).bytes(5000))]))
    content[400:420] = bytes(20)
    with pytest.raises(ValueError, match="archive"):
        list(unpacked(bytes(content)))
    assert zipfile.is_zipfile(__import__("io").BytesIO(content))
