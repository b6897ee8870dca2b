"""How often a stated 95 % interval holds the truth: many draws of outlines on a small case."""

from collections.abc import Callable
from dataclasses import asdict

import numpy as np
import trimesh
from scipy.spatial.transform import Rotation

from core.arrays import Floats
from core.experiments.outline_noise import NoisyOutline, OutlineNoise, drawn_views
from core.experiments.results import Figure, Results, Table
from core.experiments.true_outline import true_silhouette
from core.geometry.grid import VoxelGrid
from core.geometry.projection import Projection
from core.hull.hull_only import carved_surface
from core.hull.surface import Surface, mask_surface
from core.hull.view import View
from core.measurement.intervals import Interval, measured_intervals
from core.measurement.lines import principal_lines
from core.targets import Target

Progress = Callable[[str, int, int], None]

PIXEL_M = 0.1
IMAGE_SHAPE = (128, 128)
GRID = VoxelGrid.cube(side_m=10.0, spacing_m=0.25)

ATTITUDE = Rotation.from_euler("xyz", (0.3, 0.4, 0.5))
"""The body stands askew in the grid, so that no face is flattered by lying in voxel planes."""

NAMES = ("span", "body length", "diameter")

QUANTITIES = (
    *((name, "m") for name in NAMES),
    ("attitude about the body's z", "°"),
    ("attitude about the body's x", "°"),
)
"""Extents along the principal axes, longest first, and how the longest is turned."""


def interval_coverage(
    *,
    draws: int = 200,
    views: int = 60,
    view_sets: int = 4,
    groups: int = 10,
    tolerated_misses: int = 0,
    noise: OutlineNoise | None = None,
    seed: int = 1,
    progress: Progress = lambda _stage, _done, _total: None,
) -> Results:
    """Draw outlines in error, measure with intervals, and count how often they hold the truth.

    The truth that an interval is held against is the number measured on the hull of the same views
    with true outlines. The share that also holds the body's own number is reported beside it: a
    hull is larger than its body, and no error of the outlines tells by how much.

    Args:
        draws: of all outlines.
        views: random directions over the sphere.
        view_sets: of that many views; the draws are shared out among them.
        groups: of frames, left out in turn.
        tolerated_misses: a voxel stays while at most this many views miss it.
        noise: of the outlines.
        seed: of the random generator.
        progress: told of stage, draws done and draws in all.

    Raises:
        ValueError: fewer draws than sets of views, or fewer than 3 views.
    """
    if not 1 <= view_sets <= draws:
        raise ValueError(
            f"Coverage takes at least one draw of each set of views; got {draws} draws of "
            f"{view_sets} sets."
        )
    noise = noise or OutlineNoise()
    drawn: list[tuple[Interval, ...]] = []
    truths: list[Floats] = []
    for number, random in enumerate(np.random.default_rng(seed).spawn(view_sets)):
        outlines = [NoisyOutline.of(view, noise) for view in _true_views(views, random)]
        surface = carved_surface([o.view for o in outlines], GRID, views - tolerated_misses)
        truth = measured(surface)
        while len(drawn) < draws * (number + 1) // view_sets:
            intervals = measured_intervals(
                drawn_views(outlines, noise, random),
                GRID,
                measured,
                cells=noise.common_95_px,
                groups=groups,
                tolerated_misses=tolerated_misses,
            )
            drawn.append(intervals)
            truths.append(truth)
            progress("draws", len(drawn), draws)
    figures = _all_figures(drawn, np.array(truths))
    settings = {
        "draws": draws,
        "views": views,
        "view_sets": view_sets,
        "groups": groups,
        "tolerated_misses": tolerated_misses,
        "spacing_m": GRID.spacing_m,
        "pixel_m": PIXEL_M,
        **asdict(noise),
        "seed": seed,
    }
    return Results(
        name="interval coverage",
        settings=settings,
        figures=tuple(figure for row in figures for figure in row),
        tables=(_table(figures),),
    )


