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
from core.radar.window import FIRST_NULL_CELLS, HALF_POWER_WIDTH_CELLS, point_response
from core.silhouettes.cfar import Detection

NEIGHBOURHOOD_CELLS = 2.5
"""Standard deviation, in Rayleigh cells, of the neighbourhood whose brightness counts as inside:
some twenty independent speckles, still narrower than a solar panel."""

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
    cell_px = _rayleigh_cell_px(frame)
    sampling = (1.0, 1.0) if cell_px is None else (1 / cell_px[0], 1 / cell_px[1])
    mean_cell_px = 1.0 if cell_px is None else float(np.sqrt(cell_px[0] * cell_px[1]))
    inside = distance_transform_edt(mask, sampling=sampling, return_indices=True)
    depth, nearest = inside[0] * mean_cell_px, inside[1]
    outside = distance_transform_edt(~mask, sampling=sampling) * mean_cell_px
    # Pixels of the mask stand half a pixel from its edge.
    signed = np.where(mask, depth - 0.5, 0.5 - outside)
    if cell_px is not None:
        displacement = edge_displacement_cells(frame, detection, cell_px) * mean_cell_px
        signed -= displacement[nearest[0], nearest[1]]
    level: Image = signed.astype(np.float32)
    return level


def edge_displacement_cells(
    frame: Frame, detection: Detection, cell_px: tuple[float, float]
) -> Floats:
    """Return by how many Rayleigh cells the threshold is crossed outside an edge, per pixel.

    The brightness inside is the power-weighted mean power of the neighbourhood, in which the
    dark skirt hardly counts; exponential speckle makes it twice the mean, so it is halved.

    Args:
        frame: the image.
        detection: its threshold, background and detected pixels.
        cell_px: Rayleigh cell in (rows, columns).
    """
    power = frame.amplitude.astype(np.float64) ** 2
    width = [NEIGHBOURHOOD_CELLS * cell for cell in cell_px]
    weighted = gaussian_filter(power * power * detection.mask, width)
    total = gaussian_filter(power * detection.mask, width)
    brightness = 0.5 * weighted / np.maximum(total, np.finfo(float).tiny)
    # Rayleigh amplitudes: mean power is 4/π of the squared mean amplitude.
    noise_power = 4 / np.pi * detection.background_mean**2
    skirt = max(detection.threshold**2 - noise_power, 0.0)
    ratio = skirt / np.maximum(brightness, np.finfo(float).tiny)
    distance, spread = edge_spread()
    displacement: Floats = np.interp(-np.clip(ratio, spread[-1], 0.5), -spread, distance)
    return displacement


@cache
def edge_spread() -> tuple[Floats, Floats]:
    """Return (distances in Rayleigh cells, mean power there relative to inside) at a straight edge.

    A bright half-plane of independent scatterers has half its inner power at its edge and falls
    with the integral of the point response's power; the table ends at the first null.
    """
    place = np.linspace(-8.0, 8.0, 32001)
    share = np.cumsum(point_response(place) ** 2)
    spread = 1 - share / share[-1]
    skirt = (place >= 0) & (place <= FIRST_NULL_CELLS)
    return place[skirt], spread[skirt]


def _rayleigh_cell_px(frame: Frame) -> tuple[float, float] | None:
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
        row_m / HALF_POWER_WIDTH_CELLS / row_step_m,
        column_m / HALF_POWER_WIDTH_CELLS / column_step_m,
    )
