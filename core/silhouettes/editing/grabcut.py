"""GrabCut: an optical frame split anew into target and sky, starting from the outline."""

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt

from core.arrays import Floats, frozen
from core.frame import Frame
from core.silhouettes.contours import cleaned_mask, traced_rings
from core.silhouettes.editing.levels import grey_picture
from core.silhouettes.photograph import MIXTURE_PARAMETERS
from core.silhouettes.silhouette import Silhouette

ROUNDS = 5
"""Of learning both sides' colours and cutting; the split hardly moves after the third."""


def grab_cut(
    rings: tuple[Floats, ...],
    frame: Frame,
    *,
    margin_px: float = 8.0,
    colours: NDArray[np.uint8] | None = None,
    smallest_part_px: int = 20,
) -> tuple[Floats, ...]:
    """Return the outline that GrabCut finds within a margin of the given one.

    What lies further inside than the margin stays target, what lies further outside stays sky;
    between them colour and edges decide. The new edge runs midway between pixels.

    Args:
        rings: each (vertices, 2) as (row, column); roughly right is enough.
        frame: optical.
        margin_px: how far the outline may move.
        colours: (rows, columns, 3) uint8 of the frame where it has any; its stretched brightness
            otherwise.
        smallest_part_px: parts and holes of fewer pixels disappear.

    Raises:
        ValueError: a radar frame, whose speckle no colour model fits; no outline to start from,
            or one without any sky around it; a margin that is not positive; a dark frame.

    Source: Rother, Kolmogorov and Blake, "GrabCut", 2004, as in OpenCV.
    """
    if frame.sensor != "optical":
        raise ValueError(
            f'Frame "{frame.label}" comes from a {frame.sensor}; GrabCut is for optical frames. '
            "Grow a region or re-threshold instead."
        )
    if not (np.isfinite(margin_px) and margin_px > 0):
        raise ValueError(f"GrabCut's margin must be positive pixels, got {margin_px}.")
    picture = _picture(frame, colours)
    seed = Silhouette(rings=rings, image_shape=frame.shape, claim="complete").mask()
    if not seed.any() or seed.all():
        raise ValueError(
            "GrabCut starts from an outline with target inside and sky outside; this one holds "
            f"{np.count_nonzero(seed)} of {seed.size} pixels. Draw one roughly around the target."
        )
    split = _split(picture, _sides(seed, margin_px))
    split = cleaned_mask(split, closing_px=0, smallest_part_px=smallest_part_px)
    return traced_rings(split.astype(np.float32), 0.5)


def _picture(frame: Frame, colours: NDArray[np.uint8] | None) -> NDArray[np.uint8]:
    if colours is None:
        return np.repeat(grey_picture(frame, 0.0)[..., None], 3, axis=2)
    return frozen(colours, np.uint8, (*frame.shape, 3), "Colours")


def _sides(seed: NDArray[np.bool_], margin_px: float) -> NDArray[np.uint8]:
    """Return OpenCV's certain and probable sides of each pixel."""
    depth, height = distance_transform_edt(seed), distance_transform_edt(~seed)
    sides = np.where(seed, cv2.GC_PR_FGD, cv2.GC_PR_BGD)
    sides = np.where(depth > margin_px, cv2.GC_FGD, sides)
    return np.where(height > margin_px, cv2.GC_BGD, sides).astype(np.uint8)


def _split(picture: NDArray[np.uint8], sides: NDArray[np.uint8]) -> NDArray[np.bool_]:
    models = np.zeros((2, 1, MIXTURE_PARAMETERS))
    cv2.setRNGSeed(0)  # its mixtures start from random k-means; same outline, same answer
    cv2.grabCut(picture, sides, None, models[0], models[1], ROUNDS, cv2.GC_INIT_WITH_MASK)
    split: NDArray[np.bool_] = (sides == cv2.GC_PR_FGD) | (sides == cv2.GC_FGD)
    return split
