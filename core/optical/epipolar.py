"""What two views of the same point have to do with each other (the paper's eq. 8)."""

import numpy as np

from core.arrays import Floats
from core.geometry.projection import Projection

PARALLEL_RAD = 1e-6
"""Two parallel cameras whose lines of sight differ by less share every direction, not one."""


def relative_pose(
    first: tuple[Floats, Floats], second: tuple[Floats, Floats]
) -> tuple[Floats, Floats]:
    """Return (R, T) with x₂ = R x₁ + T between the frames of two cameras.

    Args:
        first: (rotation (3, 3) from the target frame to the camera, translation (3,) in metres:
            the target frame's origin as the camera sees it).
        second: the same of the second camera.

    Source: eq. 8.
    """
    rotation = second[0] @ first[0].T
    return rotation, second[1] - rotation @ first[1]


def essential_matrix(rotation: Floats, translation_m: Floats) -> Floats:
    """Return E = [T]× R, for which x₂ᵀ E x₁ = 0 of every point seen along rays x₁ and x₂.

    Args:
        rotation: (3, 3) R from the first camera's frame to the second's.
        translation_m: (3,) T, the first camera as the second sees it; its length only scales E.

    Raises:
        ValueError: both cameras stand at the same place, where every pair of rays would do.

    Source: eq. 8; Longuet-Higgins, "A computer algorithm for reconstructing a scene from two
    projections", 1981.
    """
    if not float(np.linalg.norm(translation_m)) > 0:
        raise ValueError("Two cameras at the same place have no essential matrix; T is zero.")
    return cross_matrix(translation_m) @ rotation


def cross_matrix(vector: Floats) -> Floats:
    """Return the (3, 3) matrix [v]× with [v]× w = v × w."""
    x, y, z = vector
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def epipolar_matrix(first: Projection, second: Projection) -> Floats:
    """Return the (3, 3) F of norm 1 with p₂ᵀ F p₁ = 0 for p = (row, column, 1) of every point.

    Of two parallel cameras it has the affine form: its upper left 2 × 2 are zero.

    Args:
        first: parallel or perspective.
        second: of the same kind.

    Raises:
        ValueError: of different kinds, or views that do not constrain each other: perspective
            cameras at the same place, parallel ones along the same line of sight.

    Source: Hartley and Zisserman, "Multiple view geometry in computer vision", 2004, 9.2 and 14.2.
    """
    if first.is_affine != second.is_affine:
        raise ValueError("Give two parallel or two perspective cameras, not one of each.")
    matrix = _affine(first, second) if first.is_affine else _perspective(first, second)
    scaled: Floats = matrix / np.linalg.norm(matrix)
    return scaled


def epipolar_segment(
    first: Projection, second: Projection, seen_px: Floats, *, reach_m: float
) -> Floats | None:
    """Return the (2, 2) ends, as (row, column), of the line on which the second view sees a point.

    Whatever the first view shows at a pixel lies on that pixel's line of sight; its part near the
    target, as the second view sees it, is the segment. The views may be of different kinds.

    Args:
        first: in which the point was seen, parallel or perspective.
        second: parallel or perspective.
        seen_px: (2,) where it was seen, as (row, column).
        reach_m: how far the point may be from the target frame's origin.

    Returns:
        None where the line of sight passes the target by, or partly behind the second camera.

    Source: Hartley and Zisserman, "Multiple view geometry in computer vision", 2004, 9.1.
    """
    nearest, direction = _line_of_sight(first, seen_px)
    aside_m = float(np.linalg.norm(nearest))
    if aside_m >= reach_m:
        return None
    half_m = np.sqrt(reach_m**2 - aside_m**2)
    ends = nearest + np.outer([-half_m, half_m], direction)
    if not second.is_affine and (ends @ second.matrix[2, :3] + second.matrix[2, 3] <= 0).any():
        return None
    return second.image_points(ends)


def _line_of_sight(view: Projection, seen_px: Floats) -> tuple[Floats, Floats]:
    """Return the point (3,) of a pixel's line of sight that is nearest to the origin, and its way.

    Of a radar image the "line of sight" is the normal of the range–cross-range plane: along it the
    image tells nothing.
    """
    if view.is_affine:
        return view.plane_points(seen_px), view.viewing_direction()
    inverse = np.linalg.inv(view.matrix[:, :3])
    centre, ray = -inverse @ view.matrix[:, 3], inverse @ [*seen_px, 1.0]
    direction: Floats = ray / np.linalg.norm(ray)
    return centre - (centre @ direction) * direction, direction


def common_direction(first: Projection, second: Projection) -> Floats:
    """Return the (3,) unit direction in which the image planes of two parallel views meet.

    Both images show the target's extent along it, and must agree; its sign is arbitrary.

    Raises:
        ValueError: a perspective view, or views along the same line of sight.
    """
    if not (first.is_affine and second.is_affine):
        raise ValueError("Only parallel views have image planes in the target frame.")
    direction = np.cross(first.viewing_direction(), second.viewing_direction())
    sine = float(np.linalg.norm(direction))
    if sine < PARALLEL_RAD:
        raise ValueError(
            f"The two views look along the same line to {sine:.1g} rad, so their image planes "
            "share every direction; take views from different directions."
        )
    unit: Floats = direction / sine
    return unit


def _affine(first: Projection, second: Projection) -> Floats:
    """Both images show u·X along the common direction u: n₁·p₁ = n₂·p₂, up to constants."""
    along = common_direction(first, second)
    normals = [np.linalg.pinv(view.matrix[:, :3]).T @ along for view in (first, second)]
    offsets = [n @ view.matrix[:, 3] for n, view in zip(normals, (first, second), strict=True)]
    matrix = np.zeros((3, 3))
    matrix[2, :2] = normals[0]
    matrix[:2, 2] = -normals[1]
    matrix[2, 2] = offsets[1] - offsets[0]
    return matrix


def _perspective(first: Projection, second: Projection) -> Floats:
    one, two = first.matrix, second.matrix
    centre = -np.linalg.solve(one[:, :3], one[:, 3])
    epipole = two[:, :3] @ centre + two[:, 3]
    if float(np.linalg.norm(epipole)) < 1e-9 * float(np.linalg.norm(two[:, 3])):
        raise ValueError("Two cameras at the same place do not constrain each other.")
    return cross_matrix(epipole) @ two[:, :3] @ np.linalg.inv(one[:, :3])
