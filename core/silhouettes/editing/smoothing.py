"""Outlines made smoother or simpler, and holes filled."""

import numpy as np
import shapely
from scipy.ndimage import gaussian_filter1d

from core.arrays import Floats
from core.silhouettes.areas import area_of, rings_of
from core.silhouettes.editing.overlay import kept_in_place, repaired
from core.silhouettes.editing.snapping import normals
from core.silhouettes.silhouette import clockwise_area_px

SAMPLES_PER_STRENGTH = 4
"""Vertices per standard deviation: more would not show."""

THINNING = 0.01
"""Smoothed rings lose the vertices that move them by less than this part of the strength."""


def smoothed(rings: tuple[Floats, ...], strength_px: float) -> tuple[Floats, ...]:
    """Return the outline without its wiggles shorter than some six times `strength_px`.

    Vertices become the Gaussian mean of the ring along its length, once forth and once half back
    so that broad bends stay, and the ring then moves in or out by the hair that gives it its old
    area. Rings too small for the strength are smoothed less, and none disappears.

    Args:
        rings: each (vertices, 2) as (row, column).
        strength_px: standard deviation of the Gaussian along the ring.

    Raises:
        ValueError: a strength that is not positive.

    Source: Taubin, "Curve and surface smoothing without shrinkage", 1995, for going forth and
    back; Tukey's twicing, 1977, for by how much.
    """
    if not (np.isfinite(strength_px) and strength_px > 0):
        raise ValueError(f"Smoothing needs a strength of positive pixels, got {strength_px}.")
    return repaired(tuple(_smoothed_ring(ring, strength_px) for ring in rings))


def simplified(rings: tuple[Floats, ...], tolerance_px: float) -> tuple[Floats, ...]:
    """Return the outline with as few of its vertices as keep it within `tolerance_px`.

    No ring disappears, crosses itself or another.

    Args:
        rings: each (vertices, 2) as (row, column).
        tolerance_px: how far the outline may move.

    Raises:
        ValueError: a negative tolerance.

    Source: Douglas and Peucker, 1973, kept from crossing by GEOS.
    """
    if not (np.isfinite(tolerance_px) and tolerance_px >= 0):
        raise ValueError(f"The tolerance must be pixels, not negative; got {tolerance_px}.")
    area = area_of(rings)
    simple = shapely.simplify(area, tolerance_px)
    # GEOS takes the vertex where a ring starts out in a second step, measured from what the first
    # one left: together they move the outline by up to twice what either may.
    old = shapely.points(shapely.get_coordinates(area))
    if np.any(shapely.distance(old, simple.boundary) > tolerance_px):
        simple = shapely.simplify(area, tolerance_px / 2)
    return kept_in_place(rings, rings_of(simple))


def without_holes(rings: tuple[Floats, ...], largest_px: float = np.inf) -> tuple[Floats, ...]:
    """Return the outline with holes of at most so many square pixels filled, all by default.

    Parts that stood within a filled hole become one with what fills it.

    Args:
        rings: each (vertices, 2) as (row, column).
        largest_px: area of the largest hole that is filled.

    Raises:
        ValueError: an area that is negative or no number.
    """
    if not largest_px >= 0:
        raise ValueError(f"Holes have an area in square pixels, not negative; got {largest_px}.")
    left = tuple(ring for ring in rings if not -largest_px <= clockwise_area_px(ring) < 0)
    return rings if len(left) == len(rings) else repaired(left)


def _smoothed_ring(ring: Floats, strength_px: float) -> Floats:
    line = shapely.LinearRing(ring)
    # A ring that is small for the Gaussian would collapse: at most half its mean radius.
    strength_px = min(strength_px, line.length / (4 * np.pi))
    count = max(int(np.ceil(line.length / strength_px * SAMPLES_PER_STRENGTH)), 16)
    even = shapely.get_coordinates(
        shapely.line_interpolate_point(line, np.arange(count) / count, normalized=True)
    )
    sigma = strength_px / line.length * count
    mean = gaussian_filter1d(even, sigma, axis=0, mode="wrap")
    twice = 2 * mean - gaussian_filter1d(mean, sigma, axis=0, mode="wrap")
    thin = shapely.simplify(shapely.Polygon(twice), THINNING * strength_px)
    vertices = shapely.get_coordinates(thin.exterior)[:-1]
    return _with_area(vertices, clockwise_area_px(ring))


def _with_area(ring: Floats, area_px: float) -> Floats:
    """Return the ring moved along its normals until it encloses an area, holes negative."""
    for _ in range(3):
        lacking = area_px - clockwise_area_px(ring)
        ring = ring + lacking / shapely.LinearRing(ring).length * normals(ring)
    return ring
