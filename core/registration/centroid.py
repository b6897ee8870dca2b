"""Registration of views whose images carry unknown offsets in range and cross-range."""

import numpy as np
from shapely.geometry import MultiPolygon, Polygon

from core.arrays import Floats
from core.geometry.projection import Projection
from core.silhouettes.silhouette import Silhouette, clockwise_area_px


def centroid_registered(silhouette: Silhouette, projection: Projection) -> Projection:
    """Return the projection shifted so that the target frame's origin lands on the centroid.

    Every view so shifted shares one centroid, which becomes the origin. The centroid of a lit
    side is not the target's: with radar silhouettes this registration alone is biased.

    Raises:
        ValueError: the silhouette is empty, or the projection is perspective.

    Source: section III.D of the paper.
    """
    if silhouette.is_empty:
        raise ValueError("An empty silhouette has no centroid to register by; exclude its frame.")
    if not projection.is_affine:
        raise ValueError("Only radar and affine views are registered by their centroid.")
    matrix = projection.matrix.copy()
    matrix[:, 3] = centroid_px(silhouette)
    return Projection(matrix=matrix)


def centroid_px(silhouette: Silhouette) -> Floats:
    """Return the (row, column) centroid of the silhouette's area, holes taken out."""
    outers = [Polygon(ring) for ring in silhouette.rings if clockwise_area_px(ring) > 0]
    holes = [Polygon(ring) for ring in silhouette.rings if clockwise_area_px(ring) <= 0]
    area = sum(outer.area for outer in outers) - sum(hole.area for hole in holes)
    moment = np.array(MultiPolygon(outers).centroid.coords[0]) * sum(o.area for o in outers)
    for hole in holes:
        moment -= hole.area * np.array(hole.centroid.coords[0])
    centroid: Floats = moment / area
    return centroid
