"""Compiling every kernel ahead, so that no analyst waits for it at an edit."""

import numpy as np

from core.geometry.grid import VoxelGrid
from core.geometry.projection import Projection
from core.hull.blame import removed_alone_m3
from core.hull.mesher import SurfaceMesher
from core.hull.reprojection import reprojected_mask
from core.hull.view import View
from core.hull.votes import MOST_BYTE_VIEWS, VoteVolume
from core.silhouettes.silhouette import Silhouette


def warm_up() -> None:
    """Run every kernel once on a tiny volume: about 20 s the first time, from disk after that."""
    volume = VoteVolume(VoxelGrid.cube(side_m=4.0, spacing_m=1.0))
    views = [_square_view(axis) for axis in range(3)]
    first, *_ = volume.add_many(views)
    _use_all(volume, first)
    volume.add_many(views * (MOST_BYTE_VIEWS // 3))
    _use_all(volume, first)


def _use_all(volume: VoteVolume, number: int) -> None:
    mesher = SurfaceMesher(volume)
    mesher.surface()
    volume.replace(number, _square_view(0, side_px=2.5))
    surface = mesher.surface()
    removed_alone_m3(volume)
    reprojected_mask(surface, volume.voters[number].view.projection, (4, 4))


def _square_view(axis: int, side_px: float = 3.0) -> View:
    half = 0.5 * side_px
    ring = half * np.array([[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]])
    matrix = np.zeros((2, 4))
    matrix[:, :3] = np.roll(np.eye(3), axis, axis=1)[:2]
    silhouette = Silhouette(rings=(ring,), image_shape=(4, 4), claim="complete")
    return View(silhouette=silhouette, projection=Projection(matrix=matrix))
