"""A view: all that the hull knows of an image."""

from dataclasses import dataclass

from core.geometry.projection import Projection
from core.silhouettes.silhouette import Silhouette


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class View:
    """A silhouette and the projection it was seen through (the paper's eq. 9).

    Attributes:
        silhouette: what may vote for a voxel: inside or on the outline is a vote.
        projection: from target metres to the silhouette's (row, column).
    """

    silhouette: Silhouette
    projection: Projection
