import numpy as np
import pytest

from core.geometry.projection import range_doppler_projection
from core.registration.centroid import centroid_px, centroid_registered
from core.silhouettes.contours import traced_rings
from core.silhouettes.silhouette import Silhouette


def silhouette(mask):
    return Silhouette(
        rings=traced_rings(mask.astype(np.float32), 0.5), image_shape=mask.shape, claim="complete"
    )


def test_the_centroid_takes_holes_and_parts_into_account():
    mask = np.zeros((40, 50), bool)
    mask[5:25, 6:30] = True
    mask[8:12, 10:20] = False
    mask[30:36, 35:45] = True
    assert centroid_px(silhouette(mask)) == pytest.approx(np.argwhere(mask).mean(axis=0), abs=0.05)


def test_offsets_of_the_frames_drop_out():
    projection = range_doppler_projection(
        line_of_sight=np.array([0, 0, 1.0]),
        line_of_sight_rate_per_s=np.array([1.0, 0, 0]),
        row_spacing_m=0.1,
        column_spacing_m=0.1,
        shape=(60, 60),
    )
    mask = np.zeros((60, 60), bool)
    mask[20:30, 18:40] = True
    place = centroid_registered(silhouette(mask), projection)
    moved = centroid_registered(silhouette(np.roll(mask, (7, -9), axis=(0, 1))), projection)
    assert moved.matrix - place.matrix == pytest.approx(np.array([[0, 0, 0, 7], [0, 0, 0, -9.0]]))


def test_an_empty_silhouette_cannot_be_registered():
    empty = Silhouette(rings=(), image_shape=(4, 4), claim="complete")
    with pytest.raises(ValueError, match="no centroid"):
        centroid_registered(empty, None)
