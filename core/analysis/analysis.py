"""The mutable heart of the workstation: frames that arrive, outlines that change, one hull."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import get_args

from core.analysis.carved import SurfaceOf
from core.analysis.extracting import Extraction, extracted_again
from core.analysis.frames import AnalysedFrame, ReviewState
from core.analysis.history import EXTRACTION, Edit, History, NothingLeft, Outlined
from core.analysis.hull import Hull
from core.analysis.hulls import Hulls, PartHull
from core.analysis.outline_layers import layers_of
from core.frame import Frame
from core.hull.surface import Surface
from core.hull.volume import VoteVolume
from core.reconstruction import ReconstructionSettings
from core.silhouettes.extraction import ExtractionSettings, extract_silhouette
from core.silhouettes.silhouette import WHOLE, Silhouette

Key = tuple[int, str]
"""Number of a frame, and the component that an outline in it shows."""


class Analysis:
    """Frames with their outlines, and the hulls that follow every change of them.

    A silhouette is the outline of the component that it names: of the whole target, or of a part,
    which has a hull of its own. After any sequence of operations each hull is, number by number,
    the one that the same frames with the same outlines give from scratch. An operation that raises
    has changed nothing. Not safe to share between threads without a lock of the owner's.
    """

    def __init__(
        self,
        settings: ReconstructionSettings | None = None,
        *,
        surface_of: SurfaceOf = VoteVolume.surface,
        revision: int = 0,
    ) -> None:
        """Start without frames.

        Args:
            settings: what an analyst may choose.
            surface_of: meshes the hull at the volume's threshold; by default exactly.
            revision: from which hulls and outlines count theirs; one beyond an earlier analysis's
                lets an edit that was meant for that one be known as stale.

        Raises:
            ValueError: a grid too large.
        """
        self._settings = settings or ReconstructionSettings()
        self._surface_of = surface_of
        self._hulls = Hulls(self._settings, surface_of, revision=revision)
        self._frames: list[AnalysedFrame] = []
        self._earlier: list[AnalysedFrame] = []
        self._journal: list[Edit] = []
        self._components = {WHOLE: True}
        self._extractions: list[Extraction] = []
        self._first_revision = revision

    @property
    def revision(self) -> int:
        """It grows with every change; no hull's and no outline's is larger."""
        return self._hulls.revision

    @property
    def settings(self) -> ReconstructionSettings:
        """What the analyst has chosen."""
        return self._settings

    @property
    def frames(self) -> tuple[AnalysedFrame, ...]:
        """The frames received, in order."""
        return tuple(self._frames)

    @property
    def journal(self) -> tuple[Edit, ...]:
        """Every edit, oldest first; nothing is ever taken out."""
        return tuple(self._journal)

    @property
    def components(self) -> tuple[str, ...]:
        """All that has ever been outlined, in the order in which it first was."""
        return tuple(self._components)

    @property
    def volume(self) -> VoteVolume:
        """The whole target's committed votes; frame n is view n − 1. To be read only."""
        return self._hulls.volume

    @property
    def hull(self) -> Hull:
        """The whole target's hull, or its preview, with all its numbers."""
        return self._hulls.whole()[0]

    @property
    def surface(self) -> Surface:
        """The surface that the numbers of `hull` belong to."""
        return self._hulls.whole()[1]

    @property
    def parts(self) -> tuple[PartHull, ...]:
        """The hulls of the target's parts that have an outline in some frame, by label."""
        return self._hulls.parts()

    def frame(self, number: int) -> AnalysedFrame:
        """Return frame `number`, from 1.

        Raises:
            ValueError: there is none.
        """
        if not 1 <= number <= len(self._frames):
            raise ValueError(
                f"There is no frame {number}; {len(self._frames)} have arrived so far, from 1."
            )
        return self._frames[number - 1]

    def receive(self, frame: Frame, silhouette: Silhouette | None = None) -> AnalysedFrame:
        """Take one more frame in.

        After a rewind, a frame takes up the outlines and the state that the frame of its number
        had, if its image has the same shape.

        Args:
            frame: the next one.
            silhouette: its extracted outline, where that has been done already.

        Raises:
            ValueError: a frame without contrast, or one that cannot vote.
        """
        number = len(self._frames) + 1
        before = self._earlier[number - 1] if number <= len(self._earlier) else None
        if before is not None and before.received.shape == frame.shape:
            histories = {label: layer.history for label, layer in before.layers.items()}
            state = before.state
        else:
            extracted = silhouette or extract_silhouette(frame, self._settings.extraction)
            first = Outlined(silhouette=extracted, tool=EXTRACTION)
            histories = {WHOLE: History(outlines=(first,), revision=self._first_revision)}
            state = "todo"
        received = AnalysedFrame(
            number=number,
            received=frame,
            layers=layers_of(frame, histories, self._settings),
            state=state,
            is_in_range=self._settings.lets_vote(number),
            first_revision=self._first_revision,
        )
        self._adopt([*self._frames, received])
        return received

    def rewind(self) -> None:
        """Take all frames out, to be received again; outlines, states and journal are kept."""
        self._earlier[: len(self._frames)] = self._frames
        self._hulls = Hulls(self._settings, self._surface_of, revision=self.revision + 1)
        self._frames = []

    def commit(
        self,
        number: int,
        silhouette: Silhouette,
        *,
        tool: str,
        base_revision: int,
        repair: str = "",
    ) -> AnalysedFrame:
        """Give a frame another outline.

        Args:
            number: of the frame, from 1.
            silhouette: drawn in it; an empty one shows no target and does not vote.
            tool: that made it.
            base_revision: of the outline that it was made from.
            repair: what was repaired in it, for people.

        Raises:
            StaleRevision: the frame's outline has changed since `base_revision`.
            ValueError: there is no such frame, or an outline that cannot vote.
        """
        history = self._based(number, silhouette.component, base_revision)
        outlined = Outlined(silhouette=silhouette, tool=tool, repair=repair)
        key = number, silhouette.component
        return self._revise({key: history.committed(outlined)}, tool)[0]

    def commit_all(self, outlines: Iterable[tuple[int, Outlined]], *, tool: str) -> None:
        """Give frames, by number, outlines that `tool` made: all or none.

        Raises:
            ValueError: there is no such frame, or an outline that cannot vote.
        """
        histories = {
            (number, component): self.frame(number).layer(component).history.committed(outlined)
            for number, outlined in outlines
            for component in (outlined.silhouette.component,)
        }
        self._revise(histories, tool)

    def delete_part(self, component: str) -> tuple[AnalysedFrame, ...]:
        """Take a part's outline out of all frames, as edits that can be undone one by one.

        Raises:
            ValueError: no frame has such a part; the whole target is none.
        """
        drawn = [frame for frame in self._frames if component in frame.parts]
        if not drawn:
            raise ValueError(f'No frame has an outline of a part called "{component}".')
        tool = "delete part"
        empty = {f.number: replace(f.layer(component).silhouette, rings=()) for f in drawn}
        return self._revise(
            {
                (f.number, component): f.layer(component).history.committed(
                    Outlined(silhouette=empty[f.number], tool=tool)
                )
                for f in drawn
            },
            tool,
        )

    def undo(self, number: int, *, base_revision: int, component: str = WHOLE) -> AnalysedFrame:
        """Take the last edit of a component's outline back; nothing else changes.

        Raises:
            StaleRevision: the frame's outline has changed since `base_revision`.
            NothingLeft: there is none.
            ValueError: there is no such frame.
        """
        history = self._based(number, component, base_revision).undone()
        return self._revise({(number, component): history}, "undo")[0]

    def redo(self, number: int, *, base_revision: int, component: str = WHOLE) -> AnalysedFrame:
        """Do again the edit of a component's outline that was taken back last.

        Raises:
            StaleRevision: the frame's outline has changed since `base_revision`.
            NothingLeft: there is none.
            ValueError: there is no such frame.
        """
        history = self._based(number, component, base_revision).redone()
        return self._revise({(number, component): history}, "redo")[0]

    def set_state(self, number: int, state: ReviewState) -> AnalysedFrame:
        """Say how far the analyst is with a frame; an excluded one does not vote.

        The hull keeps its revision where the same frames vote as before.

        Raises:
            ValueError: there is no such frame, or no such state.
        """
        if state not in get_args(ReviewState):
            raise ValueError(
                f'A frame is {", ".join(get_args(ReviewState))}; it cannot be "{state}".'
            )
        before = self.frame(number)
        after = replace(before, state=state)
        self._adopt(self._with(after))
        return after

    def extract_again(
        self, extraction: ExtractionSettings, *, overwrites_edited: bool = False
    ) -> tuple[AnalysedFrame, ...]:
        """Take the outlines of all frames from their images anew, as edits that can be undone.

        Frames whose outline the analyst has edited keep it unless `overwrites_edited`; those of
        which the settings find the same outline keep theirs, without an edit.

        Raises:
            ValueError: a frame without contrast.
        """
        found = extracted_again(self._frames, extraction, overwrites_edited=overwrites_edited)
        before = self._settings.extraction
        outlined = {
            number: Outlined(silhouette=silhouette, tool=EXTRACTION)
            for number, silhouette in found.outlines.items()
        }
        changed = self._revise(
            {(n, WHOLE): self.frame(n).history.committed(o) for n, o in outlined.items()},
            EXTRACTION,
        )
        self._settings = replace(self._settings, extraction=extraction)
        revisions = {frame.number: frame.history.revision for frame in changed}
        self._extractions.append(Extraction(before=before, revisions=revisions))
        return changed

    def undo_extraction(self) -> tuple[AnalysedFrame, ...]:
        """Take the last `extract_again` back, settings too; frames edited since stay as they are.

        Raises:
            NothingLeft: there is none.
        """
        if not self._extractions:
            raise NothingLeft("There is no detection in all frames to take back.")
        last = self._extractions[-1]
        same = [f for f in self._frames if f.history.revision == last.revisions.get(f.number)]
        changed = self._revise({(f.number, WHOLE): f.history.undone() for f in same}, "undo")
        self._settings = replace(self._settings, extraction=last.before)
        self._extractions.pop()
        return changed

    def set_carving(self, settings: ReconstructionSettings) -> None:
        """Carve by other settings: threshold, rule, grid, which frames vote.

        Raises:
            ValueError: a grid too large, or one within which a camera stands.
        """
        if _count_alike(self._settings, settings):
            in_range = [replace(f, is_in_range=settings.lets_vote(f.number)) for f in self._frames]
            self._adopt(in_range, settings)
        else:
            frames = [f.voting_by(settings) for f in self._frames]
            self._hulls.carve_anew(frames, settings)
            self._settings, self._frames = settings, frames

    def preview(self, number: int, silhouette: Silhouette, *, base_revision: int) -> None:
        """Show a component's hull, more coarsely, as it would be with another outline of a frame.

        Nothing is committed: the next operation, or `end_preview`, brings the hull itself back.

        Raises:
            StaleRevision: the frame's outline has changed since `base_revision`.
            ValueError: there is no such frame, or an outline that cannot vote.
        """
        component = silhouette.component
        history = self._based(number, component, base_revision)
        drafted = history.committed(Outlined(silhouette=silhouette, tool="preview"))
        frame = self.frame(number).outlined({component: drafted}, self._settings)
        self._hulls.preview(self._with(frame), component, self._settings)

    def end_preview(self) -> None:
        """Show the hulls themselves again."""
        self._hulls.end_preview(self._frames)

    def _based(self, number: int, component: str, base_revision: int) -> History:
        history = self.frame(number).layer(component).history
        history.check(base_revision)
        return history

    def _revise(self, histories: Mapping[Key, History], tool: str) -> tuple[AnalysedFrame, ...]:
        """Let frames' outlines follow their histories, and note that in the journal."""
        before = {key: self.frame(key[0]) for key in histories}
        after = {frame.number: frame for frame in before.values()}
        for (number, component), history in histories.items():
            after[number] = after[number].outlined({component: history}, self._settings)
        self._adopt([after.get(frame.number, frame) for frame in self._frames])
        self._components |= dict.fromkeys((component for _, component in histories), True)
        self._journal += [
            Edit(
                frame=number,
                revision=history.revision,
                tool=tool,
                before=before[number, component].layer(component).silhouette,
                after=history.present.silhouette,
            )
            for (number, component), history in histories.items()
        ]
        return tuple(after.values())

    def _with(self, frame: AnalysedFrame) -> list[AnalysedFrame]:
        """Return the frames with one in the place of its number."""
        return [frame if f.number == frame.number else f for f in self._frames]

    def _adopt(
        self, frames: list[AnalysedFrame], settings: ReconstructionSettings | None = None
    ) -> None:
        settings = settings or self._settings
        self._hulls.follow(frames, settings, self._frames, self._settings)
        self._frames, self._settings = frames, settings


def _count_alike(one: ReconstructionSettings, other: ReconstructionSettings) -> bool:
    """Tell whether each frame's votes are the same, whichever frames vote and how many it takes."""
    misses, frames = other.tolerated_misses, other.frame_range
    return replace(one, tolerated_misses=misses, frame_range=frames) == other
