"""How silhouettes wrong in a few frames harm a hull, and how votes and blame repair it."""

from collections.abc import Mapping, Sequence

import numpy as np

from core.experiments.frame_pictures import OutlinedFrame, frames_picture
from core.experiments.hull_pictures import error_pictures, rivals_picture
from core.experiments.results import Figure, Results, Table
from core.experiments.study import Progress, Study
from core.experiments.threshold.faults import (
    FOREIGN,
    LARGE,
    SHIFTED,
    SMALL,
    Fault,
    foreign,
    shifted,
    spent_stage,
    too_large,
    too_small,
)
from core.experiments.threshold.pictures import Trials, curves_picture, mean_of
from core.experiments.threshold.repair import LEAST_M3, OUTLYING
from core.experiments.threshold.trials import BLAME, METHODS, Trial, mixed, spoilt, tolerant, tried
from core.experiments.wide import simulated_frames
from core.frame import Frame
from core.geometry.grid import VoxelGrid
from core.hull.shadow import CarvingRule
from core.silhouettes.extraction import extract_silhouette
from core.targets import Target, tiangong_like

WRONG = (0, 1, 2, 3, 5, 10)
"""Numbers of wrong frames."""

OF_ONE_KIND = 3
"""Wrong frames where all have the same fault."""

RULES: tuple[CarvingRule, ...] = ("shadow", "strict")


def run_threshold(
    *,
    views: int = 80,
    spacing_m: float = 0.15,
    scatterers: int = 60_000,
    signal_to_noise_db: float = 20.0,
    seed: int = 1,
    wrong: Sequence[int] = WRONG,
    draws: int = 3,
    progress: Progress = lambda _stage, _done, _total: None,
) -> Study:
    """Spoil some frames of a wide sequence, and carve it by vote thresholds and after blame.

    The faults are those of practice, in turn: too small by a too-high threshold, too large by
    clutter that joins the target, shifted by a mis-centred frame, and another body's frame. Blame
    never sees which frames are wrong.

    Args:
        views: random directions over the sphere.
        spacing_m: voxel spacing.
        scatterers: points on the target's surface.
        signal_to_noise_db: as in `simulate_echoes`.
        seed: of the random generator.
        wrong: numbers of wrong frames, growing.
        draws: choices of wrong frames over which results are averaged.
        progress: told of stage, steps done and steps in all.

    Raises:
        ValueError: fewer views than wrong frames and two right ones, or parameters a stage refuses.
    """
    if views < max(*wrong, OF_ONE_KIND) + 2:
        raise ValueError(
            f"{max(*wrong, OF_ONE_KIND)} wrong frames need at least two right ones beside them; "
            f"got {views} views."
        )
    target = tiangong_like()
    right, faults = _sequence(target, views, scatterers, signal_to_noise_db, seed, progress)
    grid = VoxelGrid.cube(side_m=21.0, spacing_m=spacing_m)
    truth = target.voxels(grid)
    orders = [np.random.default_rng((seed, n)).permutation(len(right)) for n in range(draws)]

    spoiling = [
        spoilt(right, order[: max(wrong)].tolist(), [*faults.values()], seed=seed)
        for order in orders
    ]
    trials: dict[tuple[CarvingRule, int], list[Trial]] = {}
    for rule in RULES:
        for count in wrong:
            trials[rule, count] = [
                tried(
                    mixed(right, bad, order[:count].tolist()),
                    order[:count].tolist(),
                    rule,
                    grid,
                    truth,
                )
                for order, bad in zip(orders, spoiling, strict=True)
            ]
            progress("wrong frames", len(trials), len(RULES) * len(wrong))
    chosen = orders[0][:OF_ONE_KIND].tolist()
    by_kind = {}
    for kind, fault in faults.items():
        frames = spoilt(right, chosen, [fault], seed=seed)
        by_kind[kind] = [tried(frames, chosen, "shadow", grid, truth, suffering=True)]
        progress("kinds of fault", len(by_kind), len(faults))
    results = Results(
        name="threshold",
        settings={
            "target": target.name,
            "views": views,
            "wrong frames": list(wrong),
            "draws of them": draws,
            "blame excludes": f"the worst while the log of what it alone removes + {LEAST_M3} m³ "
            f"lies over {OUTLYING:g} robust deviations (MAD) above the median",
            "spacing_m": spacing_m,
            "scatterers": scatterers,
            "signal_to_noise_db": signal_to_noise_db,
            "seed": seed,
        },
        figures=_figures(trials, by_kind),
        tables=(*(_table(trials, rule) for rule in RULES), _kinds_table(by_kind)),
        finding=_finding(trials, by_kind),
    )
    worst = trials["shadow", max(wrong)][0]
    clean = trials["shadow", min(wrong)][0]
    before, after = worst.surfaces
    pictures = (
        curves_picture(trials),
        frames_picture(
            [spoiling[0][number] for number in orders[0][: len(faults)]],
            target,
            name="threshold-frames",
            caption=f"Wrong frames and their outlines, with the true ones: {', '.join(faults)}. "
            "Each outline is extracted from its frame; the true one is where the target should be.",
        ),
        rivals_picture(
            {
                f"{min(wrong)} wrong": clean.surfaces[0],
                f"{max(wrong)} wrong": before,
                "after blame": after,
            },
            target,
            name="threshold-hulls",
            what="Hulls by the shadow rule with all votes, one draw",
        ),
        *error_pictures(after, target, name="threshold-errors", most_m=1.0),
    )
    return Study(results=results, pictures=pictures, hull=after)


