"""From a frame to the target's silhouette: detection, cleaning, tracing."""

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from core.frame import Frame
from core.radar.window import HAMMING, window_named
from core.silhouettes.cfar import detect
from core.silhouettes.contours import cleaned_mask, traced_rings
from core.silhouettes.edge import inward_distance_px
from core.silhouettes.silhouette import Silhouette
from core.silhouettes.telescope import TelescopeSettings, telescope_silhouette

SIMPLIFICATION_PX = 0.15
"""Rings lose the vertices that move them by less: a twentieth of a resolution cell (IoU moves by
less than 0.001), and a third of the vertices is left."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ExtractionSettings:
    """How silhouettes are taken from frames.

    Attributes:
        censoring_factor: a₁ of eqs. 18 and 19.
        detection_factor: a₂ of eqs. 18 and 19.
        closing_px: diameter of the disc that closes speckle gaps.
        smallest_part_px: parts and holes of fewer pixels disappear.
        sidelobe_level_db: pixels this far below the brightest of their row or column may be its
            sidelobes (−43 dB for the Hamming window, some 4 dB more where several add up) and
            are not taken for target. It is meant for Hamming; for a frame of another window it
            moves with that window's highest sidelobe.
        corrects_edge: whether the point spread's share of the edge is taken out.
        telescope: how they are taken from optical frames, for which the others mean nothing.
    """

    censoring_factor: float = 3.0
    detection_factor: float = 5.0
    closing_px: int = 5
    smallest_part_px: int = 60
    sidelobe_level_db: float = -39.0
    corrects_edge: bool = True
    telescope: TelescopeSettings = field(default_factory=TelescopeSettings)


def extract_silhouette(frame: Frame, settings: ExtractionSettings | None = None) -> Silhouette:
    """Return the silhouette that a frame shows: the lit side only, of a radar frame.

    Optical frames go to `telescope_silhouette`.

    Raises:
        ValueError: a frame without contrast.
    """
    settings = settings or ExtractionSettings()
    if frame.sensor == "optical":
        return telescope_silhouette(frame, settings.telescope)
    detection = detect(
        frame.amplitude,
        censoring_factor=settings.censoring_factor,
        detection_factor=settings.detection_factor,
    )
    sidelobes_db = window_named(frame.window).highest_sidelobe_db - HAMMING.highest_sidelobe_db
    above_sidelobes = frame.amplitude > sidelobe_ceiling(
        frame.amplitude, settings.sidelobe_level_db + sidelobes_db
    )
    detection = replace(detection, mask=detection.mask & above_sidelobes)
    mask = cleaned_mask(
        detection.mask,
        closing_px=settings.closing_px,
        smallest_part_px=settings.smallest_part_px,
    )
    if settings.corrects_edge:
        rings = traced_rings(
            inward_distance_px(mask, frame, detection),
            0.0,
            simplification_px=SIMPLIFICATION_PX,
        )
    else:
        rings = traced_rings(mask.astype(np.float32), 0.5)
    return Silhouette(
        rings=rings,
        image_shape=frame.shape,
        claim="lit side",
        provenance=(
            f"CFAR a₁ = {settings.censoring_factor:g}, a₂ = {settings.detection_factor:g}, "
            f"closing {settings.closing_px} px"
            + (", point spread taken out" if settings.corrects_edge else "")
        ),
    )


def sidelobe_ceiling(amplitude: NDArray[np.float32], level_db: float) -> NDArray[np.float32]:
    """Return the amplitude that sidelobes of the same row and column may reach, (rows, columns).

    A window applied along both axes leaves its sidelobes on the row and the column of a bright
    point.
    """
    brightest = np.maximum(amplitude.max(axis=0)[None, :], amplitude.max(axis=1)[:, None])
    ceiling: NDArray[np.float32] = brightest * np.float32(10 ** (level_db / 20))
    return ceiling
