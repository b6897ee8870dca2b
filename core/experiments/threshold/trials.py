"""One sequence with some of its frames wrong: hulls by vote threshold, and after blame."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from core.experiments.exact_features import tiangong_features
from core.experiments.frame_pictures import OutlinedFrame
from core.experiments.limited import radar_views
from core.experiments.threshold.faults import Fault
from core.experiments.threshold.repair import exclude_causers, sufferers
from core.geometry.grid import VoxelGrid
from core.hull.shadow import CarvingRule
from core.hull.surface import Surface, hull_surface
from core.hull.votes import VoteCounts
from core.measurement.comparison import Agreement, voxel_agreement
from core.measurement.measuring import measure
from core.measurement.results import Lost

TOLERATED = (0, 2, 5, 10)
"""Views that may miss a voxel of the hull."""

BLAME = "blame, then all"


def tolerant(misses: int) -> str:
    """Return what voting is called that tolerates so many misses."""
    return f"all − {misses}" if misses else "all"


METHODS = (*map(tolerant, TOLERATED), BLAME)


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """One hull held against the truth.

    Attributes:
        agreement: with the true voxels.
        error_percent: of the span, None where it is lost.
    """

    agreement: Agreement
    error_percent: float | None


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Trial:
    """What became of one sequence.

    Attributes:
        outcomes: by method.
        wrong: numbers of the wrong frames.
        accused: those that blame excluded, in its order.
        suffering: of the frames that still vote then, those whose outline the hull leaves open.
        surfaces: of the hulls with all votes, before and after blame.
    """

    outcomes: Mapping[str, Outcome]
    wrong: frozenset[int]
    accused: tuple[int, ...]
    suffering: tuple[int, ...]
    surfaces: tuple[Surface, Surface]

    @property
    def found(self) -> int:
        """How many wrong frames blame excluded."""
        return len(self.wrong.intersection(self.accused))

    @property
    def falsely_accused(self) -> int:
        """How many right frames blame excluded."""
        return len(set(self.accused) - self.wrong)


def spoilt(
    right: Sequence[OutlinedFrame], numbers: Sequence[int], faults: Sequence[Fault], *, seed: int
) -> list[OutlinedFrame]:
    """Return a sequence of which some frames are wrong, each kind of fault in turn.

    A frame that goes wrong does so alike in every trial of the same kinds and seed.
    """
    frames = list(right)
    for turn, number in enumerate(numbers):
        fault = faults[turn % len(faults)]
        frames[number] = fault(right[number], np.random.default_rng((seed, number)))
    return frames


def mixed(
    right: Sequence[OutlinedFrame], wrong: Sequence[OutlinedFrame], numbers: Sequence[int]
) -> list[OutlinedFrame]:
    """Return the right frames with those of some numbers taken from the wrong ones."""
    frames = list(right)
    for number in numbers:
        frames[number] = wrong[number]
    return frames


def tried(
    frames: Sequence[OutlinedFrame],
    wrong: Sequence[int],
    rule: CarvingRule,
    grid: VoxelGrid,
    truth: NDArray[np.bool_],
    *,
    suffering: bool = False,
) -> Trial:
    """Carve a sequence by every threshold, then let blame exclude frames and carve it again.

    Args:
        frames: none of them empty.
        wrong: numbers of the wrong ones, to count what blame finds; nothing else sees them.
        rule: of carving.
        grid: to carve on.
        truth: (nx, ny, nz) voxels of the target.
        suffering: whether it is wanted which frames suffer then.
    """
    volume = VoteCounts(grid)
    volume.add_many(radar_views(frames, rule))
    outcomes = {tolerant(k): _outcome(volume, k, truth) for k in TOLERATED}
    before = hull_surface(volume)
    accused = exclude_causers(volume)
    outcomes[BLAME] = _outcome(volume, 0, truth)
    after = hull_surface(volume)
    voting = [number for number, voter in volume.voters.items() if voter.votes]
    return Trial(
        outcomes=outcomes,
        wrong=frozenset(wrong),
        accused=tuple(accused),
        suffering=tuple(sufferers(after, frames, voting)) if suffering else (),
        surfaces=(before, after),
    )


def _outcome(volume: VoteCounts, misses: int, truth: NDArray[np.bool_]) -> Outcome:
    threshold = max(1, volume.view_count - misses)
    inside = volume.hull(threshold)
    span = tiangong_features()[0]
    measured = measure(span.spec, hull_surface(volume, threshold))
    known_m = span.value or 1.0
    return Outcome(
        agreement=voxel_agreement(inside, truth),
        error_percent=None if isinstance(measured, Lost) else 100 * (measured.value / known_m - 1),
    )
