"""The mutable heart of the workstation: frames that arrive, outlines that change, one hull."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import get_args

from core.analysis.extracting import Extraction, extracted_again
from core.analysis.frames import AnalysedFrame, ReviewState
from core.analysis.history import EXTRACTION, Edit, History, NothingLeft, Outlined
from core.analysis.hull import Hull, hull_of
from core.analysis.polling import bring_in_step
from core.frame import Frame
from core.geometry.grid import VoxelGrid
from core.hull.surface import EMPTY_SURFACE, Surface
from core.hull.volume import VoteVolume
from core.reconstruction import ReconstructionSettings, ballot_of, vote_threshold
from core.silhouettes.extraction import ExtractionSettings, extract_silhouette
from core.silhouettes.silhouette import Silhouette

PREVIEW_VOXELS = 96
"""Along each side of the grid that previews are carved on."""


class Analysis:
    """Frames with their outlines, and the hull that follows every change of them.

    After any sequence of operations the hull is, number by number, the one that the same frames
    with the same outlines give from scratch. An operation that raises has changed nothing. Not
    safe to share between threads without a lock of the owner's.
    """

    def __init__(
        self,
        settings: ReconstructionSettings | None = None,
        *,
        surface_of: Callable[[VoteVolume], Surface] = VoteVolume.surface,
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
        self._volume = VoteVolume(_grid(self._settings))
        self._frames: list[AnalysedFrame] = []
        self._earlier: list[AnalysedFrame] = []
        self._journal: list[Edit] = []
        self._extractions: list[Extraction] = []
        self._coarse: VoteVolume | None = None
        self._is_preview = False
        self._revision = revision
        self._first_revision = revision
        self._shown: tuple[Hull, Surface] | None = None

    @property
    def revision(self) -> int:
        """Of the hull; it grows with every change, and no outline's is larger."""
        return self._revision

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
    def volume(self) -> VoteVolume:
        """The committed votes; frame n is view n − 1. To be read only."""
        return self._volume

    @property
    def hull(self) -> Hull:
        """The hull, or its preview, with all its numbers."""
        return self._now()[0]

    @property
    def surface(self) -> Surface:
        """The surface that the numbers of `hull` belong to."""
        return self._now()[1]

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
            history, state = before.history, before.state
        else:
            extracted = silhouette or extract_silhouette(frame, self._settings.extraction)
            first = Outlined(silhouette=extracted, tool=EXTRACTION)
            history = History(outlines=(first,), revision=self._first_revision)
            state = "todo"
        received = AnalysedFrame(
            number=number,
            received=frame,
            history=history,
            state=state,
            ballot=ballot_of(frame, history.present.silhouette, self._settings),
            is_in_range=self._settings.lets_vote(number),
        )
        self._adopt([*self._frames, received])
        return received

    def rewind(self) -> None:
        """Take all frames out, to be received again; outlines, states and journal are kept."""
        self._earlier[: len(self._frames)] = self._frames
        self._volume = VoteVolume(self._volume.grid)
        self._coarse = None
        self._frames = []
        self._changed()

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
        history = self._based(number, base_revision)
        outlined = Outlined(silhouette=silhouette, tool=tool, repair=repair)
        return self._revise({number: history.committed(outlined)}, tool)[0]

    def commit_all(self, outlines: Mapping[int, Outlined], *, tool: str) -> None:
        """Give several frames, by number, outlines that `tool` made: all or none.

        Raises:
            ValueError: there is no such frame, or an outline that cannot vote.
        """
        histories = {n: self.frame(n).history.committed(o) for n, o in outlines.items()}
        self._revise(histories, tool)

    def undo(self, number: int, *, base_revision: int) -> AnalysedFrame:
        """Take a frame's last edit back; no other frame changes.

        Raises:
            StaleRevision: the frame's outline has changed since `base_revision`.
            NothingLeft: there is none.
            ValueError: there is no such frame.
        """
        return self._revise({number: self._based(number, base_revision).undone()}, "undo")[0]

    def redo(self, number: int, *, base_revision: int) -> AnalysedFrame:
        """Do again the edit of a frame that was taken back last.

        Raises:
            StaleRevision: the frame's outline has changed since `base_revision`.
            NothingLeft: there is none.
            ValueError: there is no such frame.
        """
        return self._revise({number: self._based(number, base_revision).redone()}, "redo")[0]

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
        if after.votes == before.votes and not self._is_preview:
            self._frames = self._with(after)
        else:
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
            {n: self.frame(n).history.committed(o) for n, o in outlined.items()}, EXTRACTION
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
        changed = self._revise({f.number: f.history.undone() for f in same}, "undo")
        self._settings = replace(self._settings, extraction=last.before)
        self._extractions.pop()
        return changed

    def set_carving(self, settings: ReconstructionSettings) -> None:
        """Carve by other settings: threshold, rule, grid, which frames vote.

        Raises:
            ValueError: a grid too large, or one within which a camera stands.
        """
        frames = [replace(f, is_in_range=settings.lets_vote(f.number)) for f in self._frames]
        if _count_alike(self._settings, settings):
            self._settings = settings
            self._adopt(frames)
            return
        frames = [replace(f, ballot=ballot_of(f.received, f.silhouette, settings)) for f in frames]
        volume = VoteVolume(_grid(settings))
        _carve(volume, frames, settings)
        self._settings, self._volume, self._frames = settings, volume, frames
        self._coarse = None
        self._changed()

    def preview(self, number: int, silhouette: Silhouette, *, base_revision: int) -> None:
        """Show the hull, more coarsely, as it would be with another outline of a frame.

        Nothing is committed: the next operation, or `end_preview`, brings the hull itself back.

        Raises:
            StaleRevision: the frame's outline has changed since `base_revision`.
            ValueError: there is no such frame, or an outline that cannot vote.
        """
        self._based(number, base_revision)
        drafted = self._with_outline(self.frame(number), silhouette)
        if self._coarse is None:
            self._coarse = VoteVolume(_coarse_grid(self._settings))
        _carve(self._coarse, self._with(drafted), self._settings)
        self._changed(is_preview=True)

    def end_preview(self) -> None:
        """Show the hull itself again."""
        if self._is_preview:
            self._changed()

    def _based(self, number: int, base_revision: int) -> History:
        history = self.frame(number).history
        history.check(base_revision)
        return history

    def _revise(self, histories: Mapping[int, History], tool: str) -> tuple[AnalysedFrame, ...]:
        """Let frames' outlines follow their histories, and note that in the journal."""
        before = {number: self.frame(number) for number in histories}
        after = {
            n: replace(self._with_outline(before[n], history.present.silhouette), history=history)
            for n, history in histories.items()
        }
        self._adopt([after.get(frame.number, frame) for frame in self._frames])
        self._journal += [
            Edit(
                frame=number,
                revision=history.revision,
                tool=tool,
                before=before[number].silhouette,
                after=history.present.silhouette,
            )
            for number, history in histories.items()
        ]
        return tuple(after.values())

    def _with_outline(self, frame: AnalysedFrame, silhouette: Silhouette) -> AnalysedFrame:
        return replace(frame, ballot=ballot_of(frame.received, silhouette, self._settings))

    def _with(self, frame: AnalysedFrame) -> list[AnalysedFrame]:
        """Return the frames with one in the place of its number."""
        return [frame if f.number == frame.number else f for f in self._frames]

    def _adopt(self, frames: list[AnalysedFrame]) -> None:
        _carve(self._volume, frames, self._settings)
        self._frames = frames
        self._changed()

    def _changed(self, *, is_preview: bool = False) -> None:
        self._is_preview = is_preview
        self._revision += 1
        self._shown = None

    def _now(self) -> tuple[Hull, Surface]:
        """Return hull and surface, meshed and measured when first asked for."""
        if self._shown is None:
            is_preview = self._is_preview and self._coarse is not None
            volume = self._coarse if is_preview and self._coarse is not None else self._volume
            surface = self._surface_of(volume) if volume.view_count else EMPTY_SURFACE
            hull = hull_of(volume, surface, revision=self._revision, is_preview=is_preview)
            self._shown = hull, surface
        return self._shown


def _carve(
    volume: VoteVolume, frames: Sequence[AnalysedFrame], settings: ReconstructionSettings
) -> None:
    places = [frame.place for frame in frames]
    voting = sum(place.votes for place in places)
    bring_in_step(volume, places, vote_threshold(voting, settings))


def _count_alike(one: ReconstructionSettings, other: ReconstructionSettings) -> bool:
    """Tell whether each frame's votes are the same, whichever frames vote and how many it takes."""
    misses, frames = other.tolerated_misses, other.frame_range
    return replace(one, tolerated_misses=misses, frame_range=frames) == other


def _grid(settings: ReconstructionSettings) -> VoxelGrid:
    return VoxelGrid.cube(side_m=settings.side_m, spacing_m=settings.spacing_m)


def _coarse_grid(settings: ReconstructionSettings) -> VoxelGrid:
    spacing_m = max(settings.spacing_m, settings.side_m / PREVIEW_VOXELS)
    return VoxelGrid.cube(side_m=settings.side_m, spacing_m=spacing_m)
