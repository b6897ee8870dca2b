"""`radarhull bench picks`: from a click's ray to the anchor it means, on a large hull."""

import time
from collections.abc import Sequence

import numpy as np

from app.picking import SNAPS, Ray, Snap, pick_on, prepare
from core.arrays import Floats
from core.benchmarks.measuring import Progress, machine, percentile
from core.benchmarks.workload import GRID_SIDE_M, satellite_views
from core.experiments.results import Figure, Results
from core.geometry.grid import VoxelGrid
from core.hull.surface import Surface
from core.hull.volume import VoteVolume

SIZES = ((432, 60),)
"""Voxels a side and views of a hull with some 300 000 faces."""

PICKS = 100
WANTED = "<= 20 ms"


def run_picks(
    *,
    sizes: Sequence[tuple[int, int]] = SIZES,
    picks: int = PICKS,
    seed: int = 1,
    progress: Progress = lambda _stage, _done, _total: None,
) -> Results:
    """Time picks of each snap at random places of the test satellite's hull.

    Args:
        sizes: (voxels a side, views).
        picks: of each snap.
        seed: of views and places.
        progress: told of stage, steps done and steps in all.
    """
    before = machine()
    figures: list[Figure] = []
    for size, views in sizes:
        surface = _hull(size, views, seed)
        prepare(surface)
        title = f"{size}³×{views}"
        figures.append(Figure(name=f"{title}: faces", value=float(len(surface.faces)), unit=""))
        for number, snap in enumerate(SNAPS):
            times_ms = _times_ms(surface, snap, picks, np.random.default_rng(seed))
            figures += _figures(title, snap, times_ms)
            progress(title, number + 1, len(SNAPS))
    settings = {"sizes": [f"{n}x{v}" for n, v in sizes], "picks": picks, "seed": seed, **before}
    return Results(name="picks", settings=settings, figures=tuple(figures))


def _figures(title: str, snap: Snap, times_ms: list[float]) -> list[Figure]:
    name = f"{title}: {snap}"
    return [
        Figure(name=f"{name}, median", value=percentile(times_ms, 50), unit="ms"),
        Figure(name=f"{name}, p95", value=percentile(times_ms, 95), unit="ms", wanted=WANTED),
    ]


def _hull(size: int, views: int, seed: int) -> Surface:
    volume = VoteVolume(VoxelGrid.cube(side_m=GRID_SIDE_M, spacing_m=GRID_SIDE_M / size))
    volume.add_many(satellite_views(views, seed=seed))
    volume.threshold = views
    return volume.surface()


def _times_ms(surface: Surface, snap: Snap, picks: int, random: np.random.Generator) -> list[float]:
    times_ms = []
    for place_m in surface.vertices_m[random.integers(len(surface.vertices_m), size=picks + 3)]:
        ray = _ray_at(place_m, random)
        start_s = time.perf_counter()
        pick_on(surface, ray, snap)
        times_ms.append(1e3 * (time.perf_counter() - start_s))
    return times_ms[3:]  # the first ones compile


def _ray_at(place_m: Floats, random: np.random.Generator) -> Ray:
    """Return a ray from far away in a random direction to a place of the surface."""
    direction = random.normal(size=3)
    direction /= np.linalg.norm(direction)
    return Ray(origin_m=place_m - 10 * GRID_SIDE_M * direction, direction=direction)
