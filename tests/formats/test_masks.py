import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis.extra.numpy import arrays

from core.formats.annotations import read_annotations
from core.formats.masks import mask_png, masks_zip, read_mask
from core.silhouettes.silhouette import Silhouette


def silhouette(rings, shape):
    return Silhouette(rings=tuple(rings), image_shape=shape, claim="complete")


@given(arrays(bool, (9, 12)))
def test_a_mask_comes_back_pixel_by_pixel(mask) -> None:
    found = read_mask(mask_png(mask), "frame-000007.png")
    assert (found.number, found.image_shape) == (7, mask.shape)
    again = silhouette(found.rings, mask.shape)
    assert np.array_equal(again.mask(), mask)
    archive = read_annotations(masks_zip([(7, again)]), "masks.zip")
    assert np.array_equal(silhouette(archive[0].rings, mask.shape).mask(), mask)


def test_an_opaque_alpha_channel_is_no_target_and_a_faint_grey_is() -> None:
    rgba = np.zeros((4, 5, 4), dtype=np.uint8)
    rgba[..., 3] = 255
    assert read_mask(cv2.imencode(".png", rgba)[1].tobytes(), "1.png").rings == ()
    deep = np.zeros((4, 5), dtype=np.uint16)
    deep[1:3, 1:4] = 1
    (ring,) = read_mask(cv2.imencode(".png", deep)[1].tobytes(), "1.png").rings
    assert np.array_equal(silhouette([ring], (4, 5)).mask(), deep > 0)


def test_a_png_that_says_it_is_huge_is_not_unpacked() -> None:
    png = bytearray(mask_png(np.ones((4, 4), dtype=bool)))
    png[16:24] = np.array([2**20, 2**20], dtype=">u4").tobytes()
    with pytest.raises(ValueError, match="pixels"):
        read_mask(bytes(png), "1.png")


@pytest.mark.parametrize("cut", [4, 20, 40])
def test_a_damaged_png_is_refused(cut) -> None:
    with pytest.raises(ValueError, match=r"no PNG|damaged"):
        read_mask(mask_png(np.eye(30, dtype=bool))[:cut], "1.png")
