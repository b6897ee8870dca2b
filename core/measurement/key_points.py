"""Key points: corners marked in several frames, placed in space by least squares.

It is the paper's mixed feature: where a line has no extent to be measured on the hull, its two ends
are marked where they are seen, and every mark gives two equations for a point's three coordinates.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import stats
from scipy.optimize import least_squares

from core.arrays import Floats, frozen
from core.geometry.projection import Projection

MOST_UNEVEN = 30.0
"""Standard error along the least determined direction over that along the best: past it, the
frames' image planes all but coincide (two of them within about 4°) and the point is refused."""

CONFIDENCE = 0.95


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class KeyPoint:
    """A corner's place in space, as its marks tell it.

    Attributes:
        name: what a person calls it.
        position_m: (3,), target frame.
        covariance_m2: (3, 3) of the position, from independent errors of the marks.
        residuals_px: (frames, 2) marked less projected (row, column).
        sigma_px: standard deviation of a mark's row or column.
        degrees_of_freedom: of the residuals that `sigma_px` was estimated from; 0 where it was
            given.
    """

    name: str
    position_m: Floats
    covariance_m2: Floats
    residuals_px: Floats
    sigma_px: float
    degrees_of_freedom: int

    def __post_init__(self) -> None:
        for field, shape in (
            ("position_m", (3,)),
            ("covariance_m2", (3, 3)),
            ("residuals_px", (None, 2)),
        ):
            checked = frozen(getattr(self, field), np.float64, shape, f"{self.name}, {field}")
            object.__setattr__(self, field, checked)

    @property
    def residual_px(self) -> Floats:
        """(frames,) distance between mark and projected point in each frame."""
        distances: Floats = np.linalg.norm(self.residuals_px, axis=1)
        return distances


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class KeyPointLength:
    """A length between two key points.

    Attributes:
        value_m: the distance.
        direction: (3,) unit vector from the first to the second, target frame.
        standard_error_m: from both points' covariances.
        low_m, high_m: the 95 % interval.
    """

    value_m: float
    direction: Floats
    standard_error_m: float
    low_m: float
    high_m: float

    def __post_init__(self) -> None:
        checked = frozen(self.direction, np.float64, (3,), "Direction of a length")
        object.__setattr__(self, "direction", checked)


def located(
    name: str,
    projections: Sequence[Projection],
    marks_px: Floats,
    *,
    sigma_px: float | None = None,
) -> KeyPoint:
    """Return where in space a corner is that was marked in two or more frames.

    Args:
        name: of the corner, for people to read.
        projections: of the frames, parallel or perspective.
        marks_px: (frames, 2) where it was marked in each, as (row, column).
        sigma_px: standard deviation of a mark's row or column; None takes it from the residuals.

    Raises:
        ValueError: fewer than two frames, frames that all look along one line, a point behind a
            camera, or a sigma that is not positive.

    Source: the covariance is σ² (JᵀJ)⁻¹, J being the projections' derivative at the solution, and
    σ² the residuals' squares over their number less three (Hartley and Zisserman, "Multiple View
    Geometry", 2004, section 5.2).
    """
    marks = frozen(marks_px, np.float64, (len(projections), 2), f"Marks of {name}")
    if len(projections) < 2:
        raise ValueError(
            f"{name} is marked in {len(projections)} frame(s); mark the same corner in at least "
            "two frames that look from different sides."
        )
    if sigma_px is not None and not (np.isfinite(sigma_px) and sigma_px > 0):
        raise ValueError(f"The marks' standard deviation must be positive pixels, got {sigma_px}.")
    position = _linear_solution(projections, marks)
    if not all(projection.is_affine for projection in projections):
        position = _refined(projections, marks, position)
    jacobian = np.concatenate([image_derivative(each, position) for each in projections])
    _check_determined(name, jacobian)
    _check_in_front(name, projections, position)
    residuals = marks - _seen(projections, position)
    freedom = 0 if sigma_px is not None else 2 * len(marks) - 3
    sigma = np.sqrt(float((residuals**2).sum()) / freedom) if sigma_px is None else sigma_px
    return KeyPoint(
        name=name,
        position_m=position,
        covariance_m2=sigma**2 * np.linalg.inv(jacobian.T @ jacobian),
        residuals_px=residuals,
        sigma_px=float(sigma),
        degrees_of_freedom=freedom,
    )


