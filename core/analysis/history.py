"""What became of one frame's outline: every revision, and the way back."""

from dataclasses import dataclass, replace

from core.silhouettes.silhouette import Silhouette

EXTRACTION = "extraction"
"""The tool that gave a frame its first outline."""


class StaleRevision(ValueError):  # noqa: N818 - the state that is wrong, as a person says it
    """An edit starts from an outline that is no longer the frame's."""


class NothingLeft(ValueError):  # noqa: N818 - likewise
    """There is no edit to take back, or none to do again."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Edit:
    """One entry of the journal, which only ever grows.

    Attributes:
        frame: number of the frame, from 1.
        revision: of its outline after the edit.
        tool: that made it; "undo" and "redo" are tools too.
        before, after: the outlines, of one component.
    """

    frame: int
    revision: int
    tool: str
    before: Silhouette
    after: Silhouette

    @property
    def component(self) -> str:
        """What the outlines show."""
        return self.after.component


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Outlined:
    """An outline that a frame has had.

    Attributes:
        silhouette: the outline.
        tool: that made it.
        repair: what had to be repaired in it, in a sentence for people; empty when nothing was.
    """

    silhouette: Silhouette
    tool: str
    repair: str = ""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class History:
    """A frame's outlines that undo and redo go through.

    Attributes:
        outlines: oldest first; those past `position` have been taken back.
        position: of the present one.
        revision: grows with every edit, undo and redo, so that no two outlines share one.
    """

    outlines: tuple[Outlined, ...]
    position: int = 0
    revision: int = 0

    @property
    def present(self) -> Outlined:
        """The outline that the frame has now."""
        return self.outlines[self.position]

    @property
    def is_edited(self) -> bool:
        """Whether the outline is another than the program's own."""
        return self.present.tool != EXTRACTION

    @property
    def can_undo(self) -> bool:
        """Whether there is an edit to take back."""
        return self.position > 0

    @property
    def can_redo(self) -> bool:
        """Whether an edit that was taken back can be done again."""
        return self.position < len(self.outlines) - 1

    def committed(self, outlined: Outlined) -> "History":
        """Return the history with one more outline; what had been taken back is out of reach."""
        outlines = (*self.outlines[: self.position + 1], outlined)
        return History(outlines=outlines, position=len(outlines) - 1, revision=self.revision + 1)

    def undone(self) -> "History":
        """Return the history one edit back.

        Raises:
            NothingLeft: there is none.
        """
        if not self.can_undo:
            raise NothingLeft("There is no edit of this frame to take back.")
        return replace(self, position=self.position - 1, revision=self.revision + 1)

    def redone(self) -> "History":
        """Return the history one edit forward again.

        Raises:
            NothingLeft: there is none.
        """
        if not self.can_redo:
            raise NothingLeft("There is no edit of this frame to do again.")
        return replace(self, position=self.position + 1, revision=self.revision + 1)

    def check(self, base_revision: int) -> None:
        """Make sure that an edit starts from the present outline.

        Raises:
            StaleRevision: it does not.
        """
        if base_revision != self.revision:
            raise StaleRevision(
                f"This outline has been changed meanwhile: the edit starts from revision "
                f"{base_revision}, and revision {self.revision} is current. "
                "Load the frame again and repeat the edit."
            )
