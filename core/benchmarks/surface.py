"""`radarhull bench surface`: how far the engine's surface is from the true hull."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from core.arrays import Floats
from core.benchmarks.distances import distances_m, sampled_points
from core.benchmarks.measuring import Progress, Run, machine, measured
from core.benchmarks.truth import true_hull
from core.benchmarks.workload import (
    ATTITUDE,
    BODY_LENGTH_M,
    PANEL_SPAN_M,
    cubic_grid,
    satellite_views,
)
from core.experiments.results import Figure, Results, Table
from core.hull.surface import Method, Surface, hull_surface, mask_surface
from core.hull.view import View
from core.hull.volume import VoteVolume

SIZES = ((64, 60), (128, 60), (256, 60), (512, 60))
SAMPLES = 4000
WANTED_SIZE = 512
LENGTHS = {"panel": (1, PANEL_SPAN_M), "body": (2, BODY_LENGTH_M)}
"""What is measured along which of the body's axes, and what it truly is."""
METHODS: tuple[Method, ...] = ("dual", "snapped")
"""The first is the one for large grids, which is held against the targets."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Against:
    """What surfaces are held against.

    Attributes:
        truth: the true hull.
        samples: points spread over each surface whose distance to the other is taken.
        seed: of the points.
    """

    truth: Surface
    samples: int
    seed: int

    def rms_m(self, surface: Surface) -> float:
        """Return the root mean square distance of a surface from the true hull."""
        return _rms(distances_m(sampled_points(surface, self.samples, self.seed), self.truth))

    def rms_back_m(self, surface: Surface) -> float:
        """Return that of the true hull from a surface, where fine parts could have been lost."""
        return _rms(distances_m(sampled_points(self.truth, self.samples, self.seed), surface))


def run_surface(
    *,
    sizes: Sequence[tuple[int, int]] = SIZES,
    samples: int = SAMPLES,
    seed: int = 1,
    progress: Progress = lambda _stage, _done, _total: None,
) -> Results:
    """Compare exact and binary surfaces with the intersection of the silhouettes' prisms.

    Args:
        sizes: (voxels a side, views).
        samples: points spread over each surface whose distance to the true hull is taken.
        seed: of views and samples.
        progress: told of stage, steps done and steps in all.
    """
    before = machine()
    figures: list[Figure] = []
    rows: list[tuple[str, ...]] = []
    for views in sorted({views for _, views in sizes}):
        outlines = satellite_views(views, seed=seed)
        progress(f"true hull of {views} views", 0, 1)
        against = Against(truth=true_hull(outlines), samples=samples, seed=seed)
        progress(f"true hull of {views} views", 1, 1)
        for size in [size for size, of in sizes if of == views]:
            found, lines = _compared(size, outlines, against)
            figures += found
            rows += lines
            progress("grids", len(rows) // (1 + len(METHODS)), len(sizes))
    columns = ("grid", "mesher", "rms mm", "voxel/rms", "better", "panel mm", "body mm", "ms")
    return Results(
        name="surface",
        settings={
            "sizes": [f"{size}x{views}" for size, views in sizes],
            "samples": samples,
            "seed": seed,
            **before,
            "load_average_at_end": machine()["load_average"],
            "truth": "intersection of prisms by manifold3d",
            "error": "distance to the true hull of points spread evenly over the surface",
            "lengths": "panel and body, surface's less the true hull's",
            "better": "times nearer than binary marching cubes",
        },
        figures=tuple(figures),
        tables=(Table(title="Distance to the true hull", columns=columns, rows=tuple(rows)),),
    )


def _compared(
    size: int, views: tuple[View, ...], against: Against
) -> tuple[list[Figure], list[tuple[str, ...]]]:
    """Return the figures and the table's rows of one grid."""
    grid = cubic_grid(size)
    volume = VoteVolume(grid)
    volume.add_many(views)
    at = f"{size}³×{len(views)}"
    runs = {"binary": measured(lambda: mask_surface(volume.hull(), grid))}
    if runs["binary"].result.is_empty:
        raise ValueError(f"The hull is empty on a grid of {size}³; use a finer one.")
    for method in METHODS:
        # The first run compiles, and the median of three is not disturbed by neighbours.
        again = [measured(partial(hull_surface, volume, method=method)) for _ in range(4)]
        runs[method] = sorted(again[1:], key=lambda run: run.seconds)[1]
    rms_m = {name: against.rms_m(run.result) for name, run in runs.items()}
    figures = [
        Figure(
            name=f"{at}: rms error of binary marching cubes", value=1e3 * rms_m["binary"], unit="mm"
        )
    ]
    for method in METHODS:
        surface, better = runs[method].result, rms_m["binary"] / rms_m[method]
        figures += _error_figures(f"{at}, {method}", grid.spacing_m, rms_m[method], better)
        back = 1e3 * against.rms_back_m(surface)
        figures.append(
            Figure(name=f"{at}, {method}: rms from the true hull back", value=back, unit="mm")
        )
        figures += _length_figures(f"{at}, {method}", surface, against.truth)
    rows = [
        _row(at, name, run, rms_m[name], rms_m["binary"], grid.spacing_m, against.truth)
        for name, run in runs.items()
    ]
    return figures, rows


def _is_wanted(at: str) -> bool:
    """Return whether targets are set for a grid and a mesher."""
    return at.startswith(f"{WANTED_SIZE}³") and at.endswith(METHODS[0])


def _error_figures(at: str, spacing_m: float, rms_m: float, better: float) -> list[Figure]:
    wanted = _is_wanted(at)
    return [
        Figure(name=f"{at}: rms error", value=1e3 * rms_m, unit="mm"),
        Figure(
            name=f"{at}: voxels per rms error",
            value=spacing_m / rms_m,
            wanted=">= 40" if wanted else None,
        ),
        Figure(
            name=f"{at}: times better than binary marching cubes",
            value=better,
            wanted=">= 6" if wanted else None,
        ),
    ]


def _length_figures(at: str, surface: Surface, truth: Surface) -> list[Figure]:
    figures = []
    for name, (axis, length_m) in LENGTHS.items():
        found, right = (_extent_m(of, axis) for of in (surface, truth))
        figures += [
            Figure(
                name=f"{at}: {name} length, off the true hull's by",
                value=1e3 * abs(found - right),
                unit="mm",
                wanted="<= 2 mm" if _is_wanted(at) else None,
            ),
            Figure(
                name=f"{at}: {name} length, off the body's by",
                value=1e3 * abs(found - length_m),
                unit="mm",
            ),
        ]
    return figures


def _row(
    at: str,
    name: str,
    run: Run[Surface],
    rms_m: float,
    rough_m: float,
    spacing_m: float,
    truth: Surface,
) -> tuple[str, ...]:
    off_m = [_extent_m(run.result, axis) - _extent_m(truth, axis) for axis, _ in LENGTHS.values()]
    return (
        at,
        name,
        f"{1e3 * rms_m:.3g}",
        f"{spacing_m / rms_m:.1f}",
        f"{rough_m / rms_m:.1f}",
        *(f"{1e3 * off:+.2f}" for off in off_m),
        f"{1e3 * run.seconds:.0f}",
    )


def _extent_m(surface: Surface, axis: int) -> float:
    """Return the surface's extent along one of the body's own axes."""
    direction = ATTITUDE.apply(np.eye(3)[axis])
    return float(np.ptp(surface.vertices_m @ direction))


def _rms(values: Floats) -> float:
    return float(np.sqrt(np.mean(values**2)))
