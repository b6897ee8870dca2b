"""A bright part of a frame's target, found by its brightness over the rest of the target."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter
from skimage.measure import label

from core.frame import Frame
from core.human_body import KNIFE
from core.silhouettes.cfar import detect
from core.silhouettes.contours import cleaned_mask, traced_rings
from core.silhouettes.edge import inward_distance_px
from core.silhouettes.extraction import SIMPLIFICATION_PX
from core.silhouettes.silhouette import Silhouette


@dataclass(frozen=True, slots=True, kw_only=True)
class BrightPartSettings:
    """How a bright part is told from the target that it is on.

    Attributes:
        smoothing_px: standard deviation over which power is averaged before it is looked for; half
            a resolution cell, that speckle does not pass for metal.
        censoring_factor: a₁ of eqs. 18 and 19, with the target as the background.
        detection_factor: a₂.
        edge_factor: of the background's mean; the part reaches as far as its own power, unsmoothed,
            exceeds that.
        closing_px: diameter of the disc that closes speckle gaps.
        smallest_part_px: what is smaller is speckle: 160 px of 5 mm are six resolution cells.
    """

    smoothing_px: float = 2.5
    censoring_factor: float = 3.0
    detection_factor: float = 5.0
    edge_factor: float = 3.0
    closing_px: int = 11
    smallest_part_px: int = 160

    @classmethod
    def at(cls, finer: float) -> "BrightPartSettings":
        """Return the usual settings for pixels so many times finer than 5 mm."""
        return cls(
            smoothing_px=2.5 * finer,
            closing_px=round(11 * finer),
            smallest_part_px=round(160 * finer**2),
        )


def bright_part(
    frame: Frame, whole: Silhouette, settings: BrightPartSettings | None = None
) -> Silhouette:
    """Return the outline of what is brighter than the rest of a target, empty if nothing is.

    The threshold is that of `detect` with the target's own amplitudes as the background: what
    metal is to skin, the target is to the receiver's noise. Of several bright parts the one with
    the most power is taken.

    Args:
        frame: the image.
        whole: the target's silhouette in it.
        settings: the usual unless given.
    """
    settings = settings or BrightPartSettings()
    body = whole.mask()
    nothing = replace(whole, rings=(), component=KNIFE, provenance="nothing brighter than the rest")
    if np.count_nonzero(body) < settings.smallest_part_px:
        return nothing
    smooth = np.sqrt(gaussian_filter(frame.amplitude**2, settings.smoothing_px))
    background = detect(
        smooth[body][None],
        censoring_factor=settings.censoring_factor,
        detection_factor=settings.detection_factor,
    )
    seeds = body & (smooth > background.threshold)
    edge = settings.edge_factor * background.background_mean
    found = replace(background, mask=frame.amplitude > edge, threshold=edge)
    mask = _brightest(frame, seeds, _closed(found.mask & _near(seeds, settings), settings))
    if not mask.any():
        return nothing
    return Silhouette(
        rings=traced_rings(
            inward_distance_px(mask, frame, found), 0.0, simplification_px=SIMPLIFICATION_PX
        ),
        image_shape=frame.shape,
        claim="lit side",
        component=KNIFE,
        provenance=f"brighter than the rest: CFAR a₂ = {settings.detection_factor:g} on the target",
    )


def _near(seeds: NDArray[np.bool_], settings: BrightPartSettings) -> NDArray[np.bool_]:
    reach: NDArray[np.bool_] = gaussian_filter(
        seeds.astype(np.float32), settings.closing_px / 2
    ) > (0.02)
    return reach


def _closed(mask: NDArray[np.bool_], settings: BrightPartSettings) -> NDArray[np.bool_]:
    return cleaned_mask(
        mask, closing_px=settings.closing_px, smallest_part_px=settings.smallest_part_px
    )


def _brightest(
    frame: Frame, seeds: NDArray[np.bool_], mask: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """Return the connected part that holds a seed and has the most power."""
    parts = label(mask, connectivity=2)
    power = np.bincount(parts.ravel(), weights=(frame.amplitude**2).ravel())
    seeded = np.bincount(parts.ravel(), weights=seeds.ravel()) > 0
    power[0] = 0
    if not np.any(power * seeded):
        return np.zeros_like(mask)
    chosen: NDArray[np.bool_] = parts == np.argmax(power * seeded)
    return chosen
