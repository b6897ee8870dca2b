"""Where the target ends: taking the point spread's share out of a detected edge.

A threshold far below the target's brightness is crossed outside the target, where the image is
only the skirt of the point response. How far outside follows from the ratio of the threshold to
the brightness inside, through the edge spread of the imaging window.
"""

from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt, gaussian_filter

from core.arrays import Floats
from core.frame import Frame
from core.radar.window import HAMMING, Window, window_named
from core.silhouettes.cfar import Detection

NEIGHBOURHOOD_CELLS = 2.5
"""Standard deviation, in Rayleigh cells, of the neighbourhood whose brightness counts as inside:
some twenty independent speckles, still narrower than a solar panel."""

MARGIN_PX = 32
"""What lies further than this from the target's pixels is not looked at."""

Image = NDArray[np.float32]


def inward_distance_px(mask: NDArray[np.bool_], frame: Frame, detection: Detection) -> Image:
    """Return how far inside the target's true edge every pixel lies, in mean pixels.

    Positive inside; the zero level is the outline. It is the distance to the edge of the
    detected mask less that edge's displacement by the point spread. Frames whose resolution is
    unknown keep the edge where the threshold put it.

    Args:
        mask: (rows, columns) cleaned detection.
        frame: the image with its resolution.
        detection: threshold and background of the same image.
    """
    level: Image = np.full(mask.shape, -float(MARGIN_PX), dtype=np.float32)
    if not mask.any():
        return level
    box = _box_with_margin(mask)
    window = window_named(frame.window)
    cell_px = _rayleigh_cell_px(frame, window)
    detected = detection.mask[box]
    signed, nearest = _signed_distance_px(mask[box], cell_px or (1.0, 1.0))
    if cell_px is not None:
        brightness = inner_power(frame.amplitude[box], detected, cell_px)
        displacement = edge_displacement_cells(brightness, detection, window)
        signed -= (displacement * np.sqrt(cell_px[0] * cell_px[1]))[nearest[0], nearest[1]]
    level[box] = signed
    return level


def inner_power(
    amplitude: NDArray[np.float32], detected: NDArray[np.bool_], cell_px: tuple[float, float]
) -> Floats:
    """Return the mean power inside the target around every pixel, (rows, columns).

    It is the power-weighted mean power of the neighbourhood's detected pixels, in which the dark
    skirt hardly counts; exponential speckle makes it twice the mean, so it is halved.

    Args:
        amplitude: (rows, columns).
        detected: (rows, columns) pixels above the threshold.
        cell_px: Rayleigh cell in (rows, columns).
    """
    power = np.where(detected, amplitude, 0.0).astype(np.float64) ** 2
    width = [NEIGHBOURHOOD_CELLS * cell for cell in cell_px]
    total = np.maximum(gaussian_filter(power, width), np.finfo(float).tiny)
    brightness: Floats = 0.5 * gaussian_filter(power * power, width) / total
    return brightness


def edge_displacement_cells(
    inner: Floats, detection: Detection, window: Window = HAMMING
) -> Floats:
    """Return by how many Rayleigh cells the threshold is crossed outside an edge.

    Args:
        inner: mean power inside the target, any shape.
        detection: its threshold and background.
        window: of the image.
    """
    # Rayleigh amplitudes: mean power is 4/π of the squared mean amplitude.
    noise_power = 4 / np.pi * detection.background_mean**2
    skirt = max(detection.threshold**2 - noise_power, 0.0)
    # No edge is crossed further inside than at half its power.
    ratio = skirt / np.maximum(inner, max(2 * skirt, np.finfo(float).tiny))
    distance, spread = edge_spread(window)
    displacement: Floats = np.interp(-np.maximum(ratio, spread[-1]), -spread, distance)
    return displacement


@cache
def edge_spread(window: Window = HAMMING) -> tuple[Floats, Floats]:
    """Return (distances in Rayleigh cells, mean power there relative to inside) at a straight edge.

    A bright half-plane of independent scatterers has half its inner power at its edge and falls
    with the integral of the point response's power; the table ends at the first null.
    """
    place = np.linspace(-8.0, 8.0, 32001)
    share = np.cumsum(window.point_response(place) ** 2)
    spread = 1 - share / share[-1]
    skirt = (place >= 0) & (place <= window.first_null_cells)
    return place[skirt], spread[skirt]


def _rayleigh_cell_px(frame: Frame, window: Window) -> tuple[float, float] | None:
    known = (
        frame.row_resolution_m,
        frame.column_resolution_m,
        frame.row_spacing_m,
        frame.column_spacing_m,
    )
    row_m, column_m, row_step_m, column_step_m = known
    if row_m is None or column_m is None or row_step_m is None or column_step_m is None:
        return None
    return (
        row_m / window.half_power_width_cells / row_step_m,
        column_m / window.half_power_width_cells / column_step_m,
    )


def _box_with_margin(mask: NDArray[np.bool_]) -> tuple[slice, slice]:
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    return (
        slice(max(int(rows[0]) - MARGIN_PX, 0), int(rows[-1]) + 1 + MARGIN_PX),
        slice(max(int(columns[0]) - MARGIN_PX, 0), int(columns[-1]) + 1 + MARGIN_PX),
    )


def _signed_distance_px(
    mask: NDArray[np.bool_], cell_px: tuple[float, float]
) -> tuple[Floats, NDArray[np.intp]]:
    """Return the distance into a mask, negative outside, and (2, …) the nearest outer pixel."""
    sampling = (1 / cell_px[0], 1 / cell_px[1])
    scale = np.sqrt(cell_px[0] * cell_px[1])
    # What lies past the image's edge is not target, or one that fills the image had no edge.
    framed = np.pad(mask, 1)
    depth, nearest = distance_transform_edt(framed, sampling=sampling, return_indices=True)
    outside = distance_transform_edt(~framed, sampling=sampling)
    # Pixels of the mask stand half a pixel from its edge.
    signed = np.where(framed, depth * scale - 0.5, 0.5 - outside * scale)[1:-1, 1:-1]
    last = np.array(mask.shape).reshape(2, 1, 1) - 1
    return signed, np.clip(nearest[:, 1:-1, 1:-1] - 1, 0, last)