def length_between(first: KeyPoint, second: KeyPoint) -> KeyPointLength:
    """Return the length between two key points, whose marks are taken to err independently.

    The interval is Student's where a standard deviation was estimated, of the fewer degrees of
    freedom, and the normal distribution's where it was given.

    Raises:
        ValueError: the points coincide.
    """
    step = second.position_m - first.position_m
    value_m = float(np.linalg.norm(step))
    if not value_m > 0:
        raise ValueError(
            f"{first.name} and {second.name} are the same point, so there is no length between "
            "them; mark two different corners."
        )
    direction = step / value_m
    variance = direction @ (first.covariance_m2 + second.covariance_m2) @ direction
    error_m = float(np.sqrt(variance))
    estimated = [p.degrees_of_freedom for p in (first, second) if p.degrees_of_freedom]
    upper = 0.5 + 0.5 * CONFIDENCE
    factor = float(stats.t.ppf(upper, min(estimated)) if estimated else stats.norm.ppf(upper))
    return KeyPointLength(
        value_m=value_m,
        direction=direction,
        standard_error_m=error_m,
        low_m=value_m - factor * error_m,
        high_m=value_m + factor * error_m,
    )


def image_derivative(projection: Projection, at_m: Floats) -> Floats:
    """Return the (2, 3) derivative of (row, column) by metres at a target point (3,)."""
    linear = projection.matrix[:, :3]
    if projection.is_affine:
        return linear
    depth = projection.matrix[2] @ [*at_m, 1.0]
    derivative: Floats = (linear[:2] - np.outer(projection.image_points(at_m), linear[2])) / depth
    return derivative


def _seen(projections: Sequence[Projection], position: Floats) -> Floats:
    return np.array([projection.image_points(position) for projection in projections])


def _linear_solution(projections: Sequence[Projection], marks: Floats) -> Floats:
    """Solve the marks' equations: exact for parallel projections, a first guess for others."""
    rows = np.concatenate(
        [_equations(each, mark) for each, mark in zip(projections, marks, strict=True)]
    )
    solution: Floats = np.linalg.lstsq(rows[:, :3], -rows[:, 3], rcond=None)[0]
    return solution


def _equations(projection: Projection, mark: Floats) -> Floats:
    """Return (2, 4) rows that a homogeneous point seen at the mark makes zero."""
    if projection.is_affine:
        shift = np.zeros((2, 4))
        shift[:, 3] = mark
        affine: Floats = projection.matrix - shift
        return affine
    rows: Floats = projection.matrix[:2] - np.outer(mark, projection.matrix[2])
    # In units of the image, or a camera's arbitrary scale would weigh its equations.
    return rows / np.linalg.norm(projection.matrix[2, :3])


def _check_determined(name: str, jacobian: Floats) -> None:
    """Refuse frames that leave a direction undetermined, and say which."""
    _, sizes, directions = np.linalg.svd(jacobian, full_matrices=False)
    if sizes[-1] * MOST_UNEVEN < sizes[0]:
        x, y, z = directions[-1] * np.sign(directions[-1][np.argmax(abs(directions[-1]))])
        raise ValueError(
            f"The frames in which {name} is marked all look along nearly the same line, "
            f"({x:.2f}, {y:.2f}, {z:.2f}), so its place along that is not determined; "
            "mark it in a frame that looks from another side."
        )


def _refined(projections: Sequence[Projection], marks: Floats, start: Floats) -> Floats:
    """Return the point that minimises the squared distances from the marks, in pixels."""

    def residuals(position: Floats) -> Floats:
        return (_seen(projections, position) - marks).ravel()

    def derivative(position: Floats) -> Floats:
        return np.concatenate([image_derivative(each, position) for each in projections])

    position: Floats = least_squares(residuals, start, jac=derivative, x_scale="jac").x
    return position


def _check_in_front(name: str, projections: Sequence[Projection], position: Floats) -> None:
    depths = [p.matrix[2] @ [*position, 1.0] for p in projections if not p.is_affine]
    if any(depth <= 0 for depth in depths):
        raise ValueError(
            f"{name} would lie behind a camera; check that its marks belong to the same corner."
        )
