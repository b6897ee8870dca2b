"""Keeping a vote volume in step with what its frames say."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.geometry.projection import Projection
from core.hull.view import View
from core.hull.volume import VoteVolume
from core.silhouettes.silhouette import Silhouette

NO_VIEW = View(
    silhouette=Silhouette(rings=(), image_shape=(2, 2), claim="complete"),
    projection=Projection(matrix=np.eye(2, 4)),
)
"""Keeps the place of a frame that has nothing to say, so that views stay in the frames' order."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Place:
    """A frame's place in a volume.

    Attributes:
        view: how it votes.
        votes: whether it does.
    """

    view: View
    votes: bool

    @classmethod
    def of(cls, view: View | None, *, is_excluded: bool = False) -> "Place":
        """Return the place of a frame with a view, or without one."""
        return cls(view=view or NO_VIEW, votes=view is not None and not is_excluded)


def bring_in_step(volume: VoteVolume, places: Sequence[Place], threshold: int | None) -> None:
    """Make a volume hold the views of `places`, the number of each its position.

    Only what differs from what the volume holds is swept; the volume has no more views than there
    are places.

    Raises:
        ValueError: an outline without area, or a camera that stands in the grid; all that came
            before it in the order of places is in step.
    """
    with volume.reading():
        held = volume.voters
        kept = places[: len(held)]
        if any(held[number].votes and not place.votes for number, place in enumerate(kept)):
            volume.threshold = None  # it may not exceed the number of views, which shrinks
        for number, place in enumerate(kept):
            if held[number].view is not place.view:
                volume.replace(number, place.view)
            if held[number].votes != place.votes:
                (volume.include if place.votes else volume.exclude)(number)
        _add(volume, places[len(held) :])
        if volume.threshold != threshold:
            volume.threshold = threshold


def _add(volume: VoteVolume, places: Sequence[Place]) -> None:
    if not places:
        return
    numbers = volume.add_many([place.view for place in places])
    for number, place in zip(numbers, places, strict=True):
        if not place.votes:
            volume.threshold = None
            volume.exclude(number)
