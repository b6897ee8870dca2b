"""Vertices moved onto the nearest edge of the image."""

import numpy as np
from scipy.ndimage import map_coordinates, spline_filter

from core.arrays import Floats
from core.frame import Frame
from core.silhouettes.editing.levels import intensity
from core.silhouettes.editing.overlay import repaired

STEP_PX = 0.25
"""Of the samples along the normal; the parabola through three of them finds the place between."""


def snapped(
    rings: tuple[Floats, ...], frame: Frame, reach_px: float, *, smoothing_px: float = 1.0
) -> tuple[Floats, ...]:
    """Return the outline with each vertex where the image falls off most steeply, near by.

    A vertex moves along its normal only, by at most `reach_px`, to where intensity falls fastest
    toward the outside. Where it does not fall at all, or only ever faster up to the end of the
    reach, the vertex stays. An outline that comes to cross itself is split where it does.

    Args:
        rings: each (vertices, 2) as (row, column), outer clockwise, holes not.
        frame: the image that they are drawn in.
        reach_px: how far a vertex may move.
        smoothing_px: standard deviation of the Gaussian that evens out speckle before.

    Raises:
        ValueError: a reach that is not positive or wider than the image, or a dark frame.
    """
    if not 0 < reach_px <= max(frame.shape):
        raise ValueError(
            f"The reach must be positive and at most the image's {max(frame.shape)} pixels, got "
            f"{reach_px}."
        )
    level = spline_filter(intensity(frame, smoothing_px), order=3)
    # Clockwise with rows down, the outside of a ring is on the left, and a hole's is within it.
    moved = tuple(
        ring + _fall_px(level, ring, normals(ring), reach_px)[:, None] * normals(ring)
        for ring in rings
    )
    return repaired(moved)


def normals(ring: Floats) -> Floats:
    """Return the unit normals (vertices, 2) of a ring, out of the area; zero where there is none.

    Each is across the line between the neighbours, the longer edge weighing less.
    """
    ahead = _unit(np.roll(ring, -1, axis=0) - ring)
    along = _unit(ahead + np.roll(ahead, 1, axis=0))
    return np.column_stack([-along[:, 1], along[:, 0]])


def _unit(vectors: Floats) -> Floats:
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    unit: Floats = np.divide(vectors, length, out=np.zeros_like(vectors), where=length > 1e-12)
    return unit


def _fall_px(level: Floats, points: Floats, outward: Floats, reach_px: float) -> Floats:
    """Return how far out (points,) the steepest fall lies; 0 where there is none within reach.

    Args:
        level: (rows, columns) spline coefficients of the image.
        points: (points, 2) where the normals start.
        outward: (points, 2) unit normals.
        reach_px: the farthest, either way.
    """
    count = int(np.ceil(reach_px / STEP_PX))
    steps = reach_px * np.arange(-count - 1, count + 2) / count
    places = points[:, None] + steps[:, None] * outward[:, None]
    samples = map_coordinates(level, places.T, order=3, mode="nearest", prefilter=False).T
    fall = samples[:, :-2] - samples[:, 2:]  # at each step but the first and the last
    best = np.argmax(fall, axis=1)
    inner = np.clip(best, 1, fall.shape[1] - 2)
    before, there, after = (
        np.take_along_axis(fall, (inner + shift)[:, None], axis=1)[:, 0] for shift in (-1, 0, 1)
    )
    bend = before - 2 * there + after
    peaks = (best == inner) & (there > 0) & (bend < 0)
    between = np.divide(before - after, 2 * bend, out=np.zeros_like(bend), where=peaks)
    step_px = reach_px / count
    distance = steps[1:-1][inner] + step_px * np.clip(between, -0.5, 0.5)
    return np.where(peaks, distance, 0.0)
