"""Line features out of factorized tracks: perfect, spoilt by glint, and with points missing."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from core.arrays import Floats
from core.experiments.lines_found import LinesFound, line_found
from core.experiments.mro_scene import Motion
from core.factorization.alignment import oriented_by_lines_of_sight
from core.factorization.factorization import UnobservableShape, factorize
from core.factorization.tracks import Glint
from core.targets import LineFeature

NOISE_CELLS = 0.3
"""Of a point's place, where the tracks are not perfect."""

PERFECT = Glint()
NOISY = Glint(noise_cells=NOISE_CELLS)
GLINTING = Glint(visible=0.7, jump=0.1, noise_cells=NOISE_CELLS)

CASES: tuple[tuple[str, Glint, bool], ...] = (
    ("perfect association", PERFECT, False),
    ("noise of 0.3 cells", NOISY, False),
    ("30 % missing, 10 % wrong", GLINTING, False),
    ("the same, robust loss", GLINTING, True),
)
"""Name, glint, and whether the loss is robust."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Tracked:
    """Scatterers and how they are seen.

    Attributes:
        points_m: (points, 3), the lines' ends first, target frame.
        motion: of the line of sight.
        scaled: whether cross-range comes in metres.
        seed: of glint.
    """

    points_m: Floats
    motion: Motion
    scaled: bool
    seed: int


def factored(
    tracked: Tracked,
    features: Sequence[LineFeature],
    *,
    name: str,
    glint: Glint = PERFECT,
    robust: bool = False,
    even_if_ambiguous: bool = False,
) -> LinesFound:
    """Return the lines between the features' ends in a factorization, in true attitude.

    The shape is turned by the known lines of sight, as a tracking radar can.

    Args:
        tracked: scatterers and how they are seen.
        features: the truth, whose ends are the first points, two each.
        name: what the row is called.
        glint: what spoils the tracks.
        robust: see `factorize`.
        even_if_ambiguous: see `factorize`.
    """
    lost = (None,) * len(features)
    tracks = tracked.motion.tracks(
        tracked.points_m, glint, np.random.default_rng(tracked.seed), scaled=tracked.scaled
    )
    try:
        found = factorize(
            tracks, scaled=tracked.scaled, robust=robust, even_if_ambiguous=even_if_ambiguous
        )
    except UnobservableShape:
        return LinesFound(method=name, lines=lost, note="unobservable")
    except ValueError:
        return LinesFound(method=name, lines=lost, note="too few points")
    shape = np.full_like(tracked.points_m, np.nan)
    shape[found.points] = oriented_by_lines_of_sight(found, tracked.motion.line_of_sight)
    ends = shape[: 2 * len(features)].reshape(-1, 2, 3)
    return LinesFound(method=name, lines=tuple(map(line_found, features, ends)))


def with_known_length(found: LinesFound, known: int, *, suffix: str) -> LinesFound:
    """Return the same lines scaled so that one of them has its true length."""
    reference = found.lines[known]
    name = f"{found.method}{suffix}"
    if reference is None:
        return replace(found, method=name, lines=(None,) * len(found.lines), note="lost")
    scaled = tuple(
        None if line is None else replace(line, length_m=line.length_m * reference.scale_factor)
        for line in found.lines
    )
    return LinesFound(method=name, lines=scaled)


def missing_cases(
    tracked: Tracked,
    features: Sequence[LineFeature],
    shares: Sequence[float],
    *,
    jump: float = 0.0,
) -> dict[float, LinesFound]:
    """Return factorizations with shares of the points missing and the rest noisy, by the share.

    Args:
        tracked: scatterers and how they are seen.
        features: the truth.
        shares: of points missing in each frame.
        jump: probability that a point is a neighbour's.
    """
    wrong = f" and {100 * jump:.0f} % wrong" if jump else ""
    return {
        share: factored(
            tracked,
            features,
            name=f"factorization, {100 * share:.0f} % missing{wrong}",
            glint=replace(NOISY, visible=1 - share, jump=jump),
        )
        for share in shares
    }
