"""Rules of voting on targets that shadow themselves, over several angular scopes."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure as Canvas

from core.experiments.carved_hull import carved_hull
from core.experiments.frame_pictures import frames_picture
from core.experiments.hull_pictures import error_pictures, sides_picture
from core.experiments.limited import radar_views
from core.experiments.pictures import Picture
from core.experiments.results import Figure, Results, Table
from core.experiments.scopes import SCOPES, TARGETS, Scene, scene
from core.experiments.study import Progress, Study
from core.experiments.voting_rules import (
    BEST_ENERGY,
    ENERGY,
    METHODS,
    SHADOW,
    STRICT,
    VotedBody,
    voted_bodies,
)
from core.hull.shadow import CarvingRule

Scoped = Mapping[tuple[str, str], tuple[VotedBody, ...]]
"""The bodies of each target's name and scope."""


def run_shadow(
    *,
    frames: int = 40,
    spacing_m: float = 0.2,
    scatterers: int = 40_000,
    signal_to_noise_db: float = 20.0,
    seed: int = 1,
    targets: Sequence[str] = tuple(TARGETS),
    progress: Progress = lambda _stage, _done, _total: None,
) -> Study:
    """Carve self-shadowing targets by several rules of voting, from several angular scopes.

    Every scope has as many frames, drawn from four times as many from all around, so that what
    differs is where they look from and not how many they are. All silhouettes come from echoes.

    Args:
        frames: of each scope.
        spacing_m: voxel spacing; the orbiter, 58 m wide, has twice as much.
        scatterers: points on each target's surface.
        signal_to_noise_db: as in `simulate_echoes`.
        seed: of the random generator.
        targets: which of "laboratory", "winged box" and "orbiter".
        progress: told of stage, steps done and steps in all.

    Raises:
        ValueError: fewer than four frames, or parameters a stage refuses.
    """
    if frames < 4:
        raise ValueError(f"A scope needs at least 4 frames, got {frames}.")
    scenes = {
        name: scene(
            name,
            views=4 * frames,
            spacing_m=spacing_m,
            scatterers=scatterers,
            signal_to_noise_db=signal_to_noise_db,
            seed=seed,
            progress=progress,
        )
        for name in targets
    }
    bodies: dict[tuple[str, str], tuple[VotedBody, ...]] = {}
    for name, seen in scenes.items():
        grid = seen.grid()
        truth = seen.target.voxels(grid)
        for scope in SCOPES:
            found = seen.within(scope, frames)
            bodies[name, scope] = voted_bodies(found, grid, seen.target, truth)
            progress("rules of voting", len(bodies), len(scenes) * len(SCOPES))
    shown = next(iter(scenes))
    return _study(
        scenes[shown],
        bodies,
        frames,
        {
            "targets": [seen.target.name for seen in scenes.values()],
            "frames of each scope": frames,
            "spacing_m": spacing_m,
            "scatterers": scatterers,
            "signal_to_noise_db": signal_to_noise_db,
            "seed": seed,
        },
    )


def _study(seen: Scene, bodies: Scoped, frames: int, settings: dict[str, object]) -> Study:
    results = Results(
        name="shadow",
        settings=settings,
        figures=_figures(bodies),
        tables=tuple(_table(name, bodies) for name in dict.fromkeys(n for n, _ in bodies)),
        finding=_finding(bodies),
    )
    grid = seen.grid()
    found = seen.within("all around", frames)
    truth = seen.target.voxels(grid)
    rules: tuple[CarvingRule, ...] = ("shadow", "strict")
    ours, strict = (carved_hull(radar_views(found, rule), grid, truth).surface for rule in rules)
    target = seen.target
    pictures = (
        frames_picture(
            found,
            target,
            name="shadow-frames",
            caption="Frames from all around with the outlines found and the true ones: range down, "
            "cross-range right, 45 dB of amplitude. What lies behind the first return is dark.",
        ),
        _rules_picture(bodies),
        sides_picture(ours, target, name="shadow-hull", what="Hull by the shadow rule"),
        sides_picture(strict, target, name="strict-hull", what="Hull by the strict rule"),
        *error_pictures(ours, target, name="shadow-errors"),
    )
    return Study(results=results, pictures=pictures, hull=ours)


