"""How accurate a hull from echoes is against noise, resolution and number of frames."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from core.experiments.accuracy_conditions import (
    Accuracy,
    Condition,
    Sight,
    hull_accuracy,
    sights,
)
from core.experiments.accuracy_curves import MEASURES, Curve, curves_picture
from core.experiments.frame_pictures import OutlinedFrame, frames_picture
from core.experiments.hull_pictures import error_pictures, sides_picture
from core.experiments.noise_finding import noise_finding
from core.experiments.pictures import Picture
from core.experiments.results import Figure, Results
from core.experiments.study import Progress, Study
from core.geometry.grid import VoxelGrid
from core.hull.surface import Surface
from core.targets import Target, tiangong_like

SIDE_M = 21.0

LEVELS_DB = (-10.0, -5.0, 0.0, 5.0, 10.0, 20.0, 30.0)
RESOLUTIONS_M = (0.1, 0.15, 0.2, 0.3, 0.4, 0.6)
FRAMES = (10, 20, 40, 80)

WANTED = {"IoU": ">= 0.75", "mean length error": "<= 2 %"}
"""At the centre, as of the wide experiment."""

NAMES = {
    "signal_to_noise_db": ("signal-to-noise ratio", "dB"),
    "resolution_m": ("resolution", "m"),
    "frames": ("frames", "frames"),
}
"""The factors, by the field of `Condition` that each is, with their units."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Bench:
    """What all hulls are carved from and held against."""

    target: Target
    grid: VoxelGrid
    truth: NDArray[np.bool_]
    scatterers: int


@dataclass(slots=True, kw_only=True, eq=False)
class _Found:
    """What came out: accuracies by condition, and what the pictures show of the first seed."""

    accuracies: dict[Condition, list[Accuracy]]
    hulls: dict[Condition, Surface]
    shown: dict[Condition, OutlinedFrame]


def run_noise(
    *,
    views: int = 80,
    spacing_m: float = 0.15,
    scatterers: int = 60_000,
    signal_to_noise_db: float = 20.0,
    resolution_m: float = 0.15,
    levels_db: Sequence[float] = LEVELS_DB,
    resolutions_m: Sequence[float] = RESOLUTIONS_M,
    frames: Sequence[int] = FRAMES,
    seeds: int = 3,
    seed: int = 1,
    progress: Progress = lambda _stage, _done, _total: None,
) -> Study:
    """Vary noise, resolution and number of frames, one at a time, and carve from echoes each time.

    The target is Tiangong-like and seen from all around; the shadow rule carves. All levels of
    noise use the same noiseless echoes, all numbers of frames the first of the same ones, so that
    only what is varied differs along a curve. From seed to seed directions, scatterers and noise
    differ.

    Args:
        views: frames at the centre.
        spacing_m: voxel spacing.
        scatterers: points on the target's surface.
        signal_to_noise_db: at the centre; see `simulate_echoes`.
        resolution_m: at the centre, in range (by bandwidth) and in cross-range (by the interval's
            turn).
        levels_db: signal-to-noise ratios, beside the centre's.
        resolutions_m: resolutions, beside the centre's.
        frames: numbers of frames up to the centre's, beside that.
        seeds: how often all is repeated.
        seed: the first of them.
        progress: told of stage, steps done and steps in all.

    Raises:
        ValueError: fewer than two views or no seeds, or parameters a stage refuses.
    """
    if views < 2 or seeds < 1:
        raise ValueError(f"A hull needs at least 2 views and a seed, got {views} and {seeds}.")
    centre = Condition(
        signal_to_noise_db=signal_to_noise_db, resolution_m=resolution_m, frames=views
    )
    varied: dict[str, list[Condition]] = {
        "signal_to_noise_db": [
            replace(centre, signal_to_noise_db=level)
            for level in _with(levels_db, signal_to_noise_db)
        ],
        "resolution_m": [
            replace(centre, resolution_m=size) for size in _with(resolutions_m, resolution_m)
        ],
        "frames": [
            replace(centre, frames=int(count)) for count in _with(frames, views) if count <= views
        ],
    }
    target = tiangong_like()
    grid = VoxelGrid.cube(side_m=SIDE_M, spacing_m=spacing_m)
    bench = _Bench(target=target, grid=grid, truth=target.voxels(grid), scatterers=scatterers)
    found = _found(bench, centre, varied, range(seed, seed + seeds), progress)
    curves = {
        field: Curve(
            factor=NAMES[field][0],
            unit=NAMES[field][1],
            centre=getattr(centre, field),
            found={getattr(each, field): found.accuracies[each] for each in conditions},
        )
        for field, conditions in varied.items()
    }
    results = Results(
        name="noise",
        settings={
            "target": target.name,
            "outlines": "found in images of simulated echoes, shadow rule",
            "centre": f"{views} frames of {resolution_m:g} m at {signal_to_noise_db:g} dB",
            "spacing_m": spacing_m,
            "scatterers": scatterers,
            "seeds": list(range(seed, seed + seeds)),
        },
        figures=(
            *_centre_figures(curves["frames"]),
            *(figure for curve in curves.values() for figure in curve.figures()),
        ),
        tables=tuple(curve.table() for curve in curves.values()),
        finding=noise_finding(curves, centre),
    )
    hull = found.hulls[centre]
    pictures = _pictures(list(curves.values()), varied, found, hull, target)
    return Study(results=results, pictures=pictures, hull=hull)


