import numpy as np
import shapely
from scipy.spatial.transform import Rotation

from core.geometry.grid import VoxelGrid
from core.geometry.projection import Projection
from core.hull.surface import hull_surface
from core.hull.view import View
from core.hull.votes import VoteCounts
from core.silhouettes.areas import rings_of
from core.silhouettes.silhouette import Silhouette

HALF_SIZES_M = np.array([2.0, 1.4, 0.06])
PIXEL_M = 0.02


def plate_views(count):
    """Return exact outlines of a thin plate from all around."""
    corners = HALF_SIZES_M * np.array(np.meshgrid(*[[-1, 1]] * 3)).reshape(3, 8).T
    for turn in Rotation.random(count, rng=np.random.default_rng(1)).as_matrix():
        projection = Projection(matrix=np.column_stack([turn[:2] / PIXEL_M, [150, 150]]))
        outline = shapely.convex_hull(shapely.multipoints(projection.image_points(corners)))
        silhouette = Silhouette(rings=rings_of(outline), image_shape=(300, 300), claim="complete")
        yield View(silhouette=silhouette, projection=projection)


def test_an_edge_that_hundreds_of_views_end_is_cut_where_the_first_ends_it():
    volume = VoteCounts(VoxelGrid.cube(side_m=5.0, spacing_m=0.11))
    volume.add_many(list(plate_views(300)))
    reach_m = np.abs(hull_surface(volume).vertices_m).max(axis=0)
    # Every view bounds the plate's rim; with room for 64 of them it stood out by 2.9 mm.
    np.testing.assert_allclose(reach_m[:2], HALF_SIZES_M[:2], atol=8e-4)
