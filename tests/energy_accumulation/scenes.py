"""Range-Doppler images of points, blurred as a radar would."""

import numpy as np

from core.frame import Frame
from core.geometry.projection import range_doppler_projection


def frames_of_points(points_m, *, views, random, size=64, spacing_m=0.25):
    """Return frames from random directions, each point a Gaussian one pixel wide."""
    return [
        frame_of_points(points_m, random.normal(size=3), random.normal(size=3), size, spacing_m)
        for _ in range(views)
    ]


def frame_of_points(points_m, direction, rate, size, spacing_m):
    k = direction / np.linalg.norm(direction)
    projection = range_doppler_projection(
        line_of_sight=k,
        line_of_sight_rate_per_s=rate,
        row_spacing_m=spacing_m,
        column_spacing_m=spacing_m,
        shape=(size, size),
    )
    rows, columns = np.mgrid[:size, :size]
    amplitude = np.zeros((size, size))
    for row, column in projection.image_points(np.asarray(points_m, dtype=float)):
        amplitude += np.exp(-((rows - row) ** 2 + (columns - column) ** 2) / 2)
    return Frame(
        amplitude=np.where(amplitude > 1e-3, amplitude, 0),
        projection=projection,
        time_s=0.0,
        sensor="radar",
        line_of_sight=k,
        row_spacing_m=spacing_m,
        column_spacing_m=spacing_m,
        row_resolution_m=2.4 * spacing_m,
        column_resolution_m=2.4 * spacing_m,
    )
