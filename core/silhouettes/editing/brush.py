"""Brush, eraser, lasso and polygon: areas joined to an outline or cut out of it, exactly.

Strokes are polygons, not pixels. What they do not reach keeps its vertices to the last bit, so
that an edit costs the hull only what it changed.
"""

import numpy as np
import numpy.typing as npt
import shapely

from core.arrays import Floats, frozen
from core.silhouettes.areas import area_of
from core.silhouettes.editing.overlay import SLIVER_PX, Operation, overlaid

ROUNDNESS_PX = 0.02
"""How far the polygon of a round brush may stay within its circle."""


def painted(
    rings: tuple[Floats, ...],
    image_shape: tuple[int, int],
    points_px: npt.ArrayLike,
    radius_px: float,
    *,
    add: bool,
) -> tuple[Floats, ...]:
    """Return the outline after a stroke of a round brush, or of an eraser.

    Args:
        rings: of the outline, each (vertices, 2) as (row, column).
        image_shape: (rows, columns); nothing is painted outside the image.
        points_px: (points, 2) where the brush went; one point is a dab.
        radius_px: of the brush.
        add: whether it paints; otherwise it erases.

    Raises:
        ValueError: no points, or a radius that is not positive.
    """
    stroke = stroke_area(points_px, radius_px)
    if not add:
        return overlaid(rings, stroke, "subtract")
    return overlaid(rings, shapely.intersection(stroke, image_area(image_shape)), "add")


def combined(
    rings: tuple[Floats, ...], polygon_px: npt.ArrayLike, operation: Operation
) -> tuple[Floats, ...]:
    """Return the outline with a drawn polygon or lasso joined to it or cut out of it.

    A line that crosses itself stands for all that it encloses.

    Args:
        rings: of the outline, each (vertices, 2) as (row, column).
        polygon_px: (vertices, 2) drawn, either way around, not repeated at the end.
        operation: "add", "subtract", or "intersect" to keep only what lies within the polygon.

    Raises:
        ValueError: a polygon without area, or another operation.
    """
    polygon = frozen(polygon_px, np.float64, (None, 2), "The polygon drawn")
    line = shapely.node(shapely.LineString([*polygon, *polygon[:1]]))
    enclosed = shapely.union_all(shapely.get_parts(shapely.polygonize([line])))
    if not enclosed.area > SLIVER_PX:
        raise ValueError(
            f"The polygon drawn, of {len(polygon)} vertices, encloses no area; draw at least "
            "three that are not on a line."
        )
    return overlaid(rings, enclosed, operation)


def combined_rings(
    rings: tuple[Floats, ...], others: tuple[Floats, ...], operation: Operation
) -> tuple[Floats, ...]:
    """Return the outline combined with another one, which may have holes and several parts.

    Args:
        rings: of the outline, each (vertices, 2) as (row, column).
        others: the other outline's.
        operation: as in `combined`.

    Raises:
        ValueError: another operation.
    """
    return overlaid(rings, area_of(others), operation)


def stroke_area(points_px: npt.ArrayLike, radius_px: float) -> shapely.Geometry:
    """Return the area within `radius_px` of a line, to a fiftieth of a pixel.

    Args:
        points_px: (points, 2) as (row, column).
        radius_px: half the stroke's width.

    Raises:
        ValueError: no points, or a radius that is not positive.
    """
    points = frozen(points_px, np.float64, (None, 2), "A stroke")
    if len(points) == 0:
        raise ValueError("A stroke needs at least one point, got none.")
    if not (np.isfinite(radius_px) and radius_px > 0):
        raise ValueError(f"A brush's radius must be positive pixels, got {radius_px}.")
    # A chord over an angle of 2a stays r(1 − cos a) ≈ r a²/2 within the circle.
    half_angle_rad = np.sqrt(2 * ROUNDNESS_PX / radius_px)
    segments = max(int(np.ceil(np.pi / 4 / half_angle_rad)), 4)
    # To a millionth of a pixel: GEOS stumbles over steps of no length that is not quite zero.
    points = np.round(points, 6)
    line = shapely.LineString(points) if len(points) > 1 else shapely.Point(points[0])
    return shapely.buffer(line, radius_px, quad_segs=segments)


def image_area(image_shape: tuple[int, int]) -> shapely.Geometry:
    """Return the area that the pixels of an image (rows, columns) cover."""
    rows, columns = image_shape
    return shapely.box(-0.5, -0.5, rows - 0.5, columns - 0.5)
