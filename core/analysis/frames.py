"""One frame as it stands in an analysis."""

from dataclasses import dataclass
from typing import Literal

from core.analysis.history import History
from core.analysis.polling import Place
from core.frame import Frame
from core.hull.outline import outline_of
from core.reconstruction import OUT_OF_RANGE, Ballot, not_voting_note
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
        is_in_range: whether it is one of the frames that the settings let vote.
    """

    number: int
    received: Frame
    history: History
    state: ReviewState
    ballot: Ballot
    is_in_range: bool = True

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
        return Place.of(self.ballot.view, is_excluded=bool(self._held_back))

    @property
    def note(self) -> str:
        """What a person should know of it, empty if nothing."""
        return not_voting_note(self.number, self.ballot.unfit or self._held_back)

    @property
    def vote_repair(self) -> str:
        """What had to be repaired in its outline for it to vote, empty when nothing was."""
        return "" if self.ballot.view is None else outline_of(self.ballot.view.silhouette).repair

    @property
    def _held_back(self) -> str:
        """Why a frame that could vote is not let, empty if it is."""
        if self.state == "excluded":
            return "is excluded"
        return "" if self.is_in_range else OUT_OF_RANGE
