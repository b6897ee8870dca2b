"""Errors of outlines, as thresholds, tracking and speckle make them."""

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.random import Generator

from core.arrays import Floats
from core.hull.outline import closed_rings
from core.hull.view import View

VERTEX_STEP_PX = 2.0
"""Between vertices, below any correlation length of interest."""


@dataclass(frozen=True, slots=True, kw_only=True)
class OutlineNoise:
    """Standard deviations, in pixels, of what is wrong with outlines; all normal, mean zero.

    Attributes:
        common_px: edge of all frames moved outward alike: a threshold's bias.
        size_px: edge of each frame moved outward by itself: its own threshold.
        offset_px: each frame moved in row and column: what registration leaves.
        ripple_px: each vertex moved across the edge: speckle.
        correlation_px: standard deviation of the Gaussian in which the ripple of two vertices is
            alike, by their distance in the image; a few resolution cells.
    """

    common_px: float = 0.3
    size_px: float = 0.1
    offset_px: float = 0.15
    ripple_px: float = 0.2
    correlation_px: float = 5.0

    @property
    def common_95_px(self) -> float:
        """What the common error stays below in 95 % of all draws: the sensitivity's cells."""
        return 1.96 * self.common_px


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class NoisyOutline:
    """A view whose outline can be drawn with errors.

    Attributes:
        view: with the true outline.
        points: (vertices, 2) of all rings, also along straight edges.
        ends: (rings + 1,) where each starts.
        outward: (vertices, 2) by how much a vertex moves when the edges meeting there move
            outward by one pixel.
        ripple: (vertices, vertices) from independent to correlated unit normal numbers.
    """

    view: View
    points: Floats
    ends: tuple[int, ...]
    outward: Floats
    ripple: Floats

    @classmethod
    def of(cls, view: View, noise: OutlineNoise) -> "NoisyOutline":
        """Make a view ready to be drawn often."""
        rings = [_subdivided(ring) for ring in view.silhouette.rings]
        points = np.concatenate(rings)
        apart = np.linalg.norm(points[:, None] - points[None], axis=-1)
        alike = np.exp(-0.5 * (apart / noise.correlation_px) ** 2)
        return cls(
            view=view,
            points=points,
            ends=tuple(np.cumsum([0] + [len(ring) for ring in rings]).tolist()),
            outward=np.concatenate([_outward(ring) for ring in rings]),
            # Alone, the Gaussian's matrix is positive only up to rounding.
            ripple=np.linalg.cholesky(alike + 1e-6 * np.eye(len(points))),
        )

    def drawn(self, noise: OutlineNoise, common_px: float, random: Generator) -> View:
        """Return the view with an outline in error, `common_px` of it shared by all frames."""
        moved_px = common_px + noise.size_px * random.normal()
        ripple_px = noise.ripple_px * (self.ripple @ random.normal(size=len(self.points)))
        offset_px = noise.offset_px * random.normal(size=2)
        points = self.points + offset_px + self.outward * (moved_px + ripple_px)[:, None]
        rings = tuple(points[first:end] for first, end in pairwise(self.ends))
        return replace(self.view, silhouette=replace(self.view.silhouette, rings=rings))


def drawn_views(outlines: list[NoisyOutline], noise: OutlineNoise, random: Generator) -> list[View]:
    """Draw all outlines once."""
    common_px = noise.common_px * random.normal()
    return [outline.drawn(noise, common_px, random) for outline in outlines]


def _subdivided(ring: Floats) -> Floats:
    """Return a ring with more vertices along its edges, its own among them."""
    closed, _ = closed_rings((ring,))
    pieces = [
        np.linspace(a, b, max(1, round(np.hypot(*(b - a)) / VERTEX_STEP_PX)), endpoint=False)
        for a, b in pairwise(closed)
    ]
    return np.concatenate(pieces)


def _outward(ring: Floats) -> Floats:
    along = np.roll(ring, -1, axis=0) - ring
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    # Rings run with the inside on their right, holes too.
    normal = np.column_stack([-along[:, 1], along[:, 0]])
    both = normal + np.roll(normal, 1, axis=0)
    # At needles' tips the edges would meet far away.
    outward: Floats = 2 * both / np.maximum((both**2).sum(axis=1, keepdims=True), 0.5)
    return outward
