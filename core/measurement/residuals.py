"""Residuals of a hull: which frame takes from it alone, and whose outline it leaves open.

Two faults of an outline look alike at first. One that is too small takes from the hull what every
other frame leaves: it causes. One that is too large, or whose target another frame has cut, claims
what the hull no longer fills: it suffers. A frame may do both at different places of its outline.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from core.frame import Frame
from core.hull.blame import gained_without_m3
from core.hull.casting import UNWATCHED, Cancelled, Watch
from core.hull.closed_mesh import Surface
from core.hull.reprojection import uncovered_area_px
from core.hull.votes import VoteCounts
from core.silhouettes.silhouette import Silhouette


@dataclass(frozen=True, slots=True, kw_only=True)
class Residual:
    """How a frame and the hull disagree.

    Attributes:
        number: of the frame, from 1.
        causes_m3: by how much the hull would grow without this frame; 0 where it does not vote.
        suffers_m2: area of its outline, as drawn, that the hull's image leaves open; None where a
            pixel has no size, as in perspective.
        outline_m2: area of its outline; None likewise.
    """

    number: int
    causes_m3: float
    suffers_m2: float | None
    outline_m2: float | None


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Outlined:
    """A frame with the outline that was drawn in it.

    Attributes:
        frame: with its projection as it votes.
        silhouette: the committed outline, not filled by any carving rule.
    """

    frame: Frame
    silhouette: Silhouette


def hull_residuals(
    volume: VoteCounts,
    surface: Surface,
    outlines: Sequence[Outlined],
    watch: Watch = UNWATCHED,
) -> tuple[Residual, ...]:
    """Return the residual of each frame with a hull.

    Of an outline that claims the lit side only, just that side is compared: the hull may well be
    larger.

    Args:
        volume: whose view n − 1 is frame n's.
        surface: of its hull.
        outlines: of the frames in the order of their numbers.
        watch: is told the frames done, and may cancel.

    Raises:
        Cancelled: `watch` said so, or the volume changed meanwhile.
    """
    gained_m3 = gained_without_m3(volume, Watch(cancel=watch.cancel))
    residuals = []
    for number, outlined in enumerate(outlines, start=1):
        if watch.cancel():
            raise Cancelled(f"Cancelled after {number - 1} of {len(outlines)} frames.")
        residuals.append(_residual(number, gained_m3.get(number - 1, 0.0), surface, outlined))
        watch.progress(number, len(outlines))
    return tuple(residuals)


def _residual(number: int, causes_m3: float, surface: Surface, outlined: Outlined) -> Residual:
    frame, silhouette = outlined.frame, outlined.silhouette
    suffers_m2 = outline_m2 = None
    if frame.row_spacing_m is not None and frame.column_spacing_m is not None:
        pixel_m2 = frame.row_spacing_m * frame.column_spacing_m
        suffers_m2 = pixel_m2 * uncovered_area_px(surface, frame.projection, silhouette)
        outline_m2 = pixel_m2 * silhouette.area_px()
    return Residual(
        number=number, causes_m3=causes_m3, suffers_m2=suffers_m2, outline_m2=outline_m2
    )
