"""The hull of one component, kept in step with its outlines, and a coarser one for previews."""

from collections.abc import Callable, Sequence

from core.analysis.hull import Hull, hull_of
from core.analysis.polling import Place, bring_in_step
from core.geometry.grid import VoxelGrid
from core.hull.surface import EMPTY_SURFACE, Surface
from core.hull.volume import VoteVolume
from core.reconstruction import ReconstructionSettings, vote_threshold

SurfaceOf = Callable[[VoteVolume], Surface]

PREVIEW_VOXELS = 96
"""Along each side of the grid that previews are carved on."""


class CarvedHull:
    """Votes, surface and numbers of one component's hull.

    A hull is numbered when it is settled and keeps its number as long as it stays what it is;
    after a preview it comes back with it. Where one counter numbers the hulls of all components, no
    two of them that are settled ever share a number.
    """

    def __init__(
        self, settings: ReconstructionSettings, surface_of: SurfaceOf, *, revision: int = 0
    ) -> None:
        """Start without frames.

        Raises:
            ValueError: a grid too large.
        """
        self._surface_of = surface_of
        self._volume = VoteVolume(settings.grid())
        self._coarse: VoteVolume | None = None
        self._preview_revision: int | None = None
        self._revision = revision
        self._settled_at = self._volume.revision
        self._settled: tuple[Hull, Surface] | None = None
        self._previewed: tuple[Hull, Surface] | None = None

    @property
    def volume(self) -> VoteVolume:
        """The committed votes; frame n is view n − 1. To be read only."""
        return self._volume

    @property
    def is_preview(self) -> bool:
        """Whether a preview is on show."""
        return self._preview_revision is not None

    def bring(self, places: Sequence[Place], settings: ReconstructionSettings) -> None:
        """Let frames vote by their places; what is on show stays until it is settled.

        Raises:
            ValueError: an outline without area, or a camera that stands in the grid.
        """
        _carve(self._volume, places, settings)

    def start_over(self, places: Sequence[Place], settings: ReconstructionSettings) -> None:
        """Vote from scratch after `bring` failed; what is on show has always been this."""
        self._volume = VoteVolume(self._volume.grid)
        _carve(self._volume, places, settings)
        self._settled_at = self._volume.revision

    def settle(self, revision: int) -> None:
        """Show the hull itself, as `revision` where it is another than the one settled last."""
        self._preview_revision = self._previewed = None
        if self._volume.revision != self._settled_at:
            self._revision, self._settled = revision, None
            self._settled_at = self._volume.revision

    def preview(
        self, places: Sequence[Place], settings: ReconstructionSettings, revision: int
    ) -> None:
        """Show, more coarsely, what other places would carve.

        Args:
            places: of the frames.
            settings: by which they are carved.
            revision: that the hull would have.

        Raises:
            ValueError: an outline without area, or a camera that stands in the grid.
        """
        if self._coarse is None:
            self._coarse = VoteVolume(_coarse_grid(settings))
        _carve(self._coarse, places, settings)
        self._preview_revision, self._previewed = revision, None

    def now(self) -> tuple[Hull, Surface]:
        """Return hull and surface, meshed and measured when first asked for."""
        if self._coarse is not None and self._preview_revision is not None:
            self._previewed = self._previewed or self._meshed(self._coarse, self._preview_revision)
            return self._previewed
        self._settled = self._settled or self._meshed(self._volume, self._revision)
        return self._settled

    def _meshed(self, volume: VoteVolume, revision: int) -> tuple[Hull, Surface]:
        surface = self._surface_of(volume) if volume.view_count else EMPTY_SURFACE
        is_preview = volume is self._coarse
        return hull_of(volume, surface, revision=revision, is_preview=is_preview), surface


def _carve(volume: VoteVolume, places: Sequence[Place], settings: ReconstructionSettings) -> None:
    voting = sum(place.votes for place in places)
    bring_in_step(volume, places, vote_threshold(voting, settings))


def _coarse_grid(settings: ReconstructionSettings) -> VoxelGrid:
    spacing_m = max(settings.spacing_m, settings.side_m / PREVIEW_VOXELS)
    return VoxelGrid.cube(side_m=settings.side_m, spacing_m=spacing_m)
