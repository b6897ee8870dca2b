"""The algorithm on one page: frames in, a hull that shrinks view by view out."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace

from core.arrays import Floats
from core.frame import Frame
from core.geometry.grid import VoxelGrid
from core.hull.shadow import CarvingRule
from core.hull.sunlight import MOST_PHASE_RAD, carving_frame_view, unfit_to_carve
from core.hull.surface import EMPTY_SURFACE, Surface
from core.hull.view import View
from core.hull.volume import VoteVolume
from core.hull.votes import check_storable
from core.measurement.extents import Extent, axis_extents
from core.measurement.lines import LineMeasurement, principal_lines
from core.measurement.observability import unobserved_direction
from core.registration.centroid import centroid_registered
from core.registration.registration import RegistrationRule, moved, registered
from core.silhouettes.extraction import ExtractionSettings, extract_silhouette
from core.silhouettes.silhouette import Silhouette

CONTRADICTS = "has a silhouette that contradicts the others"
"""Why a frame that registration by agreement found to be wrong does not vote."""

OUT_OF_RANGE = "lies outside the range of frames that vote"
"""Why a frame before the first or after the last that the settings ask for does not vote."""

LINE_NAMES = ("span", "length", "diameter")
"""Of the principal lines, longest first, as they are called on a laboratory with solar panels."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ReconstructionSettings:
    """What an analyst may choose.

    Attributes:
        spacing_m: voxel spacing.
        side_m: side of the cubic grid, centred on the target frame's origin; the target is taken
            to be no longer in any direction.
        rule: "shadow" carves nothing behind the first return, "strict" is the paper's rule.
        tolerated_misses: a voxel stays while at most this many views miss it, so that the vote
            threshold T of eq. 25 is the number of views less this; 0 is the paper's T = I.
        registration: of frames whose offsets are unknown (section III.D): "centroid" shifts each
            silhouette to a common centroid as it comes, "agreement" waits for all frames and
            finds the offsets on which all outlines agree.
        extraction: how silhouettes are taken from frames.
        most_phase_rad: sunlit outlines vote up to this angle at the target between the sun and
            the observer; π lets all vote.
        frame_range: numbers of the first and the last frame that may vote, from 1; None for the
            last lets all vote that come from the first on.
    """

    spacing_m: float = 0.15
    side_m: float = 21.0
    rule: CarvingRule = "shadow"
    tolerated_misses: int = 0
    registration: RegistrationRule = "none"
    extraction: ExtractionSettings = field(default_factory=ExtractionSettings)
    most_phase_rad: float = MOST_PHASE_RAD
    frame_range: tuple[int, int | None] = (1, None)

    def __post_init__(self) -> None:
        if self.tolerated_misses < 0:
            raise ValueError(
                f"Tolerated misses are a number of views, 0 or more; got {self.tolerated_misses}."
            )
        first, last = self.frame_range
        if first < 1 or (last is not None and last < first):
            raise ValueError(
                "The range of frames that vote runs from a first frame, 1 or later, to a last one "
                f"that is not before it; got {first} to {last}."
            )
        check_storable(self.grid())

    def lets_vote(self, number: int) -> bool:
        """Tell whether frame `number`, from 1, lies in the range of frames that vote."""
        first, last = self.frame_range
        return number >= first and (last is None or number <= last)

    def grid(self) -> VoxelGrid:
        """Return the grid on which views vote.

        Raises:
            ValueError: a spacing or side that makes no grid.
        """
        return VoxelGrid.cube(side_m=self.side_m, spacing_m=self.spacing_m)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Step:
    """The state after one more frame.

    Attributes:
        number: how many frames have come, this one included.
        voting: how many of them vote.
        frame: the frame that came, with its projection as registered.
        silhouette: its outline.
        offset_px: (2,) rows and columns by which registration moved the frame; None without.
        note: what a person should know of this frame, empty if nothing.
        surface: the hull of all voting frames so far.
        threshold: votes that a voxel of it has at least, 0 while nothing votes.
        extents: along x, y, z; empty when the hull is.
        lines: span, length and diameter along the hull's own principal axes; empty while any
            extent is open or the hull is empty.
        unobserved: (3,) direction that no frame so far constrains, or None.
    """

    number: int
    voting: int
    frame: Frame
    silhouette: Silhouette
    offset_px: Floats | None
    note: str
    surface: Surface
    threshold: int
    extents: tuple[Extent, ...]
    lines: tuple[LineMeasurement, ...]
    unobserved: Floats | None


