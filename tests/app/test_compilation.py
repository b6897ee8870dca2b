import time

import numpy as np

from app.compilation import compiling
from core.hull.surface import hull_surface, mask_surface
from tests.hull.test_mesher import box_volume


def test_surfaces_are_exact_as_soon_as_the_kernels_are_there():
    volume, _ = box_volume()
    with compiling() as compilation:
        if not compilation.is_done:
            halfway = mask_surface(volume.hull(), volume.grid)
            assert np.array_equal(compilation.surface_of(volume).vertices_m, halfway.vertices_m)
        deadline = time.monotonic() + 60
        while not compilation.is_done and time.monotonic() < deadline:
            time.sleep(0.05)
        assert compilation.is_done
        exact = hull_surface(volume)
        assert np.array_equal(compilation.surface_of(volume).vertices_m, exact.vertices_m)


def test_leaving_ends_the_process():
    with compiling() as compilation:
        pass
    assert compilation.is_done
