"""Silhouettes from telescope frames: a sunlit body before a black sky.

What the sun does not reach is as black as the sky, be it turned away or shaded by another part.
Such an outline shows the sunlit side only, and says so where the frame tells where the sun is;
`core.hull.sunlight` carves with it what it does show. Earthshine is a hundredth of sunlight or
less and seldom seen beside the lit side's wings.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy import fft
from scipy.ndimage import (
    binary_dilation,
    binary_erosion,
    distance_transform_cdt,
    gaussian_filter,
    maximum_filter,
)

from core.arrays import Floats
from core.frame import Frame
from core.optical.camera import pixel_size_m
from core.optical.telescope import AIRY_FWHM, Telescope
from core.silhouettes.contours import cleaned_mask, traced_rings
from core.silhouettes.photograph import Photograph, PhotographSettings, object_mask
from core.silhouettes.silhouette import Silhouette

NEIGHBOURHOOD_PX = 2.0
"""Standard deviation of the neighbourhood whose brightness counts as inside."""

DEEP_PX = 4
"""Pixels this deep inside are free of the edge's blur."""

BAND_PX = 2
"""How far from GrabCut's edge, which runs between pixels, the true one is looked for."""

SIMPLIFICATION_PX = 0.1
"""Rings lose the vertices that move them by less, a third of the edge's error."""

WINGS_SHARE, WINGS_PX = 0.03, 10
"""Within so many pixels of a bright part, what is darker than this share of it may be its wings."""

_SIGMA_OF_MEDIAN = 1.4826
"""Standard deviation of a normal distribution over its median absolute deviation."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TelescopeSettings:
    """How silhouettes are taken from telescope frames.

    Attributes:
        detection_sigmas: pixels this many of the sky's standard deviations above it are seen.
        knee_sigmas: brightness in these units goes through the inverse hyperbolic sine before it
            is split, so that a glint and a dull panel weigh as much as each other.
        smallest_part_px: parts and holes of fewer pixels disappear.
        removes_wings: whether the aperture's faint wide wings are reshaped into a compact point
            response first; needs a frame that states its resolution.
    """

    detection_sigmas: float = 6.0
    knee_sigmas: float = 5.0
    smallest_part_px: int = 20
    removes_wings: bool = True


def telescope_silhouette(frame: Frame, settings: TelescopeSettings | None = None) -> Silhouette:
    """Return the outline of what a telescope frame shows, empty where that is nothing.

    Otsu's threshold on the stretched brightness starts GrabCut, as for photographs; dim parts
    that stand clear of the bright ones' wings are added, the whole is cleaned, and its edge moved
    to where the brightness is half of that just inside, which is where a symmetric point spread
    leaves a step. It claims the lit side only where the frame says where the sun is, and to be
    complete otherwise.

    Raises:
        ValueError: a frame of one brightness throughout.

    Source: Lupton, Gunn and Szalay, "A modified magnitude system", 1999, for the stretch.
    """
    settings = settings or TelescopeSettings()
    signal, sigma = _above_the_sky(frame, settings)
    mask = _mask(frame, signal, sigma, settings)
    rings: tuple[Floats, ...] = ()
    if mask.any():
        level = _level(signal, mask, sigma)
        rings = traced_rings(level, 0.0, simplification_px=SIMPLIFICATION_PX)
    return Silhouette(
        rings=rings,
        image_shape=frame.shape,
        claim="complete" if frame.sun_direction is None else "lit side",
        provenance="Otsu's threshold refined by GrabCut, edge at half brightness",
    )


def without_wings(image: Floats, cutoff_per_pixel: float) -> Floats:
    """Return an image (rows, columns) with the aperture's point spread made compact.

    The transfer of a round aperture falls with a corner at both ends, which is what gives a point
    wings that fall as slowly as 1/r³; it is replaced by the smooth (1 + cos πρ) / 2 of the same
    cutoff. Where the old transfer vanishes so does the new one, and faster: noise does not grow.

    Args:
        image: brightness above the sky.
        cutoff_per_pixel: highest frequency that the aperture lets through, cycles per pixel.
    """
    pad = [fft.next_fast_len(size + 64, real=True) for size in image.shape]
    frequency = np.hypot(fft.fftfreq(pad[0])[:, None], fft.rfftfreq(pad[1])[None])
    share = np.minimum(frequency / cutoff_per_pixel, 1.0)
    aperture = Telescope(aperture_m=1.0, wavelength_m=1.0).transfer(share)
    passed = aperture > 1e-6
    ratio = np.where(passed, 0.5 * (1 + np.cos(np.pi * share)) / np.where(passed, aperture, 1), 0)
    compact: Floats = fft.irfft2(fft.rfft2(image, pad) * ratio, pad)
    return compact[: image.shape[0], : image.shape[1]]


def _above_the_sky(frame: Frame, settings: TelescopeSettings) -> tuple[Floats, float]:
    """Return the brightness above the sky (rows, columns) and the sky's standard deviation."""
    image = frame.amplitude.astype(np.float64)
    if image.min() == image.max():
        raise ValueError(
            f'Every pixel of "{frame.label}" has the same brightness, {image.min():g}; there is '
            "no image."
        )
    image = image - np.median(_border(image))
    if settings.removes_wings and frame.row_resolution_m is not None:
        diffraction_px = frame.row_resolution_m / AIRY_FWHM / pixel_size_m(frame.projection)
        image = without_wings(image, 1 / diffraction_px)
    border = _border(image)
    sky = float(np.median(border))
    sigma = _SIGMA_OF_MEDIAN * float(np.median(np.abs(border - sky)))
    return image - sky, max(sigma, 1e-6 * float(image.max()))


