"""`radarhull bench growth`: how time and memory grow with voxels, views and vertices."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from core.benchmarks.measuring import (
    Progress,
    Run,
    copy_bandwidth_bytes_per_s,
    fitted_exponent,
    machine,
    measured,
    median_s,
    peak_bytes,
)
from core.benchmarks.workload import Task, satellite_task
from core.experiments.results import Figure, Results, Table
from core.hull.surface import Surface, hull_surface
from core.hull.volume import VoteVolume

SIZES = ((64, 60), (128, 60), (256, 60), (512, 60))
VIEWS = (15, 30, 60, 120, 240)
SEGMENTS = (16, 32, 64, 128, 256)


@dataclass(frozen=True, slots=True, kw_only=True)
class Point:
    """One measured point of a curve.

    Attributes:
        amount: of what grows.
        votes_s: median time of all votes.
        mesh_s: median time of the exact mesh from the votes.
        peak_bytes: of votes and mesh together.
    """

    amount: float
    votes_s: float
    mesh_s: float
    peak_bytes: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Curve:
    """What happens while one thing grows and the others stay.

    Attributes:
        of: what grows.
        points: from small to large.
    """

    of: str
    points: tuple[Point, ...]


def run_growth(
    *,
    sizes: Sequence[tuple[int, int]] = SIZES,
    repeats: int = 5,
    view_counts: Sequence[int] = VIEWS,
    segments: Sequence[int] = SEGMENTS,
    seed: int = 1,
    progress: Progress = lambda _stage, _done, _total: None,
) -> tuple[Results, tuple[Curve, ...]]:
    """Measure votes and exact mesh while voxels, views and vertices grow; return curves to plot.

    Args:
        sizes: (voxels a side, views) of the curve over voxels, from small to large. Views and
            vertices grow on the second of them.
        repeats: runs of each point; the median counts.
        view_counts: of the curve over views.
        segments: of the body's round parts, for the curve over vertices.
        seed: of the views.
        progress: told of stage, steps done and steps in all.
    """
    before = machine()
    bandwidth = copy_bandwidth_bytes_per_s()
    size, views = sizes[min(1, len(sizes) - 1)]
    tasks: dict[str, list[Callable[[], tuple[float, Task]]]] = {
        "voxels": [_by_voxels(*each, seed) for each in sizes],
        "views": [_by_views(size, count, seed) for count in view_counts],
        "vertices": [_by_vertices(size, views, count, seed) for count in segments],
    }
    curves = tuple(_curve(of, each, repeats, progress) for of, each in tasks.items())
    figures = [figure for curve in curves for figure in _exponents(curve)]
    figures += _bandwidth_figures(curves[0].points[-1], bandwidth)
    settings = {
        "sizes": [f"{size}x{views}" for size, views in sizes],
        "views": list(view_counts),
        "segments": list(segments),
        "views and vertices grow on": f"{size}x{views}",
        "repeats": repeats,
        "seed": seed,
        **before,
        "load_average_at_end": machine()["load_average"],
    }
    tables = tuple(_table(curve) for curve in curves)
    results = Results(name="growth", settings=settings, figures=tuple(figures), tables=tables)
    return results, curves


def _by_voxels(size: int, views: int, seed: int) -> Callable[[], tuple[float, Task]]:
    return lambda: (float(size) ** 3, satellite_task(size, views, seed=seed))


def _by_views(size: int, views: int, seed: int) -> Callable[[], tuple[float, Task]]:
    return lambda: (float(views), satellite_task(size, views, seed=seed))


def _by_vertices(
    size: int, views: int, segments: int, seed: int
) -> Callable[[], tuple[float, Task]]:
    def make() -> tuple[float, Task]:
        task = satellite_task(size, views, seed=seed, segments=segments)
        rings = [ring for view in task.views for ring in view.silhouette.rings]
        return sum(map(len, rings)) / views, task

    return make


def _curve(
    of: str,
    tasks: Sequence[Callable[[], tuple[float, Task]]],
    repeats: int,
    progress: Progress,
) -> Curve:
    points = []
    for done, make in enumerate(tasks, start=1):
        amount, task = make()
        points.append(_point(amount, task, repeats))
        progress(of, done, len(tasks))
    return Curve(of=of, points=tuple(points))


def _point(amount: float, task: Task, repeats: int) -> Point:
    _run(task)  # compiles
    runs = [_run(task) for _ in range(repeats)]
    return Point(
        amount=amount,
        votes_s=median_s([votes.seconds for votes, _ in runs]),
        mesh_s=median_s([mesh.seconds for _, mesh in runs]),
        peak_bytes=peak_bytes(lambda: _run(task))[0],
    )


def _run(task: Task) -> tuple[Run[VoteVolume], Run[Surface]]:
    def carve() -> VoteVolume:
        volume = VoteVolume(task.grid)
        volume.add_many(task.views)
        return volume

    votes = measured(carve)
    return votes, measured(lambda: hull_surface(votes.result))


def _exponents(curve: Curve) -> list[Figure]:
    """Return the fitted powers; one point fits none."""
    if len(curve.points) < 2:
        return []
    amounts = [point.amount for point in curve.points]
    grown: dict[str, list[float]] = {
        "time of all votes": [point.votes_s for point in curve.points],
        "time of the exact mesh": [point.mesh_s for point in curve.points],
        # What is smaller than a megabyte is the allocator's business.
        "memory": [max(point.peak_bytes, 2**20) for point in curve.points],
    }
    return [
        Figure(name=f"{what} ∝ {curve.of}^", value=fitted_exponent(amounts, values))
        for what, values in grown.items()
    ]


def _bandwidth_figures(largest: Point, bandwidth: float) -> list[Figure]:
    """Return how near the largest grid's votes come to memory that is read and written once."""
    least_s = 2 * largest.amount / bandwidth
    side = round(largest.amount ** (1 / 3))
    return [
        Figure(name="memory bandwidth (copy)", value=bandwidth / 1e9, unit="GB/s"),
        Figure(name=f"{side}³: all votes", value=1e3 * largest.votes_s, unit="ms"),
        Figure(name=f"{side}³: reading and writing them once", value=1e3 * least_s, unit="ms"),
        Figure(name=f"{side}³: distance to the bandwidth", value=largest.votes_s / least_s),
        Figure(name=f"{side}³: exact mesh", value=1e3 * largest.mesh_s, unit="ms"),
    ]


def _table(curve: Curve) -> Table:
    return Table(
        title=f"Growth with {curve.of}",
        columns=(curve.of, "all votes", "exact mesh", "memory"),
        rows=tuple(
            (
                f"{point.amount:,.0f}",
                f"{1e3 * point.votes_s:.4g} ms",
                f"{1e3 * point.mesh_s:.4g} ms",
                f"{np.ceil(point.peak_bytes / 2**20):.0f} MiB",
            )
            for point in curve.points
        ),
    )
