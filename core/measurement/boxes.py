"""The box of least volume around points."""

import numpy as np
import trimesh
from scipy.optimize import minimize
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from core.arrays import Floats

FEW = 2000
"""So many points are searched as they are."""

DIRECTIONS = 200
"""Evenly over the sphere: the points farthest along them stand for all in the first search."""

TURNS = Rotation.random(1500, rng=np.random.default_rng(1)).as_matrix()
"""Attitudes, the same every time, of which the best are searched on: a box has several minima."""

STARTS, FOLLOWED = 4, 2
"""How many are searched on around few points, and how many of those around all."""

SLACK = 1e-4
"""By what share of its volume a box around the points that stand for all may miss others."""

ROUNDS = 30

FIRST_TURN = 0.03
"""Tangent of half the angle by which the search first turns a box."""


def least_box(points_m: Floats) -> tuple[Floats, Floats, Floats]:
    """Return centre (3,), axes (rows, 3 × 3) and sizes (3,) of the least box, longest side first.

    The search runs on few points that stand for all: those farthest along `DIRECTIONS`. Whatever
    sticks out of their least box joins them, and it is improved, until nothing sticks out. A box
    around few of the points is never larger than one around all, so that the end is a least box
    of all points too, within `SLACK` of its volume and as near to it as the search comes.

    Args:
        points_m: (n, 3) not all in one plane.

    Raises:
        ValueError: points in one plane, around which no box has least volume.

    Source: Chang, Gorissen and Melchior, "Fast oriented bounding box optimization on the rotation
    group SO(3, R)", 2011: Nelder and Mead's simplex over attitudes, and the least rectangle about
    each axis; faces of the convex hull as in trimesh to begin with. Points that stand for all:
    Bădoiu, Har-Peled and Indyk, "Approximate clustering via core-sets", 2002.
    """
    _check_body(points_m)
    columns = np.ascontiguousarray(points_m.T)
    standing = columns if len(points_m) <= FEW else _farthest(columns, _sphere(DIRECTIONS))
    best, least = np.eye(3), np.inf
    for start in _starts(standing):
        axes, standing = _around_all(columns, standing, start, least)
        volume = _volume(columns, axes)
        if volume < least:
            best, least = axes, volume
    return _box_along(columns, best)


def _starts(columns: Floats) -> list[Floats]:
    """Return the axes of small boxes around few points: the faces' and the best of `TURNS`."""
    to_box, _ = trimesh.bounds.oriented_bounds(columns.T)
    tried = np.concatenate([to_box[None, :3, :3], TURNS])
    volumes = np.ptp(tried.reshape(-1, 3) @ columns, axis=1).reshape(-1, 3).prod(axis=1)
    chosen = (0, *np.argsort(volumes)[:STARTS].tolist())
    improved = [_improved(columns, tried[number]) for number in chosen]
    return sorted(improved, key=lambda axes: _volume(columns, axes))[:FOLLOWED]


def _around_all(
    columns: Floats, standing: Floats, axes: Floats, least: float
) -> tuple[Floats, Floats]:
    """Return the axes of a box around all points, and the points that then stand for them.

    It begins with a box around those that stand for them, and gives up one no smaller than `least`.
    """
    for _ in range(ROUNDS):
        axes = _improved(standing, axes)
        bound = _volume(standing, axes)
        if bound >= least * (1 - SLACK) or _volume(columns, axes) <= bound * (1 + SLACK):
            break
        standing = np.column_stack([standing, _farthest(columns, np.concatenate([axes, -axes]))])
    return axes, standing


def _check_body(points_m: Floats) -> None:
    middle = points_m.mean(axis=0)
    spread = np.sqrt(np.maximum(np.linalg.eigvalsh(np.cov((points_m - middle).T)), 0))
    if len(points_m) < 4 or spread[0] <= 1e-7 * spread[2]:
        raise ValueError("The points lie in one plane; a box of least volume needs a body.")


def _sphere(count: int) -> Floats:
    """Return unit vectors (count, 3) spread evenly, after Fibonacci."""
    number = np.arange(count) + 0.5
    height, turn = 1 - 2 * number / count, np.pi * (1 + np.sqrt(5)) * number
    width = np.sqrt(1 - height**2)
    return np.column_stack([width * np.cos(turn), width * np.sin(turn), height])


def _farthest(columns: Floats, directions: Floats) -> Floats:
    """Return the points (3, n) farthest along each direction (rows)."""
    found = {int(np.argmax(direction @ columns)) for direction in directions}
    farthest: Floats = columns[:, sorted(found)]
    return farthest


def _volume(columns: Floats, axes: Floats) -> float:
    along = axes @ columns
    sizes = along.max(axis=1) - along.min(axis=1)
    return float(sizes[0] * sizes[1] * sizes[2])


def _turned(axes: Floats, by: Floats) -> Floats:
    """Return axes turned about `by` by twice the arc tangent of its length, after Rodrigues."""
    x, y, z = by
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    rows: Floats = axes + 2 / (1 + by @ by) * (axes @ (cross + cross @ cross))
    return rows


def _improved(columns: Floats, axes: Floats) -> Floats:
    """Turn a box until its volume is least nearby; it may stand as it is."""
    before = _volume(columns, axes)
    found = minimize(
        lambda by: _volume(columns, _turned(axes, by)) / before,
        np.zeros(3),
        method="Nelder-Mead",
        options={
            "initial_simplex": np.concatenate([np.zeros((1, 3)), FIRST_TURN * np.eye(3)]),
            "xatol": 1e-5,
            "fatol": 1e-7,
        },
    )
    axes = _turned(axes, found.x) if found.fun < 1 - 1e-12 else axes
    for held in range(3):
        axes = _least_about(columns, axes, held)
    return axes


def _least_about(columns: Floats, axes: Floats, held: int) -> Floats:
    """Turn a box about one of its axes until it is least: an edge of the points then lies in it."""
    first, second = (axes[number] for number in range(3) if number != held)
    flat = np.column_stack([first @ columns, second @ columns])
    rim = flat[ConvexHull(flat).vertices]
    edges = np.roll(rim, -1, axis=0) - rim
    unit = edges / np.linalg.norm(edges, axis=1, keepdims=True)
    beside = unit[:, ::-1] * [-1, 1]
    areas = np.ptp(unit @ rim.T, axis=1) * np.ptp(beside @ rim.T, axis=1)
    best = int(np.argmin(areas))
    if areas[best] >= np.prod(np.ptp(flat, axis=0)) * (1 - 1e-12):
        return axes
    x, y = unit[best]
    return np.array([axes[held], x * first + y * second, x * second - y * first])


def _box_along(columns: Floats, axes: Floats) -> tuple[Floats, Floats, Floats]:
    along = axes @ columns
    lower, upper = along.min(axis=1), along.max(axis=1)
    order = np.argsort(lower - upper, kind="stable")
    rows = axes[order]
    if np.linalg.det(rows) < 0:
        rows[2] = -rows[2]
    return (lower + upper) / 2 @ axes, rows, (upper - lower)[order]
