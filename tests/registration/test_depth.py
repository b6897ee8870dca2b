import numpy as np
from scipy.ndimage import map_coordinates

from core.registration.depth import DistanceMaps, depths_px
from tests.registration.shifting import body_views


def test_distances_are_positive_inside_and_count_pixels():
    (view,) = body_views(1)
    maps = DistanceMaps.of([view])
    # A pixel's place in the image is its place in the map and the map's corner.
    inside = np.argwhere(maps.image(0) > 0) + maps.corner[0]
    assert np.array_equal(inside, np.argwhere(view.silhouette.mask()))
    assert np.abs(maps.image(0)).min() == 0.5


def test_the_kernel_is_the_greatest_of_the_least_distances():
    views = body_views(4)
    maps = DistanceMaps.of(views)
    matrices = np.array([view.projection.matrix for view in views])
    random = np.random.default_rng(1)
    lines = random.uniform(-3, 3, (50, 3))
    steps = np.linspace(-4, 4, 30)[:, None] * np.array([0.6, 0.0, 0.8])
    places = lines[:, None] + steps
    least = np.full(places.shape[:2], np.inf)
    for number in (0, 2, 3):
        image = views[number].projection.image_points(places) - maps.corner[number]
        image = np.clip(image, 0, maps.shape[number] - 1.001)
        at = np.moveaxis(image, -1, 0)
        least = np.minimum(least, map_coordinates(maps.image(number), at, np.float64, order=1))
    found = depths_px(lines, steps, matrices, np.array([3, 0, 2]), maps)
    assert np.abs(found - least.max(axis=1)).max() < 1e-3
