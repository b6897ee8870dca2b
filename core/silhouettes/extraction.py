"""From a frame to the target's silhouette: detection, cleaning, tracing."""

from dataclasses import dataclass

import numpy as np

from core.frame import Frame
from core.silhouettes.cfar import detect
from core.silhouettes.contours import cleaned_mask, traced_rings
from core.silhouettes.silhouette import Silhouette


@dataclass(frozen=True, slots=True, kw_only=True)
class ExtractionSettings:
    """How silhouettes are taken from radar frames.

    Attributes:
        censoring_factor: a₁ of eqs. 18 and 19.
        detection_factor: a₂ of eqs. 18 and 19.
        closing_px: diameter of the disc that closes speckle gaps.
        smallest_part_px: parts and holes of fewer pixels disappear.
    """

    censoring_factor: float = 3.0
    detection_factor: float = 5.0
    closing_px: int = 9
    smallest_part_px: int = 60


def extract_silhouette(frame: Frame, settings: ExtractionSettings | None = None) -> Silhouette:
    """Return the silhouette that a radar frame shows, which is the lit side only.

    Raises:
        ValueError: a frame without contrast.
    """
    settings = settings or ExtractionSettings()
    detection = detect(
        frame.amplitude,
        censoring_factor=settings.censoring_factor,
        detection_factor=settings.detection_factor,
    )
    mask = cleaned_mask(
        detection.mask,
        closing_px=settings.closing_px,
        smallest_part_px=settings.smallest_part_px,
    )
    return Silhouette(
        rings=traced_rings(mask.astype(np.float32), 0.5),
        image_shape=frame.shape,
        claim="lit side",
        provenance=(
            f"CFAR a₁ = {settings.censoring_factor:g}, a₂ = {settings.detection_factor:g}, "
            f"closing {settings.closing_px} px"
        ),
    )
