"""Region growing: all that hangs together with a seed and is not much darker."""

import numpy as np
from numpy.typing import NDArray
from skimage.morphology import remove_small_holes
from skimage.segmentation import flood

from core.arrays import Floats
from core.frame import Frame
from core.silhouettes.contours import traced_rings
from core.silhouettes.editing.levels import smoothed_db

SIMPLIFICATION_PX = 0.1
"""Rings lose the vertices that move them by less."""


def grown(
    frame: Frame,
    seed_px: tuple[float, float],
    tolerance_db: float,
    *,
    smoothing_px: float = 1.0,
    smallest_hole_px: int = 12,
    brighter_too: bool = True,
) -> tuple[Floats, ...]:
    """Return the rings around the region that grows from a seed, to be added to an outline.

    It holds the pixels that can be reached from the seed's, by steps to any of eight neighbours,
    over levels at most `tolerance_db` below the seed's (and, unless brighter ones count too, at
    most as far above). Its edge is traced between pixels, where the level is crossed.

    Args:
        frame: either sensor's.
        seed_px: (row, column) in the image.
        tolerance_db: how far the level may differ from the seed's.
        smoothing_px: standard deviation of the Gaussian that evens out speckle before.
        smallest_hole_px: holes of fewer pixels are filled.
        brighter_too: whether all that is brighter than the seed belongs to it: bright scatterers
            on a panel do, but a seed in a dark gap grows within the gap only without.

    Raises:
        ValueError: a seed outside the image, a tolerance that is not positive, a smoothing that
            is no width, or a dark frame.

    Source: scikit-image's flood fill.
    """
    if not (np.isfinite(tolerance_db) and tolerance_db > 0):
        raise ValueError(f"The tolerance must be positive decibels, got {tolerance_db}.")
    seed = _pixel(seed_px, frame.shape)
    level = smoothed_db(frame, smoothing_px)
    if brighter_too:
        level = np.minimum(level, level[seed])
    region = flood(level, seed, tolerance=tolerance_db, connectivity=2)
    margin_db = tolerance_db - np.abs(level - level[seed])
    filled = _without_pinholes(region, smallest_hole_px)
    # Outside the region every pixel must lie below, whatever else is as bright; within it above.
    signed = np.where(filled, np.maximum(margin_db, 1e-3), np.minimum(margin_db, -1e-3))
    return traced_rings(signed.astype(np.float32), 0.0, simplification_px=SIMPLIFICATION_PX)


def _pixel(seed_px: tuple[float, float], shape: tuple[int, int]) -> tuple[int, int]:
    place = np.asarray(seed_px, dtype=np.float64)
    if place.shape != (2,) or not np.all(np.isfinite(place)):
        raise ValueError(f"A seed is a (row, column), got {seed_px}.")
    row, column = (int(index) for index in np.floor(place + 0.5))
    if not (0 <= row < shape[0] and 0 <= column < shape[1]):
        raise ValueError(
            f"The seed ({place[0]:g}, {place[1]:g}) lies outside the image of {shape[0]} × "
            f"{shape[1]} pixels."
        )
    return row, column


def _without_pinholes(region: NDArray[np.bool_], smallest_px: int) -> NDArray[np.bool_]:
    if smallest_px <= 1:
        return region
    filled: NDArray[np.bool_] = remove_small_holes(region, max_size=smallest_px - 1, connectivity=1)
    return filled
