"""Observability: how well the views can constrain a length, by its direction.

A silhouette bounds the hull by the planes that touch its outline: along every direction of its
image plane, or, filled behind the first return, only towards the radar and in cross-range. Along
any other direction several such planes must meet, the more slantingly the further away. One number
says how far: the **dilution** of a direction is how long the hull of a unit ball would be along it,
seen from the same views, over the ball's own diameter. An error of the outlines enters a length
by as much, and so does what the hull is larger than the body.

It depends on where the views look from and on which sides they bound, never on the target.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np
from scipy.spatial import ConvexHull

from core.arrays import Floats, frozen
from core.geometry.projection import Projection
from core.hull.view import View
from core.measurement.key_points import image_derivative
from core.silhouettes.silhouette import Silhouette

Grade = Literal["good", "weak", "unobserved"]

GOOD_DILUTION = 1.25
"""At most a quarter more than the best: a direction within some 12° of an image plane, or more
where several views share the task."""

OBSERVED_DILUTION = 5.0
"""Past it a direction is unobserved: every view is blind within some 12 to 23° of it."""

DIRECTIONS = 32
"""Tangent planes of the ball that stand for each outline: they bound it within 0.5 %."""

FARTHEST = 1000.0
"""Dilution at which a hull without end is cut off."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Observability:
    """The hull that views leave of a unit ball around the origin of the target frame.

    Attributes:
        normals: (planes, 3) unit normals, outward, of the planes that bound it.
        corners: (corners, 3) of that hull in radii of the ball, cut off at `FARTHEST`.
    """

    normals: Floats
    corners: Floats

    def __post_init__(self) -> None:
        for field in ("normals", "corners"):
            checked = frozen(getattr(self, field), np.float64, (None, 3), f"The hull's {field}")
            object.__setattr__(self, field, checked)

    def dilution(self, direction: Floats) -> float:
        """Return by how much an outline's error counts along ± a direction (3,): 1 is the best.

        Infinite where no view bounds one of the two sides.
        """
        along = self.corners @ (np.asarray(direction) / np.linalg.norm(direction))
        worst = float(max(along.max(), -along.min()))
        return worst if worst < 0.5 * FARTHEST else float("inf")

    def grade(self, direction: Floats) -> Grade:
        """Return how well a length along ± a direction (3,) is constrained."""
        dilution = self.dilution(direction)
        if dilution > OBSERVED_DILUTION:
            return "unobserved"
        return "good" if dilution <= GOOD_DILUTION else "weak"

    def worst_direction(self) -> Floats:
        """Return the (3,) unit direction along which the ball's hull is longest."""
        reach = np.linalg.norm(self.corners, axis=1)
        if reach.max() < 0.5 * FARTHEST:
            farthest: Floats = self.corners[reach.argmax()] / reach.max()
            return farthest
        # Open to both sides it is along a line that lies in all its planes.
        least_seen: Floats = np.linalg.eigh(self.normals.T @ self.normals)[1][:, 0]
        if self.dilution(least_seen) == np.inf:
            return least_seen
        # Open to one side it is cut off in many corners about as far away, none on its axis.
        far = self.corners[reach > 0.5 * reach.max()]
        axis: Floats = np.linalg.eigh(far.T @ far)[1][:, -1]
        return axis


def observability(views: Sequence[View]) -> Observability:
    """Return what views let one see, by where they look from and on which sides they bound.

    Views whose silhouette is empty say nothing here.

    Args:
        views: as they vote (under the shadow rule already filled).
    """
    return _observability(
        tuple(
            (view.projection.matrix.tobytes(), _bounded_sides(view.silhouette))
            for view in views
            if not view.silhouette.is_empty
        )
    )


def unobserved_direction(views: Sequence[View]) -> Floats | None:
    """Return the (3,) unit direction that no view constrains, or None if all are observed.

    If all views are blind along nearly the same line (the image planes of one pass nearly
    coincide), the hull is open along it.

    Args:
        views: as they vote.
    """
    seen = observability(views)
    direction = seen.worst_direction()
    return direction if seen.grade(direction) == "unobserved" else None


Sides = tuple[bool, bool, bool, bool]


def _bounded_sides(silhouette: Silhouette) -> Sides:
    """Return whether a silhouette has an edge towards lesser and greater rows and columns.

    One that reaches more than a whole image past the image has been filled: there is no edge.
    """
    points = np.concatenate(silhouette.rings)
    size = np.array(silhouette.image_shape)
    low, high = (points.min(axis=0) > -size).tolist(), (points.max(axis=0) < 2 * size).tolist()
    return low[0], high[0], low[1], high[1]


@lru_cache(maxsize=8)  # edits leave it as it is, and follow each other fast
def _observability(views: tuple[tuple[bytes, Sides], ...]) -> Observability:
    normals = np.empty((0, 3))
    for matrix, sides in views:
        projection = Projection(matrix=np.frombuffer(matrix).reshape(-1, 4))
        normals = np.concatenate([normals, _tangent_normals(projection, sides)])
    cut_off = np.concatenate([np.eye(3), -np.eye(3)]) / FARTHEST
    # The corner where planes n · x = 1 meet is dual to the facet that their n span.
    facets = ConvexHull(np.concatenate([normals, cut_off])).equations
    return Observability(normals=normals, corners=-facets[:, :3] / facets[:, 3:])


def _tangent_normals(projection: Projection, sides: Sides) -> Floats:
    """Return the unit normals (n, 3) of the planes with which a view bounds the ball."""
    to_image = image_derivative(projection, np.zeros(3))
    in_plane = np.linalg.qr(to_image.T)[0]
    turn = 2 * np.pi * np.arange(DIRECTIONS) / DIRECTIONS
    normals = np.column_stack([np.cos(turn), np.sin(turn)]) @ in_plane.T
    # How far along rows and columns one has to look to see along each normal.
    across = np.linalg.lstsq(to_image.T, normals.T, rcond=None)[0].T
    rounding = 1e-9 * np.abs(across).max()
    low_row, high_row, low_column, high_column = sides
    bounded = (
        (low_row | (across[:, 0] >= -rounding))
        & (high_row | (across[:, 0] <= rounding))
        & (low_column | (across[:, 1] >= -rounding))
        & (high_column | (across[:, 1] <= rounding))
    )
    chosen: Floats = normals[bounded]
    return chosen
