"""The outline that a target truly has in an image, to hold extracted ones against."""

import numpy as np
import shapely
import trimesh

from core.geometry.projection import Projection
from core.silhouettes.areas import rings_of
from core.silhouettes.silhouette import Silhouette


def true_silhouette(
    mesh: trimesh.Trimesh, projection: Projection, image_shape: tuple[int, int]
) -> Silhouette:
    """Return the exact outline of a mesh: the union of its facets' images."""
    corners = projection.image_points(np.asarray(mesh.vertices))[np.asarray(mesh.faces)]
    facets = shapely.polygons(np.concatenate([corners, corners[:, :1]], axis=1))
    # Facets seen edge-on have no area, and slivers of rounding would leave pinholes.
    union = shapely.union_all(facets[shapely.area(facets) > 1e-9], grid_size=1e-6)
    return Silhouette(rings=rings_of(union), image_shape=image_shape, claim="complete")
