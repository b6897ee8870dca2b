"""Perspective cameras that see what an affine view does."""

import numpy as np

from core.geometry.projection import Projection
from core.hull.view import View


def camera_like(view, distance_m):
    """Return the view through a camera that stands far off along its direction."""
    depth = np.append(view.projection.viewing_direction(), distance_m)
    centre = np.array([256.0, 256.0])
    affine = view.projection.matrix.copy()
    affine[:, 3] -= centre
    matrix = np.vstack([distance_m * affine + centre[:, None] * depth, depth])
    return View(silhouette=view.silhouette, projection=Projection(matrix=matrix))