def _with(values: Iterable[float], centre: float) -> list[float]:
    return sorted({*values, centre})


def _found(
    bench: _Bench,
    centre: Condition,
    varied: Mapping[str, Sequence[Condition]],
    seeds: Sequence[int],
    progress: Progress,
) -> _Found:
    """Carve under every condition for every seed; each resolution's echoes are made once."""
    found = _Found(accuracies={}, hulls={}, shown={})
    conditions = list(dict.fromkeys(each for group in varied.values() for each in group))
    resolutions = [each.resolution_m for each in varied["resolution_m"]]
    total = len(seeds) * len(resolutions) * centre.frames
    done = 0
    for seed in seeds:
        for resolution_m in resolutions:
            here = [each for each in conditions if each.resolution_m == resolution_m]
            seen = []
            for sight in sights(
                bench.target,
                replace(centre, resolution_m=resolution_m),
                sorted({each.signal_to_noise_db for each in here}),
                scatterers=bench.scatterers,
                seed=seed,
            ):
                seen.append(sight)
                done += 1
                progress("echoes, images and outlines", done, total)
            _carve(bench, here, seen, found)
            progress("hulls", done, total)
    return found


def _carve(
    bench: _Bench, conditions: Sequence[Condition], seen: Sequence[Sight], found: _Found
) -> None:
    for each in conditions:
        level = each.signal_to_noise_db
        views = [sight.views[level] for sight in seen[: each.frames]]
        accuracy, surface = hull_accuracy(
            [view for view in views if view is not None], bench.grid, bench.truth, bench.target
        )
        found.accuracies.setdefault(each, []).append(accuracy)
        found.hulls.setdefault(each, surface)
        found.shown.setdefault(each, seen[0].shown[level])


def _centre_figures(curve: Curve) -> list[Figure]:
    return [
        Figure(
            name=f"centre: {measure}",
            value=curve.mean(curve.centre, measure),
            unit=unit,
            wanted=WANTED.get(measure),
        )
        for measure, (unit, _) in MEASURES.items()
    ]


def _pictures(
    curves: Sequence[Curve],
    varied: Mapping[str, Sequence[Condition]],
    found: _Found,
    hull: Surface,
    target: Target,
) -> tuple[Picture, ...]:
    shown = {
        field: [found.shown[each] for each in varied[field]]
        for field in ("signal_to_noise_db", "resolution_m")
    }
    return (
        curves_picture(
            curves,
            name="noise-curves",
            caption="Accuracy against one factor at a time, the others at the centre (dotted): "
            "mean over the seeds, and their range shaded. Lengths and attitude are those of the "
            "hull's three principal lines; where a hull has none, the curve ends.",
        ),
        frames_picture(
            shown["signal_to_noise_db"],
            target,
            name="noise-frames",
            caption="One view at every level of noise, with the outline found and the true one: "
            "range down, cross-range right, 45 dB of amplitude.",
        ),
        frames_picture(
            shown["resolution_m"],
            target,
            name="noise-resolutions",
            caption="The same view at every resolution.",
        ),
        sides_picture(hull, target, name="noise-hull", what="Hull at the centre"),
        *error_pictures(hull, target, name="noise-errors", most_m=0.5),
    )
