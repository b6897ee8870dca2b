"""What a factorization is worth: alignment to the truth, lengths and attitude of known lines."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import orthogonal_procrustes

from core.arrays import Floats, frozen
from core.factorization.factorization import Factorization
from core.measurement.lines import angle_between_lines_rad
from core.targets import LineFeature


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Alignment:
    """The similarity that lays a shape onto another: scale · orthogonal · p + translation.

    Attributes:
        orthogonal: (3, 3), with determinant −1 where the shape came out mirrored.
        scale: 1 unless it was fitted.
        translation_m: (3,).
        rms_m: distance of the points after it.
    """

    orthogonal: Floats
    scale: float
    translation_m: Floats
    rms_m: float

    def __post_init__(self) -> None:
        for name, shape in (("orthogonal", (3, 3)), ("translation_m", (3,))):
            object.__setattr__(self, name, frozen(getattr(self, name), np.float64, shape, name))

    def apply(self, points_m: Floats) -> Floats:
        """Return points (…, 3) after the similarity."""
        moved: Floats = self.scale * (points_m @ self.orthogonal.T) + self.translation_m
        return moved


@dataclass(frozen=True, slots=True, kw_only=True)
class LineComparison:
    """A line feature as measured, beside the truth.

    Attributes:
        name: what a person calls it.
        length_m: measured.
        true_length_m: of the feature.
        attitude_error_rad: angle between the measured and the true line, 0 … π/2.
    """

    name: str
    length_m: float
    true_length_m: float
    attitude_error_rad: float

    @property
    def length_error(self) -> float:
        """Return measured over true length, less one."""
        return self.length_m / self.true_length_m - 1

    @property
    def scale_factor(self) -> float:
        """Return b, the true over the measured length."""
        return self.true_length_m / self.length_m


def align(shape_m: Floats, truth_m: Floats, *, with_scale: bool = False) -> Alignment:
    """Return the alignment of a shape (points, 3) to the truth (points, 3), least in squares.

    The most that the truth can do for a factorization: nobody has it in practice, where
    `oriented_by_lines_of_sight` is what a tracking radar gives.

    Source: Schönemann, "A generalized solution of the orthogonal Procrustes problem", 1966, with
    reflections, which factorization leaves open.
    """
    shape = frozen(shape_m, np.float64, (None, 3), "Shape")
    truth = frozen(truth_m, np.float64, shape.shape, "True points")
    shape_centre, truth_centre = shape.mean(axis=0), truth.mean(axis=0)
    turn, trace = orthogonal_procrustes(shape - shape_centre, truth - truth_centre)
    scale = float(trace / np.sum((shape - shape_centre) ** 2)) if with_scale else 1.0
    alignment = Alignment(
        orthogonal=turn.T,
        scale=scale,
        translation_m=truth_centre - scale * shape_centre @ turn,
        rms_m=0.0,
    )
    distance = alignment.apply(shape) - truth
    return Alignment(
        orthogonal=alignment.orthogonal,
        scale=scale,
        translation_m=alignment.translation_m,
        rms_m=float(np.sqrt(np.mean(np.sum(distance**2, axis=1)))),
    )


def oriented_by_lines_of_sight(factorization: Factorization, line_of_sight: Floats) -> Floats:
    """Return the shape (points found, 3) in the target frame, turned by the known lines of sight.

    Args:
        factorization: in a frame of its own.
        line_of_sight: (frames, 3) unit vectors k of all frames of the tracks, target frame.

    The turn is the orthogonal one, reflections included, that best takes the recovered lines of
    sight to the known ones.
    """
    known = frozen(line_of_sight, np.float64, (None, 3), "Lines of sight")
    turn, _ = orthogonal_procrustes(factorization.line_of_sight, known[factorization.frames])
    shape: Floats = factorization.shape_m @ turn
    return shape


def compare_lines(
    shape_m: Floats,
    ends: NDArray[np.int64],
    features: Sequence[LineFeature],
    *,
    known: int | None = None,
) -> tuple[LineComparison, ...]:
    """Compare the distances between pairs of points with true line features.

    Args:
        shape_m: (points, 3), turned into the target frame.
        ends: (lines, 2) numbers of the two end points in the shape.
        features: the truth, one for each line.
        known: number of a line whose length is known and scales the shape; None takes the shape as
            it came.

    Raises:
        ValueError: not as many lines as features, or a line whose ends coincide.
    """
    ends = np.asarray(ends)
    if ends.shape != (len(features), 2):
        raise ValueError(
            f"Each of the {len(features)} features needs two end points, got {ends.shape}."
        )
    lines = shape_m[ends[:, 1]] - shape_m[ends[:, 0]]
    lengths_m = np.linalg.norm(lines, axis=1)
    if not np.all(lengths_m > 0):
        raise ValueError("A line's two end points coincide, so that it has no direction.")
    scale = 1.0 if known is None else features[known].length_m / float(lengths_m[known])
    return tuple(
        LineComparison(
            name=feature.name,
            length_m=scale * float(length_m),
            true_length_m=feature.length_m,
            attitude_error_rad=angle_between_lines_rad(line, feature.direction),
        )
        for feature, line, length_m in zip(features, lines, lengths_m, strict=True)
    )
