"""Casting votes: sweeping the outlines of many views through a volume, thread by thread."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from core.hull.pullback import PulledBack, joined
from core.hull.sweep import sweep_planes
from core.hull.threads import chunks, in_parallel

Planes = tuple[int, int]


class Cancelled(Exception):  # noqa: N818 - nothing went wrong
    """Whoever asked for a long computation does not want it any more."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Watch:
    """What a long computation tells, and asks, on its way.

    Attributes:
        progress: told how many parts are done, and how many there are; threads take turns.
        cancel: asked before each part whether to give up, like `threading.Event.is_set`.
    """

    progress: Callable[[int, int], None] = lambda _done, _total: None
    cancel: Callable[[], bool] = lambda: False


UNWATCHED = Watch()


def cast(
    votes: NDArray[Any],
    parts: Sequence[PulledBack],
    axes: Sequence[int],
    limit: int = 0,
    watch: Watch = UNWATCHED,
) -> NDArray[np.bool_]:
    """Add the votes of pulled-back polylines, those of each line axis in one sweep.

    Args:
        votes: (nx, ny, nz) of an unsigned type; changed in place.
        parts: what to sweep.
        axes: along which axis each.
        limit: votes at which a voxel enters or leaves the hull; 0 when nobody wants to know.
        watch: is told the progress, and may cancel; the votes are then as they were before.

    Returns:
        (nx,) in which planes x a voxel's votes passed the limit, either way.

    Raises:
        Cancelled: `watch` said so.
    """
    flipped = np.zeros(votes.shape[0], dtype=np.bool_)
    sweeps = [
        (axis, joined([part for part, of in zip(parts, axes, strict=True) if of == axis]))
        for axis in sorted(set(axes))
    ]
    spans = {axis: chunks(votes.shape[1 - axis]) for axis, _ in sweeps}
    total, done = sum(map(len, spans.values())), 0
    swept: list[tuple[int, PulledBack, list[Planes]]] = []
    for axis, outlines in sweeps:
        ran = _sweep(votes, axis, outlines, spans[axis], limit, flipped, watch.cancel)
        swept.append((axis, outlines, ran))
        done += len(ran)
        watch.progress(done, total)
    if done < total:
        _take_back(votes, swept)
        raise Cancelled(f"The vote was cancelled after {done} of {total} parts and taken back.")
    return flipped


def _sweep(
    votes: NDArray[Any],
    axis: int,
    swept: PulledBack,
    spans: Sequence[Planes],
    limit: int,
    flipped: NDArray[np.bool_],
    cancel: Callable[[], bool],
) -> list[Planes]:
    """Sweep ranges of planes until told to stop, and return those that were swept."""
    weights = swept.weights.astype(votes.dtype)

    def work(planes: Planes) -> bool:
        if cancel():
            return False
        sweep_planes(
            votes,
            axis,
            *planes,
            swept.place,
            swept.crossing,
            swept.flips,
            swept.offsets,
            weights,
            votes.dtype.type(limit),
            flipped,
        )
        return True

    ran = in_parallel(work, spans)
    return [planes for planes, did in zip(spans, ran, strict=True) if did]


def _take_back(votes: NDArray[Any], swept: Sequence[tuple[int, PulledBack, list[Planes]]]) -> None:
    """Sweep the same planes with the opposite sign."""
    unseen = np.zeros(votes.shape[0], dtype=np.bool_)
    for axis, outlines, spans in swept:
        opposite = replace(outlines, weights=-outlines.weights)
        _sweep(votes, axis, opposite, spans, 0, unseen, lambda: False)
