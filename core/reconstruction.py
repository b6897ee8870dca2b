"""The algorithm on one page: frames in, a hull that shrinks view by view out."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace

from core.arrays import Floats
from core.frame import Frame
from core.geometry.grid import VoxelGrid
from core.hull.registration import centroid_registered
from core.hull.shadow import CarvingRule
from core.hull.sunlight import MOST_PHASE_RAD, carving_frame_view, unfit_to_carve
from core.hull.surface import EMPTY_SURFACE, Surface
from core.hull.view import View
from core.hull.volume import VoteVolume
from core.measurement.extents import Extent, axis_extents, unobserved_direction
from core.measurement.lines import LineMeasurement, principal_lines
from core.silhouettes.extraction import ExtractionSettings, extract_silhouette
from core.silhouettes.silhouette import Silhouette

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
        registers_centroids: whether frames are shifted to a common centroid (section III.D),
            for frames whose offsets are unknown.
        extraction: how silhouettes are taken from frames.
        most_phase_rad: sunlit outlines vote up to this angle at the target between the sun and
            the observer; π lets all vote.
    """

    spacing_m: float = 0.15
    side_m: float = 21.0
    rule: CarvingRule = "shadow"
    tolerated_misses: int = 0
    registers_centroids: bool = False
    extraction: ExtractionSettings = field(default_factory=ExtractionSettings)
    most_phase_rad: float = MOST_PHASE_RAD

    def __post_init__(self) -> None:
        if self.tolerated_misses < 0:
            raise ValueError(
                f"Tolerated misses are a number of views, 0 or more; got {self.tolerated_misses}."
            )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Step:
    """The state after one more frame.

    Attributes:
        number: how many frames have come, this one included.
        voting: how many of them vote.
        frame: the frame that came.
        silhouette: its outline.
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

    A frame in which no target is detected says nothing of where the target is, and one against
    the sun too little; they are noted and do not vote.

    Args:
        frames: in any order.
        settings: what an analyst may choose.
        surface_of: meshes the hull at the volume's threshold; by default exactly.

    Raises:
        ValueError: a frame without contrast, or a grid too large.
    """
    settings = settings or ReconstructionSettings()
    volume = VoteVolume(VoxelGrid.cube(side_m=settings.side_m, spacing_m=settings.spacing_m))
    views: list[View] = []
    for number, received in enumerate(frames, start=1):
        silhouette = extract_silhouette(received, settings.extraction)
        ballot = ballot_of(received, silhouette, settings)
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
            silhouette=silhouette,
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
    """

    frame: Frame
    view: View | None
    unfit: str = ""


def ballot_of(received: Frame, silhouette: Silhouette, settings: ReconstructionSettings) -> Ballot:
    """Return how a frame votes by a silhouette drawn in it.

    Raises:
        ValueError: a picture against the sun, or one that registration by centroid does not suit.
    """
    unfit = unfit_to_carve(received, silhouette, settings.most_phase_rad)
    if unfit:
        return Ballot(frame=received, view=None, unfit=unfit)
    frame = _registered(received, silhouette) if settings.registers_centroids else received
    view = carving_frame_view(frame, silhouette, settings.rule, depth_m=settings.side_m)
    return Ballot(frame=frame, view=view)


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
        unobserved=unobserved_direction([view.projection for view in views]) if views else None,
    )


def _registered(frame: Frame, silhouette: Silhouette) -> Frame:
    return replace(frame, projection=centroid_registered(silhouette, frame.projection))
