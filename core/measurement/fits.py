"""Lines, planes and cylinders fitted to regions of a surface, robustly, by least squares."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import least_squares

from core.arrays import Floats
from core.hull.closed_mesh import Surface
from core.measurement.parts import Faces
from core.measurement.regions import area_vectors_m2

ROUNDS = 50
LEAST_SCALE_M = 1e-9
"""Residuals below a nanometre are rounding, not spread."""

ELONGATION = 1.5
"""How much longer than wide a region must be for a line through it to mean anything."""

LEAST_WIDTH = 1e-6
"""Share of its length below which a region is a line and spans no plane."""

MOST_POINTS = 20_000


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Cloud:
    """The points that a fit rests on.

    Attributes:
        points_m: (n, 3) vertices of the region, target frame.
        weights: (n,) share of the region's area around each.
        normal_m2: (3,) sum of the faces' outward normals times their areas.
        area_m2: of the region.
        moments_m2: (3, 3) Σ area · n nᵀ over the faces' unit normals n.
    """

    points_m: Floats
    weights: Floats
    normal_m2: Floats
    area_m2: float
    moments_m2: Floats


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Fit:
    """What was fitted.

    Attributes:
        centre_m: (3,) point on the line, plane or axis, amid the points; target frame.
        direction: (3,) unit vector along the line or axis, or the plane's normal.
        residual_m: weighted rms distance of the points from what was fitted.
        span_m: least and greatest distance of the points from `centre_m` along the line or axis;
            both 0 for a plane.
        radius_m: of a cylinder, 0 for others.
        is_undirected: whether the direction's sign means nothing.
    """

    centre_m: Floats
    direction: Floats
    residual_m: float
    span_m: tuple[float, float] = (0.0, 0.0)
    radius_m: float = 0.0
    is_undirected: bool = True

    @property
    def length_m(self) -> float:
        """Length of the points along the line or axis."""
        return self.span_m[1] - self.span_m[0]


def cloud_of(surface: Surface, faces: Faces) -> Cloud:
    """Return the vertices of some faces, each weighed by the area around it."""
    vectors = area_vectors_m2(surface, faces)
    areas = np.linalg.norm(vectors, axis=1)
    used, corners = np.unique(surface.faces[faces], return_inverse=True)
    share = np.bincount(corners.ravel(), weights=np.repeat(areas / 3, 3), minlength=len(used))
    total = float(areas.sum())
    # Broken-down faces have no area; the points then count alike.
    weights = share / total if total > 0 else np.full(len(used), 1 / len(used))
    unit = vectors / np.where(areas > 0, areas, 1.0)[:, None]
    return Cloud(
        points_m=surface.vertices_m[used],
        weights=weights,
        normal_m2=vectors.sum(axis=0),
        area_m2=total,
        moments_m2=vectors.T @ unit,
    )


def fit_line(cloud: Cloud) -> Fit:
    """Fit a straight line; its direction is undirected.

    Raises:
        ValueError: fewer than two points, or a region not clearly longer than wide.
    """
    _check_count(cloud, 2, "line")
    centre, axes, spread = _robust_axes(cloud, 2, lambda part: np.linalg.norm(part[:, :2], axis=1))
    if spread[2] < ELONGATION * spread[1]:
        raise ValueError(
            f"The region is {spread[2] / max(spread[1], LEAST_SCALE_M):.2f} times as long as wide, "
            f"so no line through it is defined; choose one at least {ELONGATION:g} times as long."
        )
    return _along(cloud, centre, axes[:, 2], lambda across: across)


def fit_plane(cloud: Cloud) -> Fit:
    """Fit a plane; its normal points out of the body where all of the region faces one way.

    Raises:
        ValueError: fewer than three points, or points on one line.
    """
    _check_count(cloud, 3, "plane")
    centre, axes, spread = _robust_axes(cloud, 0, lambda part: np.abs(part[:, 0]))
    if spread[1] <= LEAST_WIDTH * spread[2]:
        raise ValueError(
            "The points lie on one straight line, so no plane through them is defined."
        )
    normal = axes[:, 0]
    outward = float(normal @ cloud.normal_m2)
    if outward < 0:
        normal = -normal
    height = (cloud.points_m - centre) @ normal
    return Fit(
        centre_m=centre,
        direction=normal,
        residual_m=float(np.sqrt(cloud.weights @ height**2)),
        is_undirected=abs(outward) < 0.5 * cloud.area_m2,
    )


def fit_cylinder(cloud: Cloud) -> Fit:
    """Fit a circular cylinder's side; its axis is undirected.

    The start comes from the normals, which are all at right angles to the axis.

    Raises:
        ValueError: fewer than six points, or a region that bends about no axis.
    """
    _check_count(cloud, 6, "cylinder")
    _, axes = np.linalg.eigh(cloud.moments_m2)
    thin = _thinned(cloud)
    middle = thin.weights @ thin.points_m
    start, radius = _circle(thin, middle, axes)
    root = np.sqrt(thin.weights * len(thin.weights))

    def residuals(parameters: Floats) -> Floats:
        centre, direction = _axis(parameters, start, axes)
        beside = np.cross(thin.points_m - centre, direction)
        off: Floats = root * (np.linalg.norm(beside, axis=1) - parameters[4])
        return off

    first = np.array([0.0, 0.0, 0.0, 0.0, radius])
    scale = _spread(residuals(first))
    for _ in range(2):  # the spread about the first guess is that of the guess
        found = least_squares(
            residuals, first, loss="soft_l1", f_scale=scale, x_scale=[1, 1, radius, radius, radius]
        )
        first, scale = found.x, _spread(residuals(found.x))
    centre, direction = _axis(found.x, start, axes)
    return _along(cloud, centre, direction, lambda across: across - found.x[4], float(found.x[4]))


def _axis(parameters: Floats, start: Floats, axes: Floats) -> tuple[Floats, Floats]:
    """Return point and unit direction of an axis tilted and shifted across its first guess."""
    direction = axes[:, 0] + axes[:, 1:] @ parameters[:2]
    return start + axes[:, 1:] @ parameters[2:4], direction / np.linalg.norm(direction)


def _circle(cloud: Cloud, middle: Floats, axes: Floats) -> tuple[Floats, float]:
    """Return centre and radius of the circle through the points as seen along an axis.

    Source: Kåsa, "A circle fitting procedure and its error analysis", 1976.
    """
    flat = (cloud.points_m - middle) @ axes[:, 1:]
    root = np.sqrt(cloud.weights)[:, None]
    design = np.column_stack([2 * flat, np.ones(len(flat))]) * root
    right = (flat**2).sum(axis=1) * root[:, 0]
    (x, y, rest), _, rank, _ = np.linalg.lstsq(design, right, rcond=1e-9)
    if rank < 3:
        raise ValueError("The region is flat or one line, so no cylinder through it is defined.")
    return middle + axes[:, 1:] @ np.array([x, y]), float(np.sqrt(rest + x * x + y * y))


def _thinned(cloud: Cloud) -> Cloud:
    step = -(-len(cloud.points_m) // MOST_POINTS)
    weights = cloud.weights[::step]
    return replace(cloud, points_m=cloud.points_m[::step], weights=weights / weights.sum())


def _along(
    cloud: Cloud,
    centre: Floats,
    direction: Floats,
    residual: Callable[[Floats], Floats],
    radius_m: float = 0.0,
) -> Fit:
    """Return a fit along a direction, given how distances across it turn into residuals."""
    along = (cloud.points_m - centre) @ direction
    across = np.linalg.norm(cloud.points_m - centre - np.outer(along, direction), axis=1)
    middle = (along.min() + along.max()) / 2
    return Fit(
        centre_m=centre + middle * direction,
        direction=direction,
        residual_m=float(np.sqrt(cloud.weights @ residual(across) ** 2)),
        span_m=(float(along.min() - middle), float(along.max() - middle)),
        radius_m=radius_m,
    )


def _robust_axes(
    cloud: Cloud, wanted: int, distance: Callable[[Floats], Floats]
) -> tuple[Floats, Floats, Floats]:
    """Return centre, axes (columns, the shortest first) and spreads of points, outliers damped.

    `distance` gives, from coordinates along the axes, how far off the points are; `wanted` is the
    axis that the fit is after. Reweighting until it stands minimizes the "soft L1" loss of
    `scipy.optimize`, whose scale is the median distance.

    Source: Holland and Welsch, "Robust regression using iteratively reweighted least-squares",
    1977.
    """
    weights = cloud.weights
    centre = axes = spread = np.zeros(3)
    for _ in range(ROUNDS):
        before = axes
        centre = weights @ cloud.points_m / weights.sum()
        beside = cloud.points_m - centre
        squares, axes = np.linalg.eigh((beside * weights[:, None]).T @ beside / weights.sum())
        spread = np.sqrt(np.maximum(squares, 0))
        if before.ndim == 2 and abs(before[:, wanted] @ axes[:, wanted]) > 1 - 1e-15:
            break
        far = distance(beside @ axes)
        weights = cloud.weights / np.sqrt(1 + (far / _spread(far)) ** 2)
    return centre, axes, spread


def _spread(residuals: Floats) -> float:
    """Return the standard deviation that the median residual speaks of, as of normal noise."""
    return max(1.4826 * float(np.median(np.abs(residuals))), LEAST_SCALE_M)


def _check_count(cloud: Cloud, least: int, shape: str) -> None:
    if len(cloud.points_m) < least:
        raise ValueError(
            f"The region has {len(cloud.points_m)} points; a {shape} needs at least {least}. "
            "Choose a larger one."
        )