def _sequence(
    target: Target,
    views: int,
    scatterers: int,
    signal_to_noise_db: float,
    seed: int,
    progress: Progress,
) -> tuple[list[OutlinedFrame], Mapping[str, Fault]]:
    """Return the right frames, and the faults by name; the stranger is seen along the same lines.

    Frames that show nothing of the target have no outline that could be wrong; they are left out.
    """

    def seen(body: Target) -> list[Frame]:
        return simulated_frames(
            body,
            views=views,
            scatterers=scatterers,
            signal_to_noise_db=signal_to_noise_db,
            random=np.random.default_rng(seed),  # the same seed gives the same directions
            progress=lambda _stage, done, total: progress(body.name, done, total),
        )

    ours, strange = seen(target), seen(spent_stage())
    pairs = [OutlinedFrame(frame=each, silhouette=extract_silhouette(each)) for each in ours]
    faults: Mapping[str, Fault] = {
        SMALL: too_small,
        LARGE: too_large,
        SHIFTED: shifted,
        FOREIGN: foreign({each.time_s: each for each in strange}),
    }
    return [each for each in pairs if not each.silhouette.is_empty], faults


def _figures(trials: Trials, by_kind: Mapping[str, Sequence[Trial]]) -> tuple[Figure, ...]:
    figures = []
    for (rule, count), each in trials.items():
        for method in METHODS:
            name = f"{rule} rule, {count} wrong, {method}"
            error = _mean_error(each, method)
            figures += [
                Figure(name=f"{name}: IoU", value=mean_of(each, method, "intersection_over_union")),
                Figure(name=f"{name}: coverage", value=mean_of(each, method, "coverage")),
                Figure(name=f"{name}: span error", value=error, unit="%"),
            ]
        found, false = _mean_counts(each)
        figures += [
            Figure(name=f"{rule} rule, {count} wrong: found by blame", value=found),
            Figure(name=f"{rule} rule, {count} wrong: right ones accused", value=false),
        ]
    for kind, each in by_kind.items():
        found, false = _mean_counts(each)
        head = f"{OF_ONE_KIND} {kind}"
        figures += [
            Figure(name=f"{head}, {method}: coverage", value=mean_of(each, method, "coverage"))
            for method in METHODS
        ]
        figures += [
            Figure(name=f"{head}: found by blame", value=found),
            Figure(name=f"{head}: right ones accused", value=false),
        ]
    return tuple(figures)


