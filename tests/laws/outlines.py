"""Hypothesis strategies for outlines and projections at their most awkward."""

import numpy as np
import shapely
from hypothesis import strategies as st

from core.geometry.grid import VoxelGrid
from core.geometry.projection import Projection
from core.hull.view import View
from core.silhouettes.areas import rings_of
from core.silhouettes.silhouette import Silhouette

LATTICE = VoxelGrid(origin_m=np.array([-6.0, -5.0, -6.0]), spacing_m=1.0, shape=(13, 11, 12))

AXES = [np.array(row, dtype=float) for row in np.ndindex(3, 3, 3) if np.any(np.array(row) != 1)]


def silhouette(rings):
    return Silhouette(rings=tuple(rings), image_shape=(20, 20), claim="complete")


def with_repeats(ring, draw):
    """Put collinear and repeated vertices onto a ring."""
    points = []
    for tail, head in zip(ring, np.roll(ring, -1, axis=0), strict=True):
        points.append(tail)
        extra = draw(st.sampled_from(["none", "none", "middle", "again"]))
        if extra != "none":
            points.append(tail if extra == "again" else (tail + head) / 2)
    return np.array(points)


@st.composite
def integer_silhouettes(draw):
    """Unions of integer boxes and triangles less others: parts, holes, edges on grid lines."""
    coordinate = st.integers(-7, 7)
    shape = st.tuples(*[st.tuples(coordinate, coordinate)] * 3)

    def polygon(corners):
        a, b, _ = corners
        box = shapely.box(min(a[0], b[0]), min(a[1], b[1]), max(a[0], b[0]), max(a[1], b[1]))
        return box if draw(st.booleans()) else shapely.Polygon(corners)

    solids = [polygon(s) for s in draw(st.lists(shape, min_size=1, max_size=3))]
    holes = [polygon(s) for s in draw(st.lists(shape, max_size=2))]
    area = shapely.union_all(solids).difference(shapely.union_all(holes))
    area = shapely.union_all([part for part in shapely.get_parts(area) if part.area > 1e-3])
    return silhouette(with_repeats(ring, draw) for ring in rings_of(area))


@st.composite
def lattice_projections(draw):
    """Affine views along axes and diagonals, exact in floating point."""
    first, second = (draw(st.sampled_from(AXES)) - 1.0 for _ in range(2))
    matrix = np.zeros((2, 4))
    matrix[:, :3] = first, second
    if np.linalg.matrix_rank(matrix) < 2:
        matrix[:, :3] = np.roll(np.eye(3), draw(st.integers(0, 2)), axis=0)[:2]
    matrix[:, 3] = draw(st.integers(-2, 2)), draw(st.integers(-2, 2))
    return Projection(matrix=matrix)


@st.composite
def lattice_views(draw):
    return View(silhouette=draw(integer_silhouettes()), projection=draw(lattice_projections()))
