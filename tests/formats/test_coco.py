import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.formats.annotations import read_annotations
from core.formats.coco import coco_json, read_coco
from core.silhouettes.silhouette import Silhouette, clockwise_area_px
from tests.formats.synthetic_outlines import SHAPE, assert_same_rings, silhouettes

SQUARE = np.array([[10.0, 20.0], [10.0, 29.0], [19.0, 29.0], [19.0, 20.0]])


def square(*holes: np.ndarray, component: str = "target") -> Silhouette:
    return Silhouette(
        rings=(SQUARE, *holes), image_shape=SHAPE, claim="lit side", component=component
    )


def parsed(*silhouettes: Silhouette) -> dict:
    return json.loads(coco_json(enumerate(silhouettes, start=1)))


@given(st.lists(silhouettes(), min_size=1, max_size=3))
def test_outlines_come_back_ring_by_ring(each) -> None:
    found = read_annotations(coco_json(enumerate(each, start=1)), "file.json")
    assert [annotation.number for annotation in found] == list(range(1, len(each) + 1))
    for annotation, silhouette in zip(found, each, strict=True):
        assert_same_rings(annotation.rings, silhouette)
        assert annotation.image_shape == SHAPE
        if not silhouette.is_empty:
            assert annotation.claim == silhouette.claim
            assert annotation.component == silhouette.component


def test_coordinates_count_from_the_corner_of_the_image() -> None:
    annotation = parsed(square())["annotations"][0]
    assert annotation["segmentation"] == [[20.5, 10.5, 29.5, 10.5, 29.5, 19.5, 20.5, 19.5]]
    assert annotation["bbox"] == [20.5, 10.5, 9.0, 9.0]
    assert annotation["area"] == 81


def test_an_outline_with_a_hole_is_a_mask_for_other_programs() -> None:
    hole = np.array([[13.5, 23.5], [15.5, 23.5], [15.5, 25.5], [13.5, 25.5]])
    silhouette = square(hole)
    content = parsed(silhouette)
    runs = content["annotations"][0]["segmentation"]
    assert runs["size"] == list(SHAPE)
    flat = np.repeat(np.arange(len(runs["counts"])) % 2, runs["counts"])
    mask = flat.reshape(SHAPE[::-1]).T.astype(bool)
    assert np.array_equal(mask, silhouette.mask())
    assert not mask[14, 24]


def test_a_mask_that_another_program_changed_is_read_instead_of_the_old_rings() -> None:
    hole = np.array([[13.5, 23.5], [15.5, 23.5], [15.5, 25.5], [13.5, 25.5]])
    content = parsed(square(hole))
    everything = {"counts": [0, SHAPE[0] * SHAPE[1]], "size": list(SHAPE)}
    content["annotations"][0]["segmentation"] = everything
    (ring,) = read_coco(content)[0].rings
    assert clockwise_area_px(ring) == pytest.approx(SHAPE[0] * SHAPE[1], abs=1)


def test_annotations_of_one_image_are_united() -> None:
    content = parsed(square())
    other = {**content["annotations"][0], "segmentation": [[25, 10, 35, 10, 35, 20, 25, 20]]}
    content["annotations"].append(other)
    (annotation,) = read_coco(content)
    assert sum(map(clockwise_area_px, annotation.rings)) == pytest.approx(81 + 100 - 4.5 * 9)


def test_images_without_annotations_are_left_alone_unless_they_show_no_target() -> None:
    empty = Silhouette(rings=(), image_shape=SHAPE, claim="lit side")
    content = parsed(square(), empty)
    assert [each.rings == () for each in read_coco(content)] == [False, True]
    content["annotations"] = []
    assert [each.number for each in read_coco(content)] == [2]


def test_categories_are_parts_only_in_a_file_that_tells_them_from_the_target() -> None:
    empty = Silhouette(rings=(), image_shape=SHAPE, claim="complete")
    content = json.loads(coco_json([(1, empty), (1, square(component="panel"))]))
    assert {each.component: len(each.rings) for each in read_coco(content)} == {
        "panel": 1,
        "target": 0,
    }
    content["categories"][0]["name"] = "station"
    (all_of_it,) = read_coco(content)
    assert all_of_it.component is None
    assert len(all_of_it.rings) == 1


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"segmentation": [[1, 2, 3]]}, "list x, y, x, y"),
        ({"segmentation": [[1, 2, 3, 4]]}, "at least three points"),
        ({"segmentation": [[1, 2, 3, 4, "5", 6]]}, "list x, y, x, y"),
        ({"segmentation": [[0, 0, 1e999, 0, 1, 1]]}, "finite|three points"),
        ({"segmentation": {"counts": [1], "size": list(SHAPE)}}, "run lengths that fill"),
        ({"segmentation": {"counts": "abc", "size": list(SHAPE)}}, "compressed"),
        ({"segmentation": {"counts": [-1, 2401], "size": list(SHAPE)}}, "run lengths that fill"),
        ({"segmentation": None}, "polygons, or run lengths"),
        ({"segmentation": [[10**400, 0, 1, 0, 1, 1]]}, "three points"),
        ({"image_id": "1"}, "whole number"),
        ({"category_id": [1]}, "whole number"),
    ],
)
def test_what_is_no_outline_is_refused(change, sentence) -> None:
    content = parsed(square())
    content["annotations"][0].update(change)
    with pytest.raises(ValueError, match=sentence):
        read_coco(content)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"file_name": "nameless.png"}, "the number of its frame"),
        ({"height": 2**20, "width": 2**20}, "pixels"),
        ({"height": True}, "whole number"),
    ],
)
def test_what_is_no_image_is_refused(change, sentence) -> None:
    content = parsed(square())
    content["images"][0].update(change)
    with pytest.raises(ValueError, match=sentence):
        read_coco(content)
