"""What an edit changed of an outline: the directed edges that came and those that went."""

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.hull.outline import Outline


def changed_edges(
    old: Outline, new: Outline
) -> tuple[Floats, NDArray[np.int64], NDArray[np.int64]]:
    """Return the edges that differ as polylines of one edge each: points, offsets, weights.

    Edges only in `new` weigh +1 and those only in `old` −1, so that sweeping them turns the votes
    of `old` into those of `new`.
    """
    before, after = _directed_edges(old), _directed_edges(new)
    gone = _not_among(before, after)
    came = _not_among(after, before)
    edges = np.concatenate([before[gone], after[came]]).view(np.float64).reshape(-1, 2)
    count = len(edges) // 2
    weights = np.ones(count, dtype=np.int64)
    weights[: np.count_nonzero(gone)] = -1
    return edges, np.arange(count + 1, dtype=np.int64) * 2, weights


def _not_among(edges: NDArray[np.void], others: NDArray[np.void]) -> NDArray[np.bool_]:
    """Return which edges are not among others; equal ones have equal bytes."""
    known = set(others.tolist())
    return np.array([edge not in known for edge in edges.tolist()], dtype=np.bool_)


def _directed_edges(outline: Outline) -> NDArray[np.void]:
    """Return each directed edge's two points as one opaque value that compares as a whole."""
    points = outline.points
    pairs = np.concatenate([points[:-1], points[1:]], axis=1)
    between_rings = outline.offsets[1:-1] - 1
    edges = np.ascontiguousarray(np.delete(pairs, between_rings, axis=0))
    return edges.view(np.dtype((np.void, 32))).ravel()
