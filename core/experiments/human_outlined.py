"""A person's frames with outlines of body and knife, and how these vote."""

from collections.abc import Sequence
from dataclasses import dataclass

from core.experiments.human_scene import curved_view
from core.frame import Frame
from core.hull.distance_hull import CurvedView
from core.hull.shadow import CarvingRule, carving_view
from core.hull.view import View
from core.silhouettes.silhouette import Silhouette


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Outlined:
    """Frames with the silhouettes of the whole and of the knife, empty where it is not seen."""

    frames: Sequence[Frame]
    body: Sequence[Silhouette]
    knife: Sequence[Silhouette]

    def body_views(self, rule: CarvingRule) -> list[CurvedView]:
        """Return what votes for the body."""
        return [curved_view(f, _voting(s, f, rule).silhouette) for f, s in self._seen(self.body)]

    def knife_views(self) -> list[CurvedView]:
        """Return what votes for the knife: only frames that show it, and as they show it.

        What is as thin as a blade does not shade itself: its lit side is all of it. Filled away
        from the radar, outlines of frames from the front alone would reach into the body.
        """
        return [curved_view(f, s) for f, s in self._seen(self.knife)]

    def votes(self, outlines: Sequence[Silhouette], rule: CarvingRule) -> list[View]:
        """Return views, as if far away, that say which directions are constrained."""
        return [_voting(s, f, rule) for f, s in self._seen(outlines)]

    def circles(self, rule: CarvingRule) -> tuple[list[View], list[View]]:
        """Return the body's votes of all frames, and of those that look from above."""
        seen = self._seen(self.body)
        from_above = [(frame, outline) for frame, outline in seen if frame.line_of_sight[2] > 0]
        every, above = (
            [_voting(outline, frame, rule) for frame, outline in pairs]
            for pairs in (seen, from_above)
        )
        return every, above

    def _seen(self, outlines: Sequence[Silhouette]) -> list[tuple[Frame, Silhouette]]:
        pairs = zip(self.frames, outlines, strict=True)
        return [(frame, outline) for frame, outline in pairs if not outline.is_empty]


def _voting(silhouette: Silhouette, frame: Frame, rule: CarvingRule) -> View:
    return carving_view(View(silhouette=silhouette, projection=frame.projection), rule)
