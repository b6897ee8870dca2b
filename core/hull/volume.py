"""The vote volume: everything that a person or a program does with a hull."""

import numpy as np
from numpy.typing import NDArray

from core.geometry.grid import VoxelGrid
from core.hull.blame import removed_alone_m3
from core.hull.closed_mesh import Surface
from core.hull.mesher import SurfaceMesher
from core.hull.reprojection import reprojected_mask
from core.hull.votes import VoteCounts


class VoteVolume(VoteCounts):
    """Views that vote on one grid, and the hull that they leave.

    Views are added, replaced, excluded and removed, and the threshold changes; votes and surface
    follow by what changed, and equal those from scratch bit for bit. One thread writes at a time,
    any number may read.
    """

    def __init__(self, grid: VoxelGrid) -> None:
        """Start with no views and no votes on `grid`.

        Raises:
            ValueError: a grid whose votes memory cannot hold.
        """
        super().__init__(grid)
        self._mesher = SurfaceMesher(self)

    def surface(self) -> Surface:
        """Return the exact surface of the hull as it now is, at the volume's threshold.

        Only what changed since the last call is meshed again.

        Raises:
            ValueError: no views vote.
        """
        return self._mesher.surface()

    def reprojection(self, number: int) -> NDArray[np.bool_]:
        """Return the pixels (rows, columns) of a view's image that the hull covers.

        Where they fall short of the silhouette, other views have carved what this one claims.

        Raises:
            ValueError: there is no such view, or no views vote.
        """
        with self.reading():
            view = self._voter(number).view
            surface = self.surface()
        return reprojected_mask(surface, view.projection, view.silhouette.image_shape)

    def blame(self) -> dict[int, float]:
        """Return for each voting view the volume, in m³, that it alone removes."""
        return removed_alone_m3(self)
