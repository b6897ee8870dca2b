"""The algorithm on one page: frames in, a hull that shrinks view by view out."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace

from core.arrays import Floats
from core.frame import Frame
from core.geometry.grid import VoxelGrid
from core.geometry.projection import Projection
from core.hull.registration import centroid_registered
from core.hull.shadow import CarvingRule, carving_view
from core.hull.surface import Surface, hull_surface
from core.hull.view import View
from core.hull.votes import VoteVolume
from core.measurement.extents import Extent, axis_extents, unobserved_direction
from core.silhouettes.extraction import ExtractionSettings, extract_silhouette
from core.silhouettes.silhouette import Silhouette


@dataclass(frozen=True, slots=True, kw_only=True)
class ReconstructionSettings:
    """What an analyst may choose.

    Attributes:
        spacing_m: voxel spacing.
        side_m: side of the cubic grid, centred on the target frame's origin.
        rule: "shadow" carves nothing behind the first return, "strict" is the paper's rule.
        tolerated_misses: a voxel stays while at most this many views miss it, so that the vote
            threshold T of eq. 25 is the number of views less this; 0 is the paper's T = I.
        registers_centroids: whether frames are shifted to a common centroid (section III.D),
            for frames whose offsets are unknown.
        extraction: how silhouettes are taken from frames.
    """

    spacing_m: float = 0.15
    side_m: float = 24.0
    rule: CarvingRule = "shadow"
    tolerated_misses: int = 0
    registers_centroids: bool = False
    extraction: ExtractionSettings = field(default_factory=ExtractionSettings)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Step:
    """The state after one more frame.

    Attributes:
        number: how many frames have voted, this one included.
        frame: the frame that voted.
        silhouette: its outline.
        surface: the hull of all frames so far.
        threshold: votes that a voxel of it has at least.
        extents: along x, y, z; empty when the hull is.
        unobserved: (3,) direction that no frame so far constrains, or None.
    """

    number: int
    frame: Frame
    silhouette: Silhouette
    surface: Surface
    threshold: int
    extents: tuple[Extent, ...]
    unobserved: Floats | None


def reconstruct(
    frames: Iterable[Frame], settings: ReconstructionSettings | None = None
) -> Iterator[Step]:
    """Carve a hull frame by frame and yield the state after each.

    Raises:
        ValueError: a frame without contrast, or a grid too large.
    """
    settings = settings or ReconstructionSettings()
    grid = VoxelGrid.cube(side_m=settings.side_m, spacing_m=settings.spacing_m)
    volume = VoteVolume(grid)
    projections: list[Projection] = []
    for number, received in enumerate(frames, start=1):
        silhouette = extract_silhouette(received, settings.extraction)
        frame = _registered(received, silhouette) if settings.registers_centroids else received
        view = View(silhouette=silhouette, projection=frame.projection)
        volume.add(carving_view(view, settings.rule))
        projections.append(frame.projection)
        threshold = max(1, number - settings.tolerated_misses)
        surface = hull_surface(volume, threshold)
        yield Step(
            number=number,
            frame=frame,
            silhouette=silhouette,
            surface=surface,
            threshold=threshold,
            extents=() if surface.is_empty else axis_extents(surface, grid),
            unobserved=unobserved_direction(projections),
        )


def _registered(frame: Frame, silhouette: Silhouette) -> Frame:
    return replace(frame, projection=centroid_registered(silhouette, frame.projection))
