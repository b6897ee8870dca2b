"""One frame as it stands in an analysis."""

from dataclasses import dataclass
from typing import Literal

from core.analysis.history import History
from core.analysis.polling import Place
from core.frame import Frame
from core.reconstruction import Ballot, not_voting_note
from core.silhouettes.silhouette import Silhouette

ReviewState = Literal["todo", "ok", "fix", "excluded"]
"""How far the analyst is with a frame; an excluded one does not vote."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class AnalysedFrame:
    """A frame as it stands in an analysis.

    Attributes:
        number: how many frames had come, this one included.
        received: as it came.
        history: of its outline.
        state: how far the analyst is with it.
        ballot: how it votes by its present outline.
    """

    number: int
    received: Frame
    history: History
    state: ReviewState
    ballot: Ballot

    @property
    def frame(self) -> Frame:
        """The frame, registered if the settings ask for it."""
        return self.ballot.frame

    @property
    def silhouette(self) -> Silhouette:
        """Its present outline."""
        return self.history.present.silhouette

    @property
    def votes(self) -> bool:
        """Whether it votes."""
        return self.place.votes

    @property
    def place(self) -> Place:
        """Its place in a volume."""
        return Place.of(self.ballot.view, is_excluded=self.state == "excluded")

    @property
    def note(self) -> str:
        """What a person should know of it, empty if nothing."""
        excluded = "is excluded" if self.state == "excluded" else ""
        return not_voting_note(self.number, self.ballot.unfit or excluded)
