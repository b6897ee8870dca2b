"""`radarhull bench surface`: how far the engine's surface is from the true hull."""

from collections.abc import Sequence

import numpy as np

from core.arrays import Floats
from core.benchmarks.measuring import Progress, machine, measured
from core.benchmarks.truth import distances_m, sampled_points, true_hull
from core.benchmarks.workload import (
    ATTITUDE,
    BODY_LENGTH_M,
    PANEL_SPAN_M,
    cubic_grid,
    satellite_views,
)
from core.experiments.results import Figure, Results, Table
from core.hull.surface import Surface, hull_surface, mask_surface
from core.hull.view import View
from core.hull.volume import VoteVolume

SIZES = ((64, 60), (128, 60), (256, 60), (512, 60))
SAMPLES = 4000
WANTED_SIZE = 512
LENGTHS = {"panel": (1, PANEL_SPAN_M), "body": (2, BODY_LENGTH_M)}
"""What is measured along which of the body's axes, and what it truly is."""


def run_surface(
    *,
    sizes: Sequence[tuple[int, int]] = SIZES,
    samples: int = SAMPLES,
    seed: int = 1,
    progress: Progress = lambda _stage, _done, _total: None,
) -> Results:
    """Compare the exact and the binary surface with the intersection of the silhouettes' prisms.

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
        truth = true_hull(outlines)
        progress(f"true hull of {views} views", 1, 1)
        for size in [size for size, of in sizes if of == views]:
            found, row = _compared(size, outlines, truth, samples, seed)
            figures += found
            rows.append(row)
            progress("grids", len(rows), len(sizes))
    columns = ("grid", "voxel", "rms exact", "rms binary", "ratio", "voxel / rms", "mesh")
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
        },
        figures=tuple(figures),
        tables=(Table(title="Distance to the true hull", columns=columns, rows=tuple(rows)),),
    )


def _compared(
    size: int, views: tuple[View, ...], truth: Surface, samples: int, seed: int
) -> tuple[list[Figure], tuple[str, ...]]:
    """Return the figures and the table's row of one grid."""
    grid = cubic_grid(size)
    volume = VoteVolume(grid)
    volume.add_many(views)
    run = measured(lambda: hull_surface(volume))
    exact, binary = run.result, mask_surface(volume.hull(), grid)
    if exact.is_empty or binary.is_empty:
        raise ValueError(f"The hull is empty on a grid of {size}³; use a finer one.")
    rms, rough = (
        _rms(distances_m(sampled_points(surface, samples, seed), truth))
        for surface in (exact, binary)
    )
    at = f"{size}³×{len(views)}"
    wanted = size == WANTED_SIZE
    figures = [
        Figure(name=f"{at}: rms error of the exact surface", value=1e3 * rms, unit="mm"),
        Figure(
            name=f"{at}: voxels per rms error",
            value=grid.spacing_m / rms,
            wanted=">= 40" if wanted else None,
        ),
        Figure(name=f"{at}: rms error of binary marching cubes", value=1e3 * rough, unit="mm"),
        Figure(
            name=f"{at}: times better than binary marching cubes",
            value=rough / rms,
            wanted=">= 6" if wanted else None,
        ),
        *_back_figures(at, exact, truth, samples, seed),
        *_length_figures(at, exact, truth, wanted=wanted),
    ]
    row = (
        at,
        f"{1e3 * grid.spacing_m:.1f} mm",
        f"{1e3 * rms:.3g} mm",
        f"{1e3 * rough:.3g} mm",
        f"{rough / rms:.1f}",
        f"{grid.spacing_m / rms:.1f}",
        f"{1e3 * run.seconds:.0f} ms",
    )
    return figures, row


def _back_figures(at: str, exact: Surface, truth: Surface, samples: int, seed: int) -> list[Figure]:
    """Return how far the true hull is from the surface, where fine parts could have been lost."""
    points = sampled_points(truth, samples, seed)
    distances = distances_m(points, exact)
    return [
        Figure(name=f"{at}: rms from the true hull back", value=1e3 * _rms(distances), unit="mm")
    ]


def _length_figures(at: str, exact: Surface, truth: Surface, *, wanted: bool) -> list[Figure]:
    figures = []
    for name, (axis, length_m) in LENGTHS.items():
        found, right = (_extent_m(surface, axis) for surface in (exact, truth))
        figures += [
            Figure(
                name=f"{at}: {name} length, off the true hull's by",
                value=1e3 * abs(found - right),
                unit="mm",
                wanted="<= 2 mm" if wanted else None,
            ),
            Figure(
                name=f"{at}: {name} length, off the body's by",
                value=1e3 * abs(found - length_m),
                unit="mm",
            ),
        ]
    return figures


def _extent_m(surface: Surface, axis: int) -> float:
    """Return the surface's extent along one of the body's own axes."""
    direction = ATTITUDE.apply(np.eye(3)[axis])
    return float(np.ptp(surface.vertices_m @ direction))


def _rms(values: Floats) -> float:
    return float(np.sqrt(np.mean(values**2)))
