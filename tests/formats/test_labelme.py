import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.formats.annotations import read_annotations
from core.formats.archive import unpacked
from core.formats.labelme import labelme_zip, read_labelme
from core.silhouettes.silhouette import Silhouette
from tests.formats.synthetic_outlines import SHAPE, assert_same_rings, silhouettes

SQUARE = np.array([[10.0, 20.0], [10.0, 29.0], [19.0, 29.0], [19.0, 20.0]])


def parsed(silhouette: Silhouette) -> dict:
    ((_, content),) = unpacked(labelme_zip([(3, silhouette)]))
    return json.loads(content)


@given(st.lists(silhouettes(), min_size=1, max_size=3))
def test_outlines_come_back_ring_by_ring(each) -> None:
    found = read_annotations(labelme_zip(enumerate(each, start=1)), "file.zip")
    assert [annotation.number for annotation in found] == list(range(1, len(each) + 1))
    for annotation, silhouette in zip(found, each, strict=True):
        assert_same_rings(annotation.rings, silhouette)
        assert annotation.claim == silhouette.claim
        assert annotation.image_shape == SHAPE


def test_a_file_reads_as_labelme_has_it() -> None:
    hole = np.array([[13.0, 23.0], [15.0, 23.0], [15.0, 25.0]])
    content = parsed(Silhouette(rings=(SQUARE, hole), image_shape=SHAPE, claim="lit side"))
    assert content["imagePath"] == "frame-000003.png"
    assert (content["imageHeight"], content["imageWidth"]) == SHAPE
    assert [shape["shape_type"] for shape in content["shapes"]] == ["polygon"] * 2
    assert content["shapes"][0]["points"][0] == [20.5, 10.5]
    assert [shape["flags"]["hole"] for shape in content["shapes"]] == [False, True]


def test_a_file_without_shapes_is_left_out_unless_it_says_that_there_is_no_target() -> None:
    content = parsed(Silhouette(rings=(), image_shape=SHAPE, claim="lit side"))
    (empty,) = read_labelme(content, "frame-3.json")
    assert empty.rings == ()
    content["flags"] = {}
    assert read_labelme(content, "frame-3.json") == ()


def test_labels_are_parts_only_in_a_file_that_tells_them_from_the_target() -> None:
    content = parsed(Silhouette(rings=(SQUARE,), image_shape=SHAPE, claim="lit side"))
    content["shapes"].append({**content["shapes"][0], "label": "panel"})
    whole, panel = read_labelme(content, "3.json")
    assert (whole.component, whole.claim) == ("target", "lit side")
    assert (panel.component, panel.claim) == ("panel", None)
    del content["radarhull"]
    assert [each.component for each in read_labelme(content, "3.json")] == ["target", "panel"]
    content["shapes"][0]["label"] = "body"
    (all_of_it,) = read_labelme(content, "3.json")
    assert all_of_it.component is None


@pytest.mark.parametrize("kind", ["circle", "rectangle", None, 7])
def test_other_shapes_are_refused(kind) -> None:
    content = parsed(Silhouette(rings=(SQUARE,), image_shape=SHAPE, claim="lit side"))
    content["shapes"][0]["shape_type"] = kind
    with pytest.raises(ValueError, match="polygons only"):
        read_labelme(content, "frame-3.json")
