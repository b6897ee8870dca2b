"""Hulls of resampled silhouettes: what is measured on them says how far a number can be trusted.

The hull itself, the hulls of eroded and dilated silhouettes, and one hull without each group of
frames are carved one after another on one volume by the incremental engine.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.geometry.grid import VoxelGrid
from core.hull.casting import UNWATCHED, Cancelled, Watch
from core.hull.surface import Surface
from core.hull.view import View
from core.hull.volume import VoteVolume
from core.measurement.sensitivity import displaced_views

Measure = Callable[[Surface], Floats]
"""Measures numbers (quantities,) on a surface; NaN stands for one that is lost there."""

Grouping = Literal["interleaved", "consecutive"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Resampled:
    """Numbers measured on a hull and on those of its resampled silhouettes.

    Attributes:
        values: (quantities,) on the hull itself.
        eroded: (quantities,) with every outline moved inward by `cells`.
        dilated: (quantities,) with every outline moved outward by `cells`.
        without_group: (groups, quantities) with one group of frames left out.
        cells: by how many cells outlines were moved.
        groups: of frames, as positions in the order that they were given in.
    """

    values: Floats
    eroded: Floats
    dilated: Floats
    without_group: Floats
    cells: float
    groups: tuple[NDArray[np.int64], ...]


def frame_groups(
    frames: int, groups: int, grouping: Grouping = "interleaved"
) -> tuple[NDArray[np.int64], ...]:
    """Return groups of frames, none larger than another by more than one.

    Args:
        frames: how many there are.
        groups: how many are wanted; each frame is one where there are fewer frames.
        grouping: "interleaved" deals frames out in turn, so that what is left always looks from
            all sides; "consecutive" keeps neighbours together, whose errors may be alike.

    Raises:
        ValueError: fewer than 3 frames, or fewer than 3 groups.
    """
    if frames < 3 or groups < 3:
        raise ValueError(
            "Leaving out groups of frames needs at least 3 frames that vote and 3 groups; "
            f"got {frames} frames and {groups} groups."
        )
    number = np.arange(frames)
    count = min(groups, frames)
    place = number % count if grouping == "interleaved" else number * count // frames
    return tuple(number[place == group] for group in range(count))


def resampled(
    views: Sequence[View],
    grid: VoxelGrid,
    measure: Measure,
    *,
    cells: float,
    groups: Sequence[NDArray[np.int64]],
    tolerated_misses: int = 0,
    watch: Watch = UNWATCHED,
) -> Resampled:
    """Measure the hull, those of eroded and dilated silhouettes and those without each group.

    Args:
        views: that vote, as they vote.
        grid: that they vote on.
        measure: the numbers to be measured; never called with an empty surface.
        cells: by how many pixels outlines are moved.
        groups: positions of the views that are left out together.
        tolerated_misses: a voxel stays while at most this many views miss it, also of fewer views.
        watch: is told how many hulls are done, and may cancel between them.

    Raises:
        ValueError: no views, an outline that cannot vote, or nothing left to vote without a group.
        Cancelled: `watch` said so.
    """
    if not cells > 0:
        raise ValueError(f"Outlines are moved by a positive number of cells, got {cells}.")
    total = 3 + len(groups)
    rows: list[Floats] = []
    for surface in _surfaces(views, grid, cells, groups, tolerated_misses):
        if watch.cancel():
            raise Cancelled(f"Resampling was cancelled after {len(rows)} of {total} hulls.")
        rows.append(_measured(measure, surface, like=rows[0] if rows else None))
        watch.progress(len(rows), total)
    return Resampled(
        values=rows[0],
        eroded=rows[-2],
        dilated=rows[-1],
        without_group=np.array(rows[1:-2]).reshape(len(groups), -1),
        cells=cells,
        groups=tuple(groups),
    )


def _measured(measure: Measure, surface: Surface, *, like: Floats | None) -> Floats:
    if not surface.is_empty:
        return np.asarray(measure(surface), dtype=np.float64)
    if like is None:
        raise ValueError("The hull is empty, so nothing can be measured; lower the threshold.")
    return np.full_like(like, np.nan)


def _surfaces(
    views: Sequence[View],
    grid: VoxelGrid,
    cells: float,
    groups: Sequence[NDArray[np.int64]],
    tolerated_misses: int,
) -> Iterator[Surface]:
    """Yield the hull, the hull without each group, and those of eroded and dilated outlines."""
    volume = VoteVolume(grid)
    numbers = np.array(volume.add_many(views))
    yield _surface(volume, tolerated_misses)
    for group in groups:
        volume.threshold = None  # it may not exceed the number of views, which shrinks
        for number in numbers[group].tolist():
            volume.exclude(number)
        yield _surface(volume, tolerated_misses)
        for number in numbers[group].tolist():
            volume.include(number)
    for step in (-cells, cells):
        volume = VoteVolume(grid)
        volume.add_many(displaced_views(views, step))
        yield _surface(volume, tolerated_misses)


def _surface(volume: VoteVolume, tolerated_misses: int) -> Surface:
    volume.threshold = max(1, volume.view_count - tolerated_misses)
    return volume.surface()
