import numpy as np
import pytest
import trimesh

from core.experiments.true_outline import true_silhouette
from core.optical.camera import affine_camera, camera_axes


def test_the_outline_of_a_ring_has_its_hole():
    ring = trimesh.creation.annulus(r_min=2.0, r_max=4.0, height=1.0, sections=256)
    axes = camera_axes(np.array([0.0, 0, 1]), np.array([1.0, 0, 0]))
    camera = affine_camera(axes, pixel_m=0.1, shape=(128, 128))
    silhouette = true_silhouette(ring, camera, (128, 128))
    assert len(silhouette.rings) == 2
    assert silhouette.area_px() == pytest.approx(np.pi * (40**2 - 20**2), rel=1e-3)
