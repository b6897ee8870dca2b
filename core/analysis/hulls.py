"""The hulls of an analysis: the whole target's, and one of each part that has an outline."""

from collections.abc import Sequence
from dataclasses import dataclass

from core.analysis.carved import CarvedHull, SurfaceOf
from core.analysis.frames import AnalysedFrame
from core.analysis.hull import Hull
from core.hull.surface import Surface
from core.hull.volume import VoteVolume
from core.reconstruction import ReconstructionSettings
from core.silhouettes.silhouette import WHOLE

MOST_PARTS = 12
"""Each has a volume of its own."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PartHull:
    """The hull of a part of the target.

    Attributes:
        label: of the part.
        hull: its numbers.
        surface: that they belong to.
    """

    label: str
    hull: Hull
    surface: Surface

    def has_place_in(self, whole: Hull) -> bool:
        """Whether its place in the whole is a measurement: both are kept, and bounded by views."""
        # Principal lines are measured only where every extent is bounded.
        is_kept = not (self.hull.is_preview or whole.is_preview)
        return is_kept and bool(self.hull.lines and whole.lines)


class Hulls:
    """Hulls that follow the outlines of their own component and no other.

    One counter numbers all of them, so that a number names one hull of one component only.
    """

    def __init__(
        self, settings: ReconstructionSettings, surface_of: SurfaceOf, *, revision: int
    ) -> None:
        """Start without frames.

        Raises:
            ValueError: a grid too large.
        """
        self._surface_of = surface_of
        self._revision = revision
        self._carved = {WHOLE: CarvedHull(settings, surface_of, revision=revision)}

    @property
    def revision(self) -> int:
        """How often anything kept has changed; the number of the hull that changed last."""
        return self._revision

    @property
    def volume(self) -> VoteVolume:
        """The whole target's votes; to be read only."""
        return self._carved[WHOLE].volume

    @property
    def is_preview(self) -> bool:
        """Whether one of the hulls is a preview."""
        return any(carved.is_preview for carved in self._carved.values())

    def whole(self) -> tuple[Hull, Surface]:
        """Return the whole target's hull and surface."""
        return self._carved[WHOLE].now()

    def parts(self) -> tuple[PartHull, ...]:
        """Return the hulls of all parts, by label."""
        labels = sorted(self._carved.keys() - {WHOLE})
        shown = {label: self._carved[label].now() for label in labels}
        return tuple(
            PartHull(label=label, hull=hull, surface=surface)
            for label, (hull, surface) in shown.items()
        )

    def follow(
        self,
        frames: Sequence[AnalysedFrame],
        settings: ReconstructionSettings,
        before: Sequence[AnalysedFrame],
        settings_before: ReconstructionSettings,
    ) -> None:
        """Show the hulls that `frames` carve on the same grid as `before`, which are held now.

        Raises:
            ValueError: an outline that cannot vote, or too many parts; nothing has changed then.
        """
        carved = {label: self._hull_of(label, settings) for label in _labels(frames)}
        try:
            for label, hull in carved.items():
                hull.bring([frame.place(label) for frame in frames], settings)
        except ValueError:
            for label, hull in self._carved.items():
                hull.start_over([frame.place(label) for frame in before], settings_before)
            raise
        self._take(carved)

    def carve_anew(self, frames: Sequence[AnalysedFrame], settings: ReconstructionSettings) -> None:
        """Show the hulls that `frames` carve by settings under which every vote may be another.

        Raises:
            ValueError: an outline that cannot vote, or a grid too large; nothing has changed then.
        """
        carved = {
            label: CarvedHull(settings, self._surface_of, revision=self._revision + 1)
            for label in _labels(frames)
        }
        for label, hull in carved.items():
            hull.bring([frame.place(label) for frame in frames], settings)
        self._take(carved)

    def preview(
        self, frames: Sequence[AnalysedFrame], component: str, settings: ReconstructionSettings
    ) -> None:
        """Show, more coarsely, the hull that other outlines of one component would carve.

        It bears the number that it would get, and takes none: only what is kept is counted.

        Raises:
            ValueError: an outline that cannot vote, or too many parts.
        """
        _check_count({*self._carved, component})
        drafted = self._hull_of(component, settings)
        drafted.preview([f.place(component) for f in frames], settings, self._revision + 1)
        self._show({**self._carved, component: drafted}, besides=component)

    def end_preview(self, frames: Sequence[AnalysedFrame]) -> None:
        """Show the hulls themselves again."""
        if self.is_preview:
            self._show({label: self._carved[label] for label in _labels(frames)})

    def _hull_of(self, label: str, settings: ReconstructionSettings) -> CarvedHull:
        known = self._carved.get(label)
        return known or CarvedHull(settings, self._surface_of, revision=self._revision + 1)

    def _take(self, carved: dict[str, CarvedHull]) -> None:
        self._revision += 1
        self._show(carved)

    def _show(self, carved: dict[str, CarvedHull], *, besides: str | None = None) -> None:
        self._carved = carved
        for label, hull in carved.items():
            if label != besides:
                hull.settle(self._revision)


def _labels(frames: Sequence[AnalysedFrame]) -> list[str]:
    labels = {WHOLE, *(label for frame in frames for label in frame.parts)}
    _check_count(labels)
    return sorted(labels)


def _check_count(labels: set[str]) -> None:
    if len(labels) > MOST_PARTS + 1:
        raise ValueError(
            f"A target may have at most {MOST_PARTS} parts with hulls of their own; delete one "
            "before you draw another."
        )
