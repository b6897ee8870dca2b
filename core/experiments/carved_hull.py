"""A hull that an experiment carved, with its agreement with the truth."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from core.experiments.results import Figure
from core.geometry.grid import VoxelGrid
from core.hull.surface import EMPTY_SURFACE, Surface, hull_surface
from core.hull.view import View
from core.hull.votes import VoteCounts
from core.measurement.comparison import Agreement, voxel_agreement
from core.measurement.extents import Extent, axis_extents


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class CarvedHull:
    """A hull beside the truth.

    Attributes:
        surface: empty if nothing is left.
        volume_m3: of its voxels.
        agreement: with the true voxels.
        extents: along x, y and z; none of an empty hull.
    """

    surface: Surface
    volume_m3: float
    agreement: Agreement
    extents: tuple[Extent, ...]

    def row(self, name: str) -> tuple[str, ...]:
        """Return the cells of a table: name, IoU, coverage, volume, and the three extents."""
        return (
            name,
            f"{self.agreement.intersection_over_union:.3f}",
            f"{self.agreement.coverage:.3f}",
            f"{self.volume_m3:.1f}",
            *([_extent_text(extent) for extent in self.extents] or ["none"] * 3),
        )

    def figures(self, name: str) -> list[Figure]:
        """Return IoU, coverage and volume as figures named after the hull."""
        return [
            Figure(name=f"{name}: IoU", value=self.agreement.intersection_over_union),
            Figure(name=f"{name}: coverage", value=self.agreement.coverage),
            Figure(name=f"{name}: volume", value=self.volume_m3, unit="m³"),
        ]


COLUMNS = ("", "IoU", "coverage", "volume (m³)", "x (m)", "y (m)", "z (m)")
"""Headings of `CarvedHull.row`."""


def carved_hull(
    views: Sequence[View], grid: VoxelGrid, truth: NDArray[np.bool_], *, has_surface: bool = True
) -> CarvedHull:
    """Carve all views' hull on a grid and hold it against the true voxels.

    Args:
        views: as they vote.
        grid: to carve on.
        truth: (nx, ny, nz) voxels of the target.
        has_surface: whether surface and extents are wanted; without, both are empty.
    """
    volume = VoteCounts(grid)
    for view in views:
        volume.add(view)
    inside = volume.hull()
    surface = hull_surface(volume) if has_surface else EMPTY_SURFACE
    return CarvedHull(
        surface=surface,
        volume_m3=float(np.count_nonzero(inside)) * grid.spacing_m**3,
        agreement=voxel_agreement(inside, truth),
        extents=() if surface.is_empty else axis_extents(surface, grid, views),
    )


def _extent_text(extent: Extent) -> str:
    return f"{extent.value_m:.2f}" if extent.is_bounded else "not bounded"
