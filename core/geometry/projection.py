"""Projections from the target frame onto images (the paper's eqs. 5–7 and 9)."""

from dataclasses import dataclass

import numpy as np

from core.arrays import Floats, frozen


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Projection:
    """A map from target metres to image (row, column), pixel centres at integers.

    Attributes:
        matrix: 2 × 4 from homogeneous target metres to (row, column) for a radar image or an
            affine camera (A of eqs. 5–7), 3 × 4 to homogeneous (row, column) for a perspective
            camera.
    """

    matrix: Floats

    def __post_init__(self) -> None:
        rows = np.shape(self.matrix)[0] if np.ndim(self.matrix) == 2 else 0
        if rows not in (2, 3):
            raise ValueError(
                "A projection is a 2 × 4 (radar, affine camera) or 3 × 4 (perspective camera) "
                f"matrix, got shape {np.shape(self.matrix)}."
            )
        object.__setattr__(
            self, "matrix", frozen(self.matrix, np.float64, (rows, 4), "Projection matrix")
        )
        if np.linalg.matrix_rank(self.matrix[:, :3]) < 2:
            raise ValueError(
                "The projection maps the target onto a line: its row and column directions are "
                "parallel or zero. Does the line of sight stand still in this frame?"
            )
        if rows == 3 and not np.any(self.matrix[2, :3]):
            raise ValueError(
                "The third row of a 3 × 4 camera matrix gives the depth and must not be zero; "
                "give a parallel camera as 2 × 4."
            )

    @property
    def is_affine(self) -> bool:
        """Whether the projection is parallel (radar, affine camera), not perspective."""
        return len(self.matrix) == 2

    def image_points(self, points_m: Floats) -> Floats:
        """Project target points (…, 3) in metres to (…, 2) as (row, column)."""
        image: Floats = np.asarray(points_m) @ self.matrix[:, :3].T + self.matrix[:, 3]
        if self.is_affine:
            return image
        homogeneous: Floats = image[..., :2] / image[..., 2:]
        return homogeneous

    def viewing_direction(self) -> Floats:
        """Return the (3,) unit direction, target frame, along which an affine image sees nothing.

        For a radar image it is the normal of the range–cross-range plane. Its sign is arbitrary.
        A perspective camera gives its optical axis.
        """
        if self.is_affine:
            normal = np.cross(self.matrix[0, :3], self.matrix[1, :3])
        else:
            normal = self.matrix[2, :3]
        unit: Floats = normal / np.linalg.norm(normal)
        return unit

    def plane_points(self, image_points: Floats) -> Floats:
        """Return the points (…, 3) in metres of an affine image's own plane through the origin.

        The plane contains the target frame's origin and is spanned by the row and column
        directions; it is where the image stands in space.

        Args:
            image_points: (…, 2) as (row, column).

        Raises:
            ValueError: the projection is perspective and has no such plane.
        """
        if not self.is_affine:
            raise ValueError("A perspective image has no single plane in the target frame.")
        inverse = np.linalg.pinv(self.matrix[:, :3])
        points: Floats = (np.asarray(image_points) - self.matrix[:, 3]) @ inverse.T
        return points


def range_doppler_projection(
    *,
    line_of_sight: Floats,
    line_of_sight_rate_per_s: Floats,
    row_spacing_m: float,
    column_spacing_m: float,
    shape: tuple[int, int],
) -> Projection:
    """Return the projection of a range-Doppler image whose centre pixel images the origin.

    Args:
        line_of_sight: (3,) unit vector k from radar to target, target frame.
        line_of_sight_rate_per_s: (3,) dk/dt, target frame.
        row_spacing_m: range step between rows.
        column_spacing_m: cross-range step between columns.
        shape: (rows, columns) of the image; the origin lands on (rows // 2, columns // 2).

    Raises:
        ValueError: the line of sight stands still, so that there is no cross-range axis, or a
            pixel has no size.

    Source: eqs. 5 and 6, with rows in range k·p and columns in cross-range along dk/dt.
    """
    for name, spacing_m in (("Row", row_spacing_m), ("Column", column_spacing_m)):
        if not (np.isfinite(spacing_m) and spacing_m > 0):
            raise ValueError(
                f"{name} spacing of an image must be positive metres, got {spacing_m}."
            )
    line_of_sight_m = np.asarray(line_of_sight, dtype=np.float64)
    rate = np.asarray(line_of_sight_rate_per_s, dtype=np.float64)
    rate = rate - line_of_sight_m * (line_of_sight_m @ rate)
    speed = float(np.linalg.norm(rate))
    if not speed > 1e-12:
        raise ValueError(
            "The line of sight stands still in the target frame (|dk/dt| = "
            f"{speed:.1e} rad/s), so there is no cross-range; a moving line of sight is needed."
        )
    matrix = np.zeros((2, 4))
    matrix[0, :3] = line_of_sight_m / row_spacing_m
    matrix[1, :3] = rate / speed / column_spacing_m
    matrix[:, 3] = shape[0] // 2, shape[1] // 2
    return Projection(matrix=matrix)
