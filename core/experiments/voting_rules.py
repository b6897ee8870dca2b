"""Bodies that one set of frames gives under several rules of voting, and by energy accumulation."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.energy_accumulation.accumulation import Map, accumulated_energy, energy_body
from core.experiments.frame_pictures import OutlinedFrame
from core.geometry.grid import VoxelGrid
from core.hull.shadow import CarvingRule, carving_view
from core.hull.view import View
from core.hull.votes import VoteCounts
from core.measurement.comparison import Agreement, voxel_agreement
from core.targets import LineFeature, Target

SHARES = (0.9, 0.8, 0.6)
"""Of the views, that the soft rules ask a voxel to have."""

STRICT, SHADOW, ENERGY = "strict", "shadow rule", "energy, Otsu"
BEST_ENERGY = "energy, best level"
"""The level at which the truth agrees best: no threshold that does not know it does better."""

METHODS = (STRICT, *(f"≥ {100 * share:.0f} %" for share in SHARES), SHADOW, ENERGY, BEST_ENERGY)

LEVELS = 100
"""Of the energy map that are tried for the best, each leaving as many times the volume before."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class VotedBody:
    """A body of voxels beside the truth.

    Attributes:
        method: that gave it.
        agreement: with the true voxels.
        volume_m3: of its voxels.
        length_error: of its extent along the target's longest line, as a share; None of no body.
    """

    method: str
    agreement: Agreement
    volume_m3: float
    length_error: float | None


def voted_bodies(
    found: Sequence[OutlinedFrame], grid: VoxelGrid, target: Target, truth: NDArray[np.bool_]
) -> tuple[VotedBody, ...]:
    """Return what the strict rule, soft votes, the shadow rule and energy accumulation give.

    The soft rules count the strict rule's votes; all use the same frames and silhouettes.

    Args:
        found: frames with the silhouettes taken from them.
        grid: to vote on.
        target: the truth, for the comparison alone.
        truth: (nx, ny, nz) its voxels.
    """
    strict, shadow = (_counts(found, grid, rule) for rule in ("strict", "shadow"))
    soft = [strict.hull(least_votes(share, strict.view_count)) for share in SHARES]
    energy = accumulated_energy([each.frame for each in found], grid)
    parted = energy_body(energy, grid).inside
    insides = (strict.hull(), *soft, shadow.hull(), parted, _best_level(energy, truth))
    longest = max(target.features, key=lambda feature: feature.length_m)
    return tuple(
        VotedBody(
            method=method,
            agreement=voxel_agreement(inside, truth),
            volume_m3=float(np.count_nonzero(inside)) * grid.spacing_m**3,
            length_error=_length_error(inside, grid, longest),
        )
        for method, inside in zip(METHODS, insides, strict=True)
    )


def least_votes(share: float, views: int) -> int:
    """Return how many of the views a voxel needs to have a share of them, at least one."""
    return max(1, math.ceil(share * views - 1e-9))


def extent_along_m(inside: NDArray[np.bool_], grid: VoxelGrid, direction: Floats) -> float:
    """Return how far voxels reach along a unit vector (3,), with their whole width; 0 if none."""
    places = np.argwhere(inside) @ direction
    if not len(places):
        return 0.0
    return grid.spacing_m * float(np.ptp(places) + np.abs(direction).sum())


def _best_level(energy: Map, truth: NDArray[np.bool_]) -> NDArray[np.bool_]:
    levels = np.quantile(energy, 1 - np.geomspace(1e-4, 0.5, LEVELS))
    bodies = (energy >= level for level in levels)
    return max(bodies, key=lambda inside: voxel_agreement(inside, truth).intersection_over_union)


def _counts(found: Sequence[OutlinedFrame], grid: VoxelGrid, rule: CarvingRule) -> VoteCounts:
    volume = VoteCounts(grid)
    for each in found:
        view = View(silhouette=each.silhouette, projection=each.frame.projection)
        volume.add(carving_view(view, rule))
    return volume


def _length_error(inside: NDArray[np.bool_], grid: VoxelGrid, longest: LineFeature) -> float | None:
    if not inside.any():
        return None
    return extent_along_m(inside, grid, longest.direction) / longest.length_m - 1
