"""One frame as it stands in an analysis."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

from core.analysis.history import History
from core.analysis.outline_layers import Layers, OutlineLayer, layers_of, undrawn
from core.analysis.polling import Place
from core.frame import Frame
from core.reconstruction import OUT_OF_RANGE, Ballot, ReconstructionSettings, not_voting_note
from core.silhouettes.silhouette import WHOLE, Silhouette

ReviewState = Literal["todo", "ok", "fix", "excluded"]
"""How far the analyst is with a frame; an excluded one does not vote."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class AnalysedFrame:
    """A frame as it stands in an analysis.

    Attributes:
        number: how many frames had come, this one included.
        received: as it came.
        layers: its outlines, by the component that each shows; the whole target is always there.
        state: how far the analyst is with it.
        is_in_range: whether it is one of the frames that the settings let vote.
        first_revision: of an outline that nobody has drawn yet.
    """

    number: int
    received: Frame
    layers: Layers
    state: ReviewState
    is_in_range: bool = True
    first_revision: int = 0

    @property
    def history(self) -> History:
        """Of the whole target's outline."""
        return self.layers[WHOLE].history

    @property
    def ballot(self) -> Ballot:
        """How it votes by the whole target's present outline."""
        return self.layers[WHOLE].ballot

    @property
    def frame(self) -> Frame:
        """The frame, registered if the settings ask for it."""
        return self.ballot.frame

    @property
    def silhouette(self) -> Silhouette:
        """The whole target's present outline."""
        return self.layers[WHOLE].silhouette

    @property
    def votes(self) -> bool:
        """Whether it votes by the whole target's outline."""
        return self.place(WHOLE).votes

    @property
    def parts(self) -> tuple[str, ...]:
        """Labels of the parts of the target that have an outline in it, sorted."""
        drawn = (label for label, layer in self.layers.items() if not layer.silhouette.is_empty)
        return tuple(sorted(label for label in drawn if label != WHOLE))

    @property
    def note(self) -> str:
        """What a person should know of it, empty if nothing."""
        return self.note_of(WHOLE)

    @property
    def _held_back(self) -> str:
        """Why a frame that could vote is not let, empty if it is."""
        if self.state == "excluded":
            return "is excluded"
        return "" if self.is_in_range else OUT_OF_RANGE

    def note_of(self, component: str) -> str:
        """Return what a person should know of a component in it, empty if nothing."""
        return not_voting_note(self.number, self.layer(component).ballot.unfit or self._held_back)

    def layer(self, component: str) -> OutlineLayer:
        """Return the outline of a component, an empty one where nobody has drawn it."""
        layer = self.layers.get(component)
        return layer or undrawn(component, self.layers[WHOLE], self.first_revision)

    def place(self, component: str) -> Place:
        """Return its place in the volume of a component; without an outline it does not vote."""
        layer = self.layers.get(component)
        view = None if layer is None else layer.ballot.view
        return Place.of(view, is_excluded=bool(self._held_back))

    def outlined(
        self, histories: Mapping[str, History], settings: ReconstructionSettings
    ) -> "AnalysedFrame":
        """Return it with other histories of some components, the settings being the same.

        Raises:
            ValueError: an outline that cannot vote.
        """
        after = {**self._histories(), **histories}
        layers = layers_of(self.received, after, settings, known=self.layers)
        return replace(self, layers=layers)

    def voting_by(self, settings: ReconstructionSettings) -> "AnalysedFrame":
        """Return it as it votes by other settings.

        Raises:
            ValueError: an outline that cannot vote.
        """
        layers = layers_of(self.received, self._histories(), settings)
        return replace(self, layers=layers, is_in_range=settings.lets_vote(self.number))

    def _histories(self) -> dict[str, History]:
        return {label: layer.history for label, layer in self.layers.items()}
