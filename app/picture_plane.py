"""Where a frame's picture stands in space."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from viser import transforms

from core.arrays import Floats
from core.frame import Frame
from core.hull.surface import Surface
from core.silhouettes.silhouette import Silhouette

PICTURE_GAP_M = 0.6
"""Between the hull and the picture beside it."""

PICTURE_MARGIN_M = 1.5
"""Shown of a frame around its silhouette."""


@dataclass(frozen=True, slots=True)
class PicturePlane:
    """Where a parallel image stands in space.

    Attributes:
        centre_m: (3,) of the picture, target frame.
        right, down: (3,) unit vectors of growing columns and growing rows.
        aside_m: (3,) by how much the picture stands beside its plane through the origin.
        rows, columns: slices of the image that lie within the window.
        width_m, height_m: size of the picture.
    """

    centre_m: Floats
    right: Floats
    down: Floats
    aside_m: Floats
    rows: slice
    columns: slice
    width_m: float
    height_m: float

    def quaternion_wxyz(self) -> NDArray[np.float64]:
        """Return the rotation from the picture's axes (right, down, into it) to the target's."""
        axes = np.column_stack([self.right, self.down, np.cross(self.right, self.down)])
        return np.asarray(transforms.SO3.from_matrix(axes).wxyz, dtype=np.float64)

    def border_m(self) -> Floats:
        """Return the four corners of the picture, (4, 3)."""
        across, along = 0.5 * self.width_m * self.right, 0.5 * self.height_m * self.down
        corners = [-across - along, across - along, across + along, along - across]
        border: Floats = self.centre_m + np.array(corners)
        return border


def picture_plane(
    frame: Frame,
    silhouette: Silhouette,
    side_m: float,
    hull: Surface | None,
    *,
    camera_direction: Floats,
) -> PicturePlane | None:
    """Return where a frame's picture stands, None for a perspective image.

    The picture is cut to the silhouette and a margin, or to the window of `side_m` around the
    target where nothing was found, and moved along its normal: in the plane through the target
    the hull would hide it. There it stands where a camera in `camera_direction` (3,) sees it.
    """
    if not frame.projection.is_affine:
        return None
    right, down = plane_axes(frame)
    size = float(np.linalg.norm(down)), float(np.linalg.norm(right))
    rows, columns = (
        slice(int(first), int(last) + 1)
        for first, last in zip(*_window(frame, silhouette, np.array(size), side_m), strict=True)
    )
    aside = _aside(frame.projection.viewing_direction(), side_m, hull, camera_direction)
    middle = np.array([0.5 * (cut.start + cut.stop - 1) for cut in (rows, columns)])
    return PicturePlane(
        centre_m=frame.projection.plane_points(middle) + aside,
        right=right / size[1],
        down=down / size[0],
        aside_m=aside,
        rows=rows,
        columns=columns,
        width_m=float((columns.stop - columns.start) * size[1]),
        height_m=float((rows.stop - rows.start) * size[0]),
    )


def plane_axes(frame: Frame) -> tuple[Floats, Floats]:
    """Return where a column and a row further lies, each (3,) in metres of the target frame.

    Raises:
        ValueError: a perspective image.
    """
    ends = frame.projection.plane_points(np.array([[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]]))
    return ends[1] - ends[0], ends[2] - ends[0]


def _aside(normal: Floats, side_m: float, hull: Surface | None, camera_direction: Floats) -> Floats:
    """Return by how much (3,) to move a picture along its normal for the camera to see it.

    Behind the hull; but a hull that is open there reaches the window's edge and would hide it, so
    then the picture stands before its near end, like the section that the hull continues.
    """
    away = -normal if normal @ camera_direction > 0 else normal
    if hull is None or hull.is_empty:
        return 0.5 * side_m * away
    reach_m = hull.vertices_m @ away
    if reach_m.max() < 0.45 * side_m:
        return (float(reach_m.max()) + PICTURE_GAP_M) * away
    return (float(reach_m.min()) - PICTURE_GAP_M) * away


def _window(
    frame: Frame, silhouette: Silhouette, spacing_m: Floats, side_m: float
) -> tuple[Floats, Floats]:
    """Return the first and the last (row, column) of the part of a frame to show in space."""
    if silhouette.is_empty:
        origin = frame.projection.matrix[:, 3]
        first, last = origin - 0.5 * side_m / spacing_m, origin + 0.5 * side_m / spacing_m
    else:
        seen = np.concatenate(silhouette.rings)
        margin = PICTURE_MARGIN_M / spacing_m
        first, last = seen.min(axis=0) - margin, seen.max(axis=0) + margin
    end = np.array(frame.shape) - 1
    return np.clip(np.floor(first), 0, end - 1), np.clip(np.ceil(last), 1, end)
