"""Outlines taken over from other frames: copied, or blended between two."""

import numpy as np
import shapely
from scipy.spatial import cKDTree

from core.arrays import Floats
from core.frame import Frame
from core.optical.camera import pixel_size_m
from core.silhouettes.contours import traced_rings
from core.silhouettes.editing.brush import image_area
from core.silhouettes.editing.overlay import overlaid
from core.silhouettes.silhouette import Silhouette

SAMPLES_PX = 0.1
"""Distance between the points along an outline that distances to it are taken from; they are
right to half of it."""

MARGIN_PX = 2
"""Around both outlines, beyond which no blend of them reaches."""

SIMPLIFICATION_PX = 0.1
"""Blended rings lose the vertices that move them by less."""


def copied(rings: tuple[Floats, ...], source: Frame, target: Frame) -> tuple[Floats, ...]:
    """Return another frame's outline as it lies in this one.

    Rows and columns are taken in metres from where the target frame's origin is seen, so that
    frames with other centres or pixels fit. The target has turned between the two; the next or
    previous frame of a pass is where this helps. What falls outside the image is cut off.

    Args:
        rings: of the source frame, each (vertices, 2) as (row, column).
        source: where the outline was drawn.
        target: where it is wanted.

    Raises:
        ValueError: frames of different sensors, whose images show different planes.
    """
    placed = _placed(rings, source, target)
    if not placed:
        return ()
    image = image_area(target.shape)
    within = all(shapely.covers(image, shapely.LinearRing(ring)) for ring in placed)
    return placed if within else overlaid(placed, image, "intersect")


def interpolated(
    before: tuple[Floats, ...],
    before_frame: Frame,
    after: tuple[Floats, ...],
    after_frame: Frame,
    frame: Frame,
) -> tuple[Floats, ...]:
    """Return the outline between two edited ones, at a frame between theirs.

    Each outline gives a signed distance around it, in the frame's pixels from where the target
    frame's origin is seen; the two are blended by time, and the zero level is traced. Parts that
    move by more than their own width from one to the other get lost on the way: look at the
    result, and edit frames closer by where that happens.

    Args:
        before: the earlier outline's rings, each (vertices, 2) as (row, column).
        before_frame: where it was drawn.
        after: the later outline's rings.
        after_frame: where that was drawn.
        frame: where one is wanted.

    Raises:
        ValueError: a frame not between the two in time, an outline without rings, or frames of
            different sensors.

    Source: Raya and Udupa, "Shape-based interpolation of multidimensional objects", 1990.
    """
    if not before or not after:
        raise ValueError(
            "Both frames need an outline to interpolate between; "
            f'"{(after_frame if before else before_frame).label}" has none.'
        )
    first_s, last_s = before_frame.time_s, after_frame.time_s
    if not (first_s <= frame.time_s <= last_s and first_s < last_s):
        raise ValueError(
            f'"{frame.label}" is of {frame.time_s:g} s, which is not between {first_s:g} s and '
            f"{last_s:g} s; interpolate at a frame between the two edited ones."
        )
    ends = (_placed(before, before_frame, frame), _placed(after, after_frame, frame))
    share = (frame.time_s - first_s) / (last_s - first_s)
    corner, shape = _box_around(ends, frame.shape)
    distances = [signed_distance_px(_shifted(end, -corner), shape) for end in ends]
    level = (1 - share) * distances[0] + share * distances[1]
    rings = traced_rings(level.astype(np.float32), 0.0, simplification_px=SIMPLIFICATION_PX)
    return overlaid(_shifted(rings, corner), image_area(frame.shape), "intersect")


def signed_distance_px(rings: tuple[Floats, ...], image_shape: tuple[int, int]) -> Floats:
    """Return the distance from every pixel's centre to an outline, negative outside of it.

    Args:
        rings: at least one, each (vertices, 2) as (row, column).
        image_shape: (rows, columns).
    """
    edges = [shapely.segmentize(shapely.LinearRing(ring), SAMPLES_PX) for ring in rings]
    tree = cKDTree(shapely.get_coordinates(edges))
    pixels = np.moveaxis(np.indices(image_shape), 0, -1).astype(np.float64)
    distance, _ = tree.query(pixels.reshape(-1, 2))
    inside = Silhouette(rings=rings, image_shape=image_shape, claim="complete").mask()
    signed: Floats = np.where(inside, 1.0, -1.0) * distance.reshape(image_shape)
    return signed


def _placed(rings: tuple[Floats, ...], source: Frame, target: Frame) -> tuple[Floats, ...]:
    if source.sensor != target.sensor:
        raise ValueError(
            f'"{source.label}" is {source.sensor} and "{target.label}" is {target.sensor}: they '
            "show different planes of the target. Seed the outline from the hull instead."
        )
    scale = _spacing_m(source) / _spacing_m(target)
    origin, origin_there = (f.projection.image_points(np.zeros(3)) for f in (source, target))
    return tuple(origin_there + (ring - origin) * scale for ring in rings)


def _spacing_m(frame: Frame) -> Floats:
    """Return a frame's (row, column) spacing on the target, from its projection where unknown."""
    if frame.row_spacing_m is not None and frame.column_spacing_m is not None:
        return np.array([frame.row_spacing_m, frame.column_spacing_m])
    return np.full(2, pixel_size_m(frame.projection))


def _box_around(
    outlines: tuple[tuple[Floats, ...], ...], image_shape: tuple[int, int]
) -> tuple[Floats, tuple[int, int]]:
    """Return the first pixel and the shape of what holds outlines with a margin, in the image."""
    points = np.concatenate([ring for outline in outlines for ring in outline])
    image = np.array(image_shape, dtype=np.float64)
    first = np.clip(np.floor(points.min(axis=0)) - MARGIN_PX, -MARGIN_PX, image)
    last = np.clip(np.ceil(points.max(axis=0)) + MARGIN_PX, first, image + MARGIN_PX)
    rows, columns = (last - first).astype(int) + 1
    return first, (int(rows), int(columns))


def _shifted(rings: tuple[Floats, ...], by_px: Floats) -> tuple[Floats, ...]:
    return tuple(ring + by_px for ring in rings)
