"""Silhouettes from photographs of an object before a dark background."""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray
from skimage.filters import threshold_otsu

from core.arrays import frozen
from core.frame import Frame
from core.silhouettes.contours import cleaned_mask, traced_rings
from core.silhouettes.silhouette import Silhouette

MIXTURE_PARAMETERS = 65
"""OpenCV's GrabCut keeps five Gaussians of a weight, a mean of 3 and a covariance of 3 × 3."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Photograph:
    """A frame of an optical sensor with its colours.

    Attributes:
        frame: brightness and camera.
        colours: (rows, columns, 3) uint8 red, green and blue; in shade they tell an object from
            what it stands on where brightness does not.
    """

    frame: Frame
    colours: NDArray[np.uint8]

    def __post_init__(self) -> None:
        if self.frame.sensor != "optical":
            raise ValueError(
                f'Frame "{self.frame.label}" comes from a {self.frame.sensor}; photographs only. '
                "Radar frames have extract_silhouette."
            )
        shape = (*self.frame.shape, 3)
        object.__setattr__(self, "colours", frozen(self.colours, np.uint8, shape, "Colours"))


@dataclass(frozen=True, slots=True, kw_only=True)
class PhotographSettings:
    """How silhouettes are taken from photographs.

    Attributes:
        gamma: exponent on the colours, each from 0 to 1, that GrabCut sees. Below 1 it stretches
            the dark side, so that more shade counts as object, and with still less the lit folds
            of a cloth too. Found by looking at outlines: at 1 sides that turn into shade are lost,
            at 0.5 cloth comes in.
        most_rounds: GrabCut rounds at the most.
        settled_fraction: rounds end when fewer pixels than this part of the object change side.
        margin_fraction: how far around the bright pixels the object is looked for, as a part of
            their bounding box's diagonal.
        smallest_part_px: parts (specks) and holes (pores in shade) of fewer pixels disappear;
            filling a true hole only leaves the hull a little larger, a false one cuts it.
    """

    gamma: float = 0.7
    most_rounds: int = 12
    settled_fraction: float = 3e-3
    margin_fraction: float = 0.1
    smallest_part_px: int = 60


def photograph_silhouette(
    photograph: Photograph, settings: PhotographSettings | None = None
) -> Silhouette:
    """Return the whole outline of a bright object before a dark background.

    One threshold does not do: the object's shaded sides are as dark as the lit parts of what it
    stands on. Otsu's threshold (1979) therefore only says which pixels are probably object, and
    GrabCut refines: colour models of both sides, learnt from the split, and a minimum cut that
    prefers to run along edges, in turns until the split settles. A large part in even shade, with
    no brightness between it and the lit side, can still go to the background: look at the
    outlines.

    Raises:
        ValueError: a photograph of one brightness throughout, or no object found.

    Source: Rother, Kolmogorov and Blake, "GrabCut", 2004, as in OpenCV.
    """
    settings = settings or PhotographSettings()
    frame = photograph.frame
    mask = cleaned_mask(
        object_mask(photograph, settings),
        closing_px=0,
        smallest_part_px=settings.smallest_part_px,
    )
    if not mask.any():
        raise ValueError(
            f'Found no object of at least {settings.smallest_part_px} pixels in "{frame.label}"; '
            "wanted a bright object before a dark background."
        )
    return Silhouette(
        rings=traced_rings(mask.astype(np.float32), 0.5),
        image_shape=frame.shape,
        claim="complete",
        provenance="Otsu's threshold refined by GrabCut",
    )


def threshold_silhouette(frame: Frame, level: float) -> Silhouette:
    """Return the outline of all that is brighter than `level`, which claims to be complete.

    It is what photographs are compared with: good only where nothing of the object is darker than
    anything around it.
    """
    return Silhouette(
        rings=traced_rings(frame.amplitude, level),
        image_shape=frame.shape,
        claim="complete",
        provenance=f"brighter than {level:g}",
    )


def object_mask(photograph: Photograph, settings: PhotographSettings) -> NDArray[np.bool_]:
    """Return the pixels (rows, columns) that GrabCut, started by Otsu, takes for the object.

    Raises:
        ValueError: a photograph of one brightness throughout, or with single bright pixels only.
    """
    frame = photograph.frame
    bright = _bright(frame, settings.gamma)
    window = _window(bright, frame.label, settings.margin_fraction)
    colours = 255 * (photograph.colours[window] / 255) ** settings.gamma
    mask = np.zeros(frame.shape, dtype=bool)
    mask[window] = _refined(np.round(colours).astype(np.uint8), bright[window], settings)
    return mask


def _bright(frame: Frame, gamma: float) -> NDArray[np.bool_]:
    """Return the pixels above Otsu's threshold on brightness to the power gamma."""
    least, most = float(frame.amplitude.min()), float(frame.amplitude.max())
    if least == most:
        raise ValueError(
            f'Every pixel of "{frame.label}" has the same brightness, {most:g}; there is no image.'
        )
    brightness = frame.amplitude**gamma
    bright: NDArray[np.bool_] = brightness > threshold_otsu(brightness)
    return bright


def _window(bright: NDArray[np.bool_], label: str, margin_fraction: float) -> tuple[slice, slice]:
    """Return the part of the picture around the bright pixels, single ones left out."""
    solid = cv2.morphologyEx(bright.astype(np.uint8), cv2.MORPH_OPEN, np.ones((3, 3), np.uint8))
    rows, columns = np.flatnonzero(solid.any(axis=1)), np.flatnonzero(solid.any(axis=0))
    if len(rows) == 0:
        raise ValueError(
            f'Only single bright pixels in "{label}", no object; wanted a bright object before a '
            "dark background."
        )
    margin = int(np.ceil(margin_fraction * np.hypot(np.ptp(rows), np.ptp(columns)))) + 1
    return (
        slice(max(int(rows[0]) - margin, 0), int(rows[-1]) + margin + 1),
        slice(max(int(columns[0]) - margin, 0), int(columns[-1]) + margin + 1),
    )


def _refined(
    colours: NDArray[np.uint8], bright: NDArray[np.bool_], settings: PhotographSettings
) -> NDArray[np.bool_]:
    """Return GrabCut's split of colours (rows, columns, 3) that starts from the bright pixels."""
    sides = np.where(bright, cv2.GC_PR_FGD, cv2.GC_PR_BGD).astype(np.uint8)
    models = np.zeros((2, 1, MIXTURE_PARAMETERS))
    cv2.setRNGSeed(0)  # GrabCut seeds its mixtures by random k-means; same picture, same outline
    mode = cv2.GC_INIT_WITH_MASK
    inside = bright
    for _ in range(settings.most_rounds):
        cv2.grabCut(colours, sides, None, models[0], models[1], 1, mode)
        before, inside, mode = inside, sides == cv2.GC_PR_FGD, cv2.GC_EVAL
        changed = np.count_nonzero(before != inside)
        if changed <= settings.settled_fraction * np.count_nonzero(inside):
            break
    return inside