def _mean_error(trials: Sequence[Trial], method: str) -> float | None:
    """Return the mean size of the span's error, None where a draw loses it."""
    errors = [trial.outcomes[method].error_percent for trial in trials]
    kept = [abs(error) for error in errors if error is not None]
    return float(np.mean(kept)) if len(kept) == len(errors) else None


def _mean_counts(trials: Sequence[Trial]) -> tuple[float, float]:
    return (
        float(np.mean([trial.found for trial in trials])),
        float(np.mean([trial.falsely_accused for trial in trials])),
    )


def _cell(trials: Sequence[Trial], method: str) -> str:
    iou, coverage = (
        mean_of(trials, method, attribute) for attribute in ("intersection_over_union", "coverage")
    )
    error = _mean_error(trials, method)
    return f"{iou:.3f}, {coverage:.3f}, {'lost' if error is None else f'{error:.1f} %'}"


def _table(trials: Trials, rule: CarvingRule) -> Table:
    rows = []
    for count in [count for of, count in trials if of == rule]:
        each = trials[rule, count]
        found, false = _mean_counts(each)
        cells = [_cell(each, method) for method in METHODS]
        rows.append((f"{count}", *cells, f"{found:.1f}", f"{false:.1f}"))
    return Table(
        title=f"{rule.capitalize()} rule, from echoes: IoU, coverage, span error; means over draws",
        columns=("wrong frames", *METHODS, "found by blame", "right ones accused"),
        rows=tuple(rows),
    )


def _kinds_table(by_kind: Mapping[str, Sequence[Trial]]) -> Table:
    rows = []
    for kind, each in by_kind.items():
        found, false = _mean_counts(each)
        suffer = [len(trial.wrong.intersection(trial.suffering)) for trial in each]
        others = [len(set(trial.suffering) - trial.wrong) for trial in each]
        rows.append(
            (
                kind,
                *(_cell(each, method) for method in (tolerant(0), tolerant(2), BLAME)),
                f"{found:.1f}",
                f"{false:.1f}",
                f"{np.mean(suffer):.1f}, {np.mean(others):.1f}",
            )
        )
    return Table(
        title=f"{OF_ONE_KIND} wrong frames of one kind, shadow rule: IoU, coverage, span error",
        columns=(
            "kind",
            tolerant(0),
            tolerant(2),
            BLAME,
            "found by blame",
            "right ones accused",
            "suffer then: wrong, right",
        ),
        rows=tuple(rows),
    )


def _finding(trials: Trials, by_kind: Mapping[str, Sequence[Trial]]) -> str:
    counts = sorted(count for rule, count in trials if rule == "shadow")
    few, many = trials["shadow", counts[0]], trials["shadow", counts[-1]]

    def iou(each: Sequence[Trial], method: str) -> float:
        return mean_of(each, method, "intersection_over_union")

    best = max((method for method in METHODS if method != BLAME), key=lambda m: iou(many, m))
    found, false = _mean_counts(many)
    kinds = ", ".join(f"{_mean_counts(each)[0]:.1f} {kind}" for kind, each in by_kind.items())
    strict = max(iou(trials["strict", count], method) for count in counts for method in METHODS)
    return (
        f"By the shadow rule with all votes {counts[-1]} wrong frames bring the IoU from "
        f"{iou(few, tolerant(0)):.3f} to {iou(many, tolerant(0)):.3f}; the best tolerance "
        f"({best}) gives {iou(many, best):.3f}, and excluding whom blame names "
        f"{iou(many, BLAME):.3f}: it finds {found:.1f} of them and accuses {false:.1f} right ones. "
        f"Of {OF_ONE_KIND} of one kind it finds {kinds}: an outline too large carves nothing wrong "
        "and needs no repair. The strict rule has nothing to repair: even tolerating misses its "
        f"IoU never exceeds {strict:.3f}."
    )