def measured(surface: Surface) -> Floats:
    """Return the `QUANTITIES` of a surface, (5,) in metres and degrees."""
    lines = principal_lines(surface, NAMES)
    x, y, z = ATTITUDE.as_matrix().T
    direction = lines[0].direction * np.sign(lines[0].direction @ y)
    about_z, about_x = np.arctan2([direction @ x, direction @ z], direction @ y)
    return np.array([*(line.length_m for line in lines), np.rad2deg(about_z), np.rad2deg(about_x)])


def small_satellite() -> Target:
    """Return a body of 4 × 1.8 × 1.8 m with a tilted panel of 7 × 1.2 × 0.3 m across its rear."""
    body = trimesh.creation.box(extents=(4.0, 1.8, 1.8))
    panel = trimesh.creation.box(extents=(1.2, 7.0, 0.3))
    panel.apply_transform(trimesh.transformations.rotation_matrix(0.4, [0, 1, 0]))
    panel.apply_translation([-1.0, 0.0, 0.0])
    turn = np.eye(4)
    turn[:3, :3] = ATTITUDE.as_matrix()
    for part in (body, panel):
        part.apply_transform(turn)
    return Target(name="small satellite", parts=(body, panel))


def body_truth() -> Floats:
    """Return the `QUANTITIES` of the body itself: axes of its voxels, lengths of its corners."""
    target = small_satellite()
    grid = VoxelGrid.cube(side_m=8.0, spacing_m=0.1)
    voxels = mask_surface(target.voxels(grid), grid)
    axes = np.array([line.direction for line in principal_lines(voxels, NAMES)])
    lengths_m = np.ptp(np.asarray(target.mesh().vertices) @ axes.T, axis=0)
    return np.array([*lengths_m, *measured(voxels)[3:]])


def _true_views(count: int, random: np.random.Generator) -> list[View]:
    mesh = small_satellite().mesh()
    centre = 0.5 * (np.array(IMAGE_SHAPE) - 1)
    views = []
    for turn in Rotation.random(count, rng=random).as_matrix():
        projection = Projection(matrix=np.column_stack([turn[:2] / PIXEL_M, centre]))
        outline = true_silhouette(mesh, projection, IMAGE_SHAPE)
        views.append(View(silhouette=outline, projection=projection))
    return views


def _all_figures(drawn: list[tuple[Interval, ...]], truths: Floats) -> list[list[Figure]]:
    """Return the figures of each quantity; `truths` is (draws, quantities)."""
    of_body = body_truth()
    return [
        _figures(
            *QUANTITIES[index], [row[index] for row in drawn], truths[:, index], of_body[index]
        )
        for index in range(len(QUANTITIES))
    ]


def _figures(
    name: str, unit: str, intervals: list[Interval], hull_truth: Floats, true_body: float
) -> list[Figure]:
    low, value, high = np.array([[each.low, each.value, each.high] for each in intervals]).T
    # An interval that cannot be stated holds nothing.
    covered = 100 * float(np.mean((low <= hull_truth) & (hull_truth <= high)))
    of_body = 100 * float(np.mean((low <= true_body) & (true_body <= high)))
    error = float(np.mean(value - hull_truth))
    half_width = float(np.nanmedian(0.5 * (high - low)))
    return [
        Figure(name=f"{name}: intervals that hold it", value=covered, unit="%", wanted=">= 90 %"),
        Figure(name=f"{name}: no more than", value=covered, unit="%", wanted="<= 99 %"),
        Figure(name=f"{name}: intervals that hold the body's", value=of_body, unit="%"),
        Figure(name=f"{name}: mean error", value=error, unit=unit),
        Figure(name=f"{name}: median half-width", value=half_width, unit=unit),
    ]


def _table(figures: list[list[Figure]]) -> Table:
    return Table(
        title="95 % intervals against the hull of true outlines, and against the body",
        columns=("quantity", "hold the hull's", "hold the body's", "mean error", "half-width"),
        rows=tuple(
            (name, *(f"{figure.value:.3g} {figure.unit}" for figure in (row[0], *row[2:])))
            for (name, _), row in zip(QUANTITIES, figures, strict=True)
        ),
    )