def _figures(bodies: Scoped) -> tuple[Figure, ...]:
    figures = []
    for (name, scope), each in bodies.items():
        for body in each:
            head = f"{name}, {scope}, {body.method}"
            figures += [
                Figure(name=f"{head}: IoU", value=body.agreement.intersection_over_union),
                Figure(name=f"{head}: coverage", value=body.agreement.coverage),
                Figure(
                    name=f"{head}: length error",
                    value=None if body.length_error is None else 100 * body.length_error,
                    unit="%",
                ),
            ]
    return tuple(figures)


def _table(name: str, bodies: Scoped) -> Table:
    rows = [
        (
            scope if body.method == STRICT else "",
            body.method,
            f"{body.agreement.intersection_over_union:.3f}",
            f"{body.agreement.coverage:.3f}",
            f"{body.volume_m3:.1f}",
            "none" if body.length_error is None else f"{100 * body.length_error:+.1f} %",
        )
        for (of, scope), each in bodies.items()
        if of == name
        for body in each
    ]
    return Table(
        title=f"Rules of voting on the {name}",
        columns=("lines of sight", "rule", "IoU", "coverage", "volume (m³)", "longest line"),
        rows=tuple(rows),
    )


def _finding(bodies: Scoped) -> str:
    around = [each for (_, scope), each in bodies.items() if scope == "all around"]
    mean = {method: _mean_iou(around, method) for method in METHODS}
    soft = max(METHODS[1:4], key=lambda method: mean[method])
    kept = {
        method: 100 * np.mean([_of(each, method).agreement.coverage for each in bodies.values()])
        for method in (SHADOW, soft, STRICT)
    }
    lost = [
        f"{name}, {scope} ({best.method}: {_iou(best):.2f} against {_iou(_of(each, SHADOW)):.2f})"
        for (name, scope), each in bodies.items()
        if (best := max(each[:-1], key=_iou)).method != SHADOW
    ]
    return (
        f"From all around, the shadow rule reaches a mean IoU of {mean[SHADOW]:.3f}, the strict "
        f"rule {mean[STRICT]:.3f}, the best soft threshold ({soft}) {mean[soft]:.3f} and energy "
        f"accumulation {mean[ENERGY]:.3f} ({mean[BEST_ENERGY]:.3f} at the level that agrees best "
        f"with the truth). Over all scopes it keeps {kept[SHADOW]:.0f} % of the targets, {soft} "
        f"keeps {kept[soft]:.0f} % and the strict rule {kept[STRICT]:.0f} %. It has the best IoU "
        f"in {len(bodies) - len(lost)} of {len(bodies)} cases"
        + (f", not in: {'; '.join(lost)}." if lost else ".")
    )


def _mean_iou(around: Sequence[Sequence[VotedBody]], method: str) -> float:
    return float(np.mean([_iou(_of(each, method)) for each in around]))


def _iou(body: VotedBody) -> float:
    return body.agreement.intersection_over_union


def _of(bodies: Sequence[VotedBody], method: str) -> VotedBody:
    return next(body for body in bodies if body.method == method)


def _rules_picture(bodies: Scoped) -> Picture:
    names = list(dict.fromkeys(name for name, _ in bodies))

    def draw(canvas: Canvas) -> None:
        cells = canvas.subplots(2, len(names), squeeze=False, sharey="row")
        for column, name in enumerate(names):
            for row, quantity in enumerate(("intersection_over_union", "coverage")):
                cell = cells[row, column]
                for number, scope in enumerate(SCOPES):
                    values = [getattr(b.agreement, quantity) for b in bodies[name, scope]]
                    places = np.arange(len(METHODS)) + 0.2 * (number - 1.5)
                    cell.bar(places, values, width=0.18, label=scope)
                cell.set_xticks(np.arange(len(METHODS)), METHODS, rotation=25, ha="right")
                cell.set_ylim(0, 1)
                cell.set_title(f"{name}: {quantity.replace('_', ' ')}")
        cells[0, 0].legend(loc="upper left")

    return Picture(
        name="shadow-rules",
        caption="Agreement with the truth by rule of voting and scope of the lines of sight, as "
        "many frames in each.",
        draw=draw,
        size_in=(5.0 * len(names), 7.5),
    )
