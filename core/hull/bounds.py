"""Where a hull can lie at all, from the views alone."""

from collections.abc import Sequence

import numpy as np
from scipy.optimize import OptimizeResult, linprog

from core.arrays import Floats
from core.hull.view import View


def hull_bounds_m(views: Sequence[View]) -> tuple[Floats, Floats]:
    """Return the box (lower, upper), each (3,) in the target frame, that the views leave.

    Each silhouette lies in a rectangle of its image, whose four sides are four planes in space:
    they bound a polyhedron that holds the hull, and a linear programme finds how far it reaches
    along each axis. Perspective cameras are taken to look at the target, not away from it.

    Raises:
        ValueError: an empty silhouette, views that leave a direction unbounded, or views that
            contradict each other.
    """
    if not views or any(view.silhouette.is_empty for view in views):
        raise ValueError("Bounds need at least one view, and a silhouette in each of them.")
    half_spaces = np.concatenate([_half_spaces(view) for view in views])
    reaches = np.array([[_reach_m(half_spaces, axis, sign) for axis in "xyz"] for sign in (-1, 1)])
    return reaches[0], reaches[1]


def confined_widths_m(views: Sequence[View]) -> Floats:
    """Return how wide the views let the hull be along x, y and z, (3,), infinite where open.

    It is the width of the box of `hull_bounds_m`, axis by axis, without a grid's help.

    Raises:
        ValueError: an empty silhouette.
    """
    widths = np.empty(3)
    if not views or any(view.silhouette.is_empty for view in views):
        raise ValueError("Widths need at least one view, and a silhouette in each of them.")
    half_spaces = np.concatenate([_half_spaces(view) for view in views])
    for axis in range(3):
        low, high = (_programme(half_spaces, axis, sign) for sign in (-1, 1))
        both = low.status == 0 and high.status == 0
        widths[axis] = -high.fun - low.fun if both else np.inf
    return widths


def _half_spaces(view: View) -> Floats:
    """Return rows (4 or 5, 4) with row · (x, y, z, 1) ≤ 0 inside the silhouette's rectangle."""
    matrix = view.projection.matrix
    depth = np.array([0.0, 0.0, 0.0, 1.0]) if view.projection.is_affine else matrix[2]
    points = np.concatenate(view.silhouette.rings)
    lower, upper = points.min(axis=0), points.max(axis=0)
    sides = [lower[i] * depth - matrix[i] for i in range(2)]
    sides += [matrix[i] - upper[i] * depth for i in range(2)]
    if not view.projection.is_affine:
        sides.append(-depth)
    rows: Floats = np.array(sides)
    rows /= np.linalg.norm(rows[:, :3], axis=1, keepdims=True)
    return rows


def _reach_m(half_spaces: Floats, axis: str, sign: int) -> float:
    """Return the least (sign −1) or greatest (+1) coordinate along an axis."""
    solved = _programme(half_spaces, "xyz".index(axis), sign)
    if solved.status == 3:
        raise ValueError(
            f"The views leave the target unbounded along {axis}; add a view from elsewhere."
        )
    if solved.status != 0:
        raise ValueError(
            "No point lies in all silhouettes, or the programme failed "
            f"({solved.message.strip()}); check that the cameras belong to the pictures."
        )
    return float(-sign * solved.fun)


def _programme(half_spaces: Floats, axis: int, sign: int) -> OptimizeResult:
    """Minimise −sign times the coordinate along an axis inside all half-spaces."""
    objective = np.zeros(3)
    objective[axis] = -sign
    return linprog(
        objective,
        A_ub=half_spaces[:, :3],
        b_ub=-half_spaces[:, 3],
        bounds=(None, None),
        method="highs",
    )