def reconstruct(
    frames: Iterable[Frame],
    settings: ReconstructionSettings | None = None,
    *,
    surface_of: Callable[[VoteVolume], Surface] = VoteVolume.surface,
) -> Iterator[Step]:
    """Carve a hull frame by frame and yield the state after each.

    A frame in which no target is detected says nothing of where the target is, one against the
    sun too little, and one whose silhouette contradicts all others in the registration something
    wrong; they are noted and do not vote.

    Args:
        frames: in any order.
        settings: what an analyst may choose.
        surface_of: meshes the hull at the volume's threshold; by default exactly.

    Raises:
        ValueError: a frame without contrast, a grid too large, or too few frames to register.
    """
    settings = settings or ReconstructionSettings()
    volume = VoteVolume(settings.grid())
    views: list[View] = []
    for number, outline in enumerate(_outlines(frames, settings), start=1):
        ballot = outline.ballot(settings)
        if not settings.lets_vote(number):
            ballot = replace(ballot, view=None, unfit=ballot.unfit or OUT_OF_RANGE)
        if ballot.view is not None:
            views.append(ballot.view)
            volume.add(ballot.view)
            volume.threshold = vote_threshold(len(views), settings)
        surface = surface_of(volume) if views else EMPTY_SURFACE
        measures = measures_of(surface, volume.grid, views)
        yield Step(
            number=number,
            voting=len(views),
            frame=ballot.frame,
            silhouette=outline.silhouette,
            offset_px=outline.offset_px if ballot.offset_px is None else ballot.offset_px,
            note=not_voting_note(number, ballot.unfit),
            surface=surface,
            threshold=volume.threshold or 0,
            extents=measures.extents,
            lines=measures.lines,
            unobserved=measures.unobserved,
        )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Ballot:
    """What a frame with a silhouette says of where the target is.

    Attributes:
        frame: registered if the settings ask for it.
        view: that votes, None for a silhouette that must not.
        unfit: why it must not, in a clause for people to read; empty if it votes.
        offset_px: (2,) row and column by which registration by centroid moved it, or None.
    """

    frame: Frame
    view: View | None
    unfit: str = ""
    offset_px: Floats | None = None


def ballot_of(received: Frame, silhouette: Silhouette, settings: ReconstructionSettings) -> Ballot:
    """Return how a frame votes by a silhouette drawn in it.

    Raises:
        ValueError: a picture against the sun, or one that registration by centroid does not suit.
    """
    unfit = unfit_to_carve(received, silhouette, settings.most_phase_rad)
    if unfit:
        return Ballot(frame=received, view=None, unfit=unfit)
    frame, offset_px = received, None
    if settings.registration == "centroid":
        projection = centroid_registered(silhouette, received.projection)
        offset_px = projection.matrix[:, 3] - received.projection.matrix[:, 3]
        frame = replace(received, projection=projection)
    view = carving_frame_view(frame, silhouette, settings.rule, depth_m=settings.side_m)
    return Ballot(frame=frame, view=view, offset_px=offset_px)


def vote_threshold(voting: int, settings: ReconstructionSettings) -> int | None:
    """Return the votes that a voxel of the hull has at least (T of eq. 25), None without views."""
    return max(1, voting - settings.tolerated_misses) if voting else None


def not_voting_note(number: int, why: str) -> str:
    """Return the note of a frame that does not vote, empty for one that does."""
    return f"frame {number} {why} and does not vote" if why else ""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Measures:
    """What is measured on a hull.

    Attributes:
        extents: along x, y, z; empty when the hull is.
        lines: span, length and diameter along the hull's own principal axes; empty while any
            extent is open or the hull is empty.
        unobserved: (3,) direction that no view constrains, or None.
    """

    extents: tuple[Extent, ...]
    lines: tuple[LineMeasurement, ...]
    unobserved: Floats | None


def measures_of(surface: Surface, grid: VoxelGrid, views: Sequence[View]) -> Measures:
    """Measure the hull that views carved on a grid."""
    extents = () if surface.is_empty else axis_extents(surface, grid, views)
    is_closed = bool(extents) and all(extent.is_bounded for extent in extents)
    return Measures(
        extents=extents,
        lines=principal_lines(surface, LINE_NAMES) if is_closed else (),
        unobserved=unobserved_direction(views) if views else None,
    )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Outline:
    """A frame's silhouette, and what registration by agreement made of it."""

    frame: Frame
    silhouette: Silhouette
    offset_px: Floats | None = None
    contradicts: bool = False

    @property
    def view(self) -> View:
        return View(silhouette=self.silhouette, projection=self.frame.projection)

    def ballot(self, settings: ReconstructionSettings) -> Ballot:
        if self.contradicts:
            return Ballot(frame=self.frame, view=None, unfit=CONTRADICTS)
        return ballot_of(self.frame, self.silhouette, settings)

    def moved(self, offset_px: Floats, *, contradicts: bool) -> "_Outline":
        frame = replace(self.frame, projection=moved(self.frame.projection, offset_px))
        return replace(self, frame=frame, offset_px=offset_px, contradicts=contradicts)


def _outlines(frames: Iterable[Frame], settings: ReconstructionSettings) -> Iterator[_Outline]:
    outlines = (
        _Outline(frame=frame, silhouette=extract_silhouette(frame, settings.extraction))
        for frame in frames
    )
    if settings.registration == "agreement":
        yield from _agreeing(list(outlines), settings)
    else:
        yield from outlines


def _agreeing(outlines: Sequence[_Outline], settings: ReconstructionSettings) -> Iterator[_Outline]:
    # A telescope's stars place its frames; only the radar's have unknown offsets.
    shown = [
        number
        for number, outline in enumerate(outlines)
        if outline.frame.sensor == "radar" and outline.ballot(settings).view is not None
    ]
    registration = registered([outlines[number].view for number in shown])
    place = {number: index for index, number in enumerate(shown)}
    for number, outline in enumerate(outlines):
        if number not in place:
            yield outline
            continue
        index = place[number]
        yield outline.moved(
            registration.offsets_px[index], contradicts=bool(registration.is_bad[index])
        )
