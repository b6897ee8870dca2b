"""`radarhull bench growth`: how time and memory grow with voxels, views and vertices."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

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
from core.hull.hull_only import carved_surface
from core.hull.surface import Surface, hull_surface
from core.hull.threads import thread_count
from core.hull.volume import VoteVolume
from core.hull.votes import MOST_STORED_VOXELS

SIZES = ((64, 60), (128, 60), (256, 60), (512, 60), (1024, 60), (2048, 200))
VIEWS = (15, 30, 60, 120, 240)
WANTED = {"2048³×200": ("<= 8 s", "<= 1 GB")}
"""Time and memory above the mesh that hull-only runs are held against."""

SEGMENTS = (16, 32, 64, 128, 256)


@dataclass(frozen=True, slots=True, kw_only=True)
class Point:
    """One measured point of a curve.

    Attributes:
        amount: of what grows.
        votes_s: median time of all votes.
        mesh_s: median time of the exact mesh from the votes.
        peak_bytes: of votes and mesh together.
        hull_only: the same mesh without stored votes.
    """

    amount: float
    votes_s: float
    mesh_s: float
    peak_bytes: int
    hull_only: "HullOnly"


@dataclass(frozen=True, slots=True, kw_only=True)
class HullOnly:
    """Measurements of the exact mesh without stored votes.

    Attributes:
        size: "voxels a side³×views".
        voxels: of the grid.
        seconds: median time.
        cpu_s: processor time of all threads in the same run.
        peak_bytes: of all, the mesh included.
        mesh_bytes: of the mesh.
    """

    size: str
    voxels: float
    seconds: float
    cpu_s: float
    peak_bytes: int
    mesh_bytes: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Curve:
    """What happens while one thing grows and the others stay.

    Attributes:
        of: what grows.
        points: from small to large.
        beyond: hulls whose votes could not be stored.
    """

    of: str
    points: tuple[Point, ...]
    beyond: tuple[HullOnly, ...] = ()


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
        sizes: (voxels a side, views) of the curve over voxels, from small to large; those whose
            votes memory cannot hold are carved hull-only. Views and vertices grow on the second of
            those that it can.
        repeats: runs of each point; the median counts.
        view_counts: of the curve over views.
        segments: of the body's round parts, for the curve over vertices.
        seed: of the views.
        progress: told of stage, steps done and steps in all.
    """
    before = machine()
    bandwidth = copy_bandwidth_bytes_per_s()
    stored = [each for each in sizes if each[0] ** 3 <= MOST_STORED_VOXELS]
    if not stored:
        raise ValueError("At least one size must be small enough for its votes to be stored.")
    size, views = stored[min(1, len(stored) - 1)]
    tasks: dict[str, list[Callable[[], tuple[float, Task]]]] = {
        "voxels": [_by_voxels(*each, seed) for each in stored],
        "views": [_by_views(size, count, seed) for count in view_counts],
        "vertices": [_by_vertices(size, views, count, seed) for count in segments],
    }
    curves = tuple(_curve(of, each, repeats, progress) for of, each in tasks.items())
    beyond = []
    for each in [each for each in sizes if each not in stored]:
        beyond.append(_hull_only(satellite_task(*each, seed=seed), repeats))
        progress("hull only", len(beyond), len(sizes) - len(stored))
    curves = (replace(curves[0], beyond=tuple(beyond)), *curves[1:])
    figures = [figure for curve in curves for figure in _exponents(curve)]
    figures += _bandwidth_figures(curves[0].points[-1], bandwidth)
    for point in [curves[0].points[-1].hull_only, *beyond]:
        figures += _hull_only_figures(point, bandwidth)
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
        hull_only=_hull_only(task, repeats),
    )


def _hull_only(task: Task, repeats: int) -> HullOnly:
    def carve() -> Surface:
        return carved_surface(task.views, task.grid)

    def timed() -> tuple[float, float]:
        before = time.process_time()
        seconds = measured(carve).seconds
        return seconds, time.process_time() - before

    # The first run compiles, and none of the others' results lives on while memory is measured.
    peak, mesh_bytes = 0, 0
    for _ in range(2):
        peak, surface = peak_bytes(carve)
        mesh_bytes = surface.vertices_m.nbytes + surface.faces.nbytes
        del surface
    seconds, cpu_s = sorted(timed() for _ in range(repeats))[repeats // 2]
    return HullOnly(
        size=f"{task.grid.shape[0]}³×{len(task.views)}",
        voxels=float(task.grid.voxel_count),
        seconds=seconds,
        cpu_s=cpu_s,
        peak_bytes=peak,
        mesh_bytes=mesh_bytes,
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
        "time, hull only": [point.hull_only.seconds for point in curve.points],
        "memory, hull only": [max(point.hull_only.peak_bytes, 2**20) for point in curve.points],
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


def _hull_only_figures(point: HullOnly, bandwidth: float) -> list[Figure]:
    """Return time and memory of a hull-only run, against the targets where its size has some."""
    wanted = WANTED.get(point.size, (None, None))
    name = f"{point.size}: hull only to the exact mesh"
    return [
        Figure(name=name, value=point.seconds, unit="s", wanted=wanted[0]),
        Figure(
            name=f"{name}, processor time a thread", value=point.cpu_s / thread_count(), unit="s"
        ),
        Figure(
            name=f"{name}, memory above the mesh",
            value=max(0, point.peak_bytes - point.mesh_bytes) / 1e9,
            unit="GB",
            wanted=wanted[1],
        ),
        Figure(name=f"{point.size}: the mesh itself", value=point.mesh_bytes / 1e9, unit="GB"),
        Figure(
            name=f"{name}, against reading and writing all votes once",
            value=point.seconds / (2 * point.voxels / bandwidth),
        ),
    ]


def _table(curve: Curve) -> Table:
    return Table(
        title=f"Growth with {curve.of}",
        columns=(curve.of, "all votes", "exact mesh", "memory", "hull only", "its memory"),
        rows=(
            *[
                (
                    f"{point.amount:,.0f}",
                    f"{1e3 * point.votes_s:.4g} ms",
                    f"{1e3 * point.mesh_s:.4g} ms",
                    _mebibytes(point.peak_bytes),
                    f"{1e3 * point.hull_only.seconds:.4g} ms",
                    _mebibytes(point.hull_only.peak_bytes),
                )
                for point in curve.points
            ],
            *[
                (
                    f"{point.voxels:,.0f} ({point.size})",
                    *["not stored"] * 3,
                    f"{1e3 * point.seconds:.4g} ms",
                    _mebibytes(point.peak_bytes),
                )
                for point in curve.beyond
            ],
        ),
    )


def _mebibytes(count: int) -> str:
    return f"{np.ceil(count / 2**20):.0f} MiB"
