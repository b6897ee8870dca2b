"""Cameras that see the target: parallel and perspective, in any roll about their axis.

A camera's axes are a rotation R from the target frame whose rows point right (along growing
columns), down (along growing rows) and ahead (along the line of sight). That is right-handed, as
right × down = ahead, so a picture is what an observer sees and never its mirror image.
"""

import numpy as np

from core.arrays import Floats
from core.geometry.projection import Projection

ROTATION_TOLERANCE = 1e-3
"""How far R Rᵀ may be from the identity; published cameras reach 1e-6."""


def camera_axes(line_of_sight: Floats, across: Floats, *, roll_rad: float = 0.0) -> Floats:
    """Return the (3, 3) rotation of a camera: its rows point right, down and ahead.

    Args:
        line_of_sight: (3,) direction from camera to target, target frame.
        across: (3,) direction that points right in the picture at no roll, target frame; only
            its part across the line of sight counts.
        roll_rad: turns the camera clockwise about its line of sight, as the observer sees it, so
            that the picture turns counter-clockwise.

    Raises:
        ValueError: `across` lies along the line of sight.
    """
    ahead = np.asarray(line_of_sight, dtype=np.float64) / np.linalg.norm(line_of_sight)
    across = np.asarray(across, dtype=np.float64)
    right = across - ahead * (ahead @ across)
    width = float(np.linalg.norm(right))
    if not width > 1e-9 * float(np.linalg.norm(across)):
        raise ValueError(
            f"The direction across, {across}, lies along the line of sight, {ahead}, so the "
            "camera's roll has no meaning; give another one."
        )
    right = right / width
    down = np.cross(ahead, right)
    cosine, sine = np.cos(roll_rad), np.sin(roll_rad)
    return np.stack([cosine * right + sine * down, cosine * down - sine * right, ahead])


def affine_camera(rotation: Floats, *, pixel_m: float, shape: tuple[int, int]) -> Projection:
    """Return the parallel projection of a distant camera, with the origin at the centre pixel.

    Args:
        rotation: (3, 3) from `camera_axes`.
        pixel_m: plate scale, the size of a pixel on the target.
        shape: (rows, columns); the origin lands on (rows // 2, columns // 2).

    Raises:
        ValueError: no rotation, or a pixel without size.

    Source: eq. 7, scaled by the pixel spacing.
    """
    _check(rotation, pixel_m=pixel_m)
    matrix = np.zeros((2, 4))
    matrix[:, :3] = rotation[[1, 0]] / pixel_m
    matrix[:, 3] = shape[0] // 2, shape[1] // 2
    return Projection(matrix=matrix)


def perspective_camera(
    rotation: Floats, *, range_m: float, pixel_m: float, shape: tuple[int, int]
) -> Projection:
    """Return the projection of a camera at a range, aimed at the target frame's origin.

    Args:
        rotation: (3, 3) from `camera_axes`.
        range_m: from the camera to the origin.
        pixel_m: size of a pixel at that range; the focal length is range_m / pixel_m pixels.
        shape: (rows, columns); the origin lands on (rows // 2, columns // 2).

    Raises:
        ValueError: no rotation, or a range or pixel that is not positive.
    """
    _check(rotation, pixel_m=pixel_m, range_m=range_m)
    focal_px = range_m / pixel_m
    intrinsics = np.array([[focal_px, 0, shape[1] // 2], [0, focal_px, shape[0] // 2], [0, 0, 1]])
    return camera_projection(intrinsics, rotation, np.array([0.0, 0.0, range_m]))


def camera_projection(intrinsics: Floats, rotation: Floats, translation_m: Floats) -> Projection:
    """Return the projection to (row, column) of a camera that gives (x, y) pixels by K [R t].

    Args:
        intrinsics: (3, 3) K, pixels.
        rotation: (3, 3) R from target frame to camera.
        translation_m: (3,) t, the target frame's origin as the camera sees it.

    Raises:
        ValueError: R is no rotation.
    """
    _check(rotation)
    to_column_row = intrinsics @ np.column_stack([rotation, translation_m])
    return Projection(matrix=to_column_row[[1, 0, 2]])


def perpendicular_partner(
    *,
    line_of_sight: Floats,
    cross_range: Floats,
    pixel_m: float,
    shape: tuple[int, int],
    roll_rad: float = 0.0,
    range_m: float | None = None,
) -> Projection:
    """Return the camera that sees, at the same moment, the plane across a radar frame's own.

    The radar image spans range and cross-range; this picture looks along the range. At no roll
    its horizontal axis lies along cross-range and its vertical along k × cross-range, which is
    the paper's choice: rows grow along k × cross-range, so that the picture is not mirrored.

    Args:
        line_of_sight: (3,) unit k from sensor to target, target frame.
        cross_range: (3,) direction in which the radar frame's columns grow.
        pixel_m: size of a pixel on the target.
        shape: (rows, columns) of the picture.
        roll_rad: any other roll, as in `camera_axes`.
        range_m: makes it a perspective camera at this range; None for a parallel one.

    Raises:
        ValueError: cross-range along the line of sight, or a size that is not positive.
    """
    rotation = camera_axes(line_of_sight, cross_range, roll_rad=roll_rad)
    if range_m is None:
        return affine_camera(rotation, pixel_m=pixel_m, shape=shape)
    return perspective_camera(rotation, range_m=range_m, pixel_m=pixel_m, shape=shape)


def _check(rotation: Floats, **lengths_m: float) -> None:
    skew = float(np.abs(rotation @ rotation.T - np.eye(3)).max())
    if skew > ROTATION_TOLERANCE or float(np.linalg.det(rotation)) < 0:
        raise ValueError(
            f"R must be a rotation, but R Rᵀ differs from the identity by {skew:.2g} and "
            f"det R is {float(np.linalg.det(rotation)):.3g}."
        )
    for name, length_m in lengths_m.items():
        if not (np.isfinite(length_m) and length_m > 0):
            raise ValueError(f"A camera's {name} must be positive metres, got {length_m}.")


def pixel_size_m(projection: Projection) -> float:
    """Return the size of a pixel at the target frame's origin, as the root of its area.

    Raises:
        ValueError: a camera with the origin behind it.
    """
    matrix = projection.matrix
    if not projection.is_affine:
        if not matrix[2, 3] > 0:
            raise ValueError("The target frame's origin lies behind the camera.")
        at_origin = projection.image_points(np.zeros(3))
        matrix = (matrix[:2] - at_origin[:, None] * matrix[2]) / matrix[2, 3]
    return float(1 / np.sqrt(np.linalg.norm(np.cross(matrix[0, :3], matrix[1, :3]))))