def _border(image: Floats) -> Floats:
    """Return the pixels of the outer eighth of an image, where there should be sky only."""
    rows, columns = (max(1, size // 16) for size in image.shape)
    inner = np.zeros(image.shape, dtype=bool)
    inner[rows:-rows, columns:-columns] = True
    border: Floats = image[~inner]
    return border


def _mask(
    frame: Frame, signal: Floats, sigma: float, settings: TelescopeSettings
) -> NDArray[np.bool_]:
    seen = signal > settings.detection_sigmas * sigma
    seen = cleaned_mask(seen, closing_px=0, smallest_part_px=settings.smallest_part_px)
    if not seen.any():
        return seen
    stretched = np.arcsinh(np.maximum(signal, 0) / (settings.knee_sigmas * sigma))
    stretched /= stretched.max()
    grey = np.round(255 * stretched).astype(np.uint8)
    photograph = Photograph(
        frame=replace(frame, amplitude=stretched), colours=np.repeat(grey[..., None], 3, axis=2)
    )
    try:
        split = object_mask(photograph, PhotographSettings(gamma=1.0))
    except ValueError:  # nothing is three pixels wide, such as a body edge-on; what is seen stays
        split = seen
    # GrabCut gives a panel at grazing light to the sky; what is seen and no wing is target too.
    clear = signal > WINGS_SHARE * maximum_filter(signal, 2 * WINGS_PX + 1)
    return cleaned_mask(
        seen & (split | clear), closing_px=0, smallest_part_px=settings.smallest_part_px
    )


def _level(signal: Floats, mask: NDArray[np.bool_], sigma: float) -> NDArray[np.float32]:
    """Return a level (rows, columns) whose zero is the outline: brightness over half of inside.

    Inside is the mean of the mask's pixels near by, each weighted by the fourth power of its
    depth, so that the dim edge counts only where a part is so thin that it is all there is.
    """
    weight = np.minimum(distance_transform_cdt(mask, metric="chessboard"), DEEP_PX) ** 4.0
    total = gaussian_filter(weight, NEIGHBOURHOOD_PX)
    inside = gaussian_filter(weight * signal, NEIGHBOURHOOD_PX) / np.maximum(total, 1e-9)
    level = np.clip(signal / np.maximum(inside, sigma) - 0.5, -0.5, 0.5)
    core = binary_erosion(mask, iterations=BAND_PX, border_value=1)
    near = binary_dilation(mask, iterations=BAND_PX)
    level = np.where(core, 0.5, np.where(near, level, -0.5))
    return level.astype(np.float32)
