"""A frame's outline taken again with thresholds of its own."""

from dataclasses import replace

from core.frame import Frame
from core.silhouettes.editing.edited import edited
from core.silhouettes.extraction import ExtractionSettings, extract_silhouette
from core.silhouettes.silhouette import Silhouette


def rethresholded(silhouette: Silhouette, frame: Frame, settings: ExtractionSettings) -> Silhouette:
    """Return the silhouette that other settings find in the same frame.

    The component stays. What it claims is what extraction says, since nothing of the old outline
    is left; the provenance names the settings. It is the whole of an extraction, fast enough for
    a preview while a threshold is dragged.

    Args:
        silhouette: as it was.
        frame: the image it was drawn in.
        settings: a₁, a₂ and the closing for radar frames, the telescope's for optical ones.

    Raises:
        ValueError: another frame's silhouette, factors that are not 0 < a₁ ≤ a₂, a closing that
            is negative or wider than the image, or a frame without contrast.
    """
    if silhouette.image_shape != frame.shape:
        raise ValueError(
            f"The silhouette was drawn in an image of {silhouette.image_shape} pixels, frame "
            f'"{frame.label}" has {frame.shape}; re-threshold it in its own frame.'
        )
    if not 0 <= settings.closing_px <= min(frame.shape):
        raise ValueError(
            f"The closing must be 0 to {min(frame.shape)} pixels wide, the image's smaller side; "
            f"got {settings.closing_px}."
        )
    found = replace(extract_silhouette(frame, settings), component=silhouette.component)
    return edited(found, found.rings, "re-threshold")
