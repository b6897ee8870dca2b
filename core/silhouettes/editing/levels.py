"""What the tools that follow the image see of a frame."""

import cv2
import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.frame import Frame

FLOOR_DB = -200.0
"""Level of a pixel without any power, relative to the frame's peak."""

BRIGHT_PERCENTILE = 99.5
"""Above it a picture is white: a few glints must not leave the rest of it black."""

_SIGMA_OF_MEDIAN = 1.4826
"""Standard deviation of a normal distribution over its median absolute deviation."""


def intensity(frame: Frame, smoothing_px: float) -> Floats:
    """Return the smoothed intensity of a frame, (rows, columns) from 0 to 1.

    It is power for radar and brightness for optical frames: what adds up, so that a symmetric
    point spread leaves an edge steepest where it is.

    Args:
        frame: either sensor's.
        smoothing_px: standard deviation of the Gaussian that evens out speckle; 0 for none.

    Raises:
        ValueError: a smoothing that is not a width, or a frame without any signal.
    """
    if not (np.isfinite(smoothing_px) and smoothing_px >= 0):
        raise ValueError(f"Smoothing must be a width in pixels, 0 for none; got {smoothing_px}.")
    peak = float(frame.amplitude.max())
    if peak == 0:
        raise ValueError(f'Frame "{frame.label}" is dark throughout; there is no image.')
    relative = frame.amplitude.astype(np.float64) / peak
    level = relative**2 if frame.sensor == "radar" else relative
    if smoothing_px > 0:
        level = cv2.GaussianBlur(level, (0, 0), smoothing_px, borderType=cv2.BORDER_REPLICATE)
    smoothed: Floats = level
    return smoothed


def smoothed_db(frame: Frame, smoothing_px: float) -> Floats:
    """Return the smoothed level of a frame in dB relative to its peak, (rows, columns).

    Power is smoothed before the logarithm is taken, so that speckle's nulls do not count for
    more than its peaks.

    Raises:
        ValueError: as `intensity`.
    """
    decades = 10 if frame.sensor == "radar" else 20
    level: Floats = decades * np.log10(
        np.maximum(intensity(frame, smoothing_px), 10 ** (FLOOR_DB / decades))
    )
    return level


def grey_picture(frame: Frame, smoothing_px: float) -> NDArray[np.uint8]:
    """Return a frame as a picture of 256 greys in which faint and bright parts both show.

    Radar frames are in dB from their background's median to their bright end. Optical ones go
    through the inverse hyperbolic sine with its knee at five of the sky's standard deviations.

    Raises:
        ValueError: as `intensity`.

    Source: Lupton, Gunn and Szalay, "A modified magnitude system", 1999, for the stretch.
    """
    if frame.sensor == "radar":
        level = smoothed_db(frame, smoothing_px)
        dark = float(np.median(level))
    else:
        bright = intensity(frame, smoothing_px)
        sky = float(np.median(bright))
        sigma = _SIGMA_OF_MEDIAN * float(np.median(np.abs(bright - sky)))
        level = np.arcsinh((bright - sky) / (5 * max(sigma, 1e-3)))
        dark = 0.0
    light = max(float(np.percentile(level, BRIGHT_PERCENTILE)), dark + 1e-9)
    if light <= dark + 1e-9:
        light = max(float(level.max()), dark + 1e-9)
    grey = np.clip((level - dark) / (light - dark), 0, 1)
    return np.round(255 * grey).astype(np.uint8)
