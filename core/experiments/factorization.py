"""The paper's experiment C: lengths and attitude by factorization, by ISEA, and by our hull."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from core.experiments.beijing_pass import BeijingPass, beijing_pass
from core.experiments.factored_lines import (
    CASES,
    Tracked,
    factored,
    missing_cases,
    with_known_length,
)
from core.experiments.factorization_picture import missing_picture
from core.experiments.frame_pictures import OutlinedFrame, frames_picture
from core.experiments.hull_pictures import error_pictures, sides_picture
from core.experiments.lines_found import LinesFound, lines_table
from core.experiments.mro_scene import (
    POINTS,
    Motion,
    accumulated_lines,
    carved_surface,
    echo_frames,
    hull_lines,
    lit_sides,
    outlined,
    pass_motion,
    scatterers_with_ends,
    wide_motion,
)
from core.experiments.pictures import Picture
from core.experiments.results import Figure, Results, Table
from core.experiments.study import Progress, Study
from core.hull.surface import Surface
from core.measurement.observability import observability
from core.targets import LineFeature, Target, mro_like

MISSING = tuple(number / 10 for number in range(1, 10))
"""Shares of a frame's scatterers that it does not show."""

MISSING_FROM_ECHOES = (0.1, 0.5, 0.9)
"""At which our hull is carved anew from echoes."""

WRONG = 0.1
"""Probability of a wrong association where points are missing too."""

LENGTH_WANTED, ATTITUDE_WANTED = "<= 0.7 %", "<= 0.5 °"

KNOWN = 1
"""The line whose true length scales a factorization: the longest."""

OURS, ISEA = "ours, from echoes", "energy accumulation (ISEA)"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Ours:
    """What came from the echoes of wide views."""

    found: list[OutlinedFrame]
    surface: Surface
    lines: LinesFound
    accumulated: LinesFound
    motion: Motion


def run_factorization(
    *,
    views: int = 80,
    spacing_m: float = 0.2,
    scatterers: int = 80_000,
    resolution_m: float = 0.15,
    signal_to_noise_db: float = 20.0,
    seed: int = 1,
    points: int = POINTS,
    pass_frames: int | None = None,
    missing: Sequence[float] = MISSING,
    missing_from_echoes: Sequence[float] = MISSING_FROM_ECHOES,
    progress: Progress = lambda _stage, _done, _total: None,
) -> Study:
    """Measure three lines of an MRO-like orbiter by factorization, by ISEA and by our hull.

    Factorization gets tracks, as in the paper; ISEA and the hull get simulated echoes of the same
    views. Factorization without cross-range in metres is shown on wide views; on a pass it has
    many solutions, so that the scaled form stands beside it.

    Args:
        views: random directions over the sphere.
        spacing_m: voxel spacing, of ISEA's candidate places too.
        scatterers: points on the surface for the echoes.
        resolution_m: of the images in range and cross-range.
        signal_to_noise_db: as in `simulate_echoes`.
        seed: of the random generator.
        points: scatterers that the factorization tracks, and the most that ISEA finds.
        pass_frames: of the pass's intervals, so many; None for all.
        missing: shares of points that tracks lack.
        missing_from_echoes: shares of scatterers that each frame's echoes lack.
        progress: told of stage, steps done and steps in all.

    Raises:
        ValueError: parameters a stage refuses.
    """
    target = mro_like()
    features = target.features
    radar = _Echoes(
        views=views,
        scatterers=scatterers,
        resolution_m=resolution_m,
        signal_to_noise_db=signal_to_noise_db,
        seed=seed,
        progress=progress,
    )
    ours = _from_echoes(target, radar, spacing_m, points)
    points_m = scatterers_with_ends(points, np.random.default_rng(seed))
    wide = Tracked(points_m=points_m, motion=ours.motion, scaled=False, seed=seed)
    seen = beijing_pass(frames=pass_frames)
    passing = Tracked(points_m=points_m, motion=pass_motion(seen), scaled=True, seed=seed)
    missed: dict[str, Mapping[float, LinesFound]] = {
        "tracks": missing_cases(wide, features, missing),
        "tracks, 10 % wrong": missing_cases(wide, features, missing, jump=WRONG),
    }
    missed["ours, echoes"] = {0.0: ours.lines} | {
        share: _hull_with_missing(target, radar, spacing_m, share) for share in missing_from_echoes
    }
    progress("factorizations", 1, 1)
    on_wide = _cases(wide, features)
    tables = (
        lines_table(
            "Table 2 on wide views, cross-range unscaled",
            [*on_wide, ours.accumulated, ours.lines],
            features,
        ),
        lines_table(
            "Table 2 on one pass, from tracks",
            _pass_cases(passing, features),
            features,
        ),
        _pass_table(seen, features),
        _missing_table(missed),
    )
    results = Results(
        name="factorization",
        settings={
            "target": target.name,
            "views": views,
            "spacing_m": spacing_m,
            "scatterers": scatterers,
            "resolution_m": resolution_m,
            "signal_to_noise_db": signal_to_noise_db,
            "seed": seed,
            "tracked points": points,
            "the paper's own numbers": "not at hand, so that no column shows them; its true "
            "lengths and directions are those of the target",
        },
        figures=_figures(ours, on_wide, missed),
        tables=tables,
        finding=_finding(ours, on_wide),
    )
    return Study(results=results, pictures=_pictures(ours, target, missed), hull=ours.surface)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Echoes:
    """What the echoes are simulated with."""

    views: int
    scatterers: int
    resolution_m: float
    signal_to_noise_db: float
    seed: int
    progress: Progress

    def found(self, target: Target, visible: float) -> list[OutlinedFrame]:
        return outlined(
            echo_frames(
                target,
                views=self.views,
                scatterers=self.scatterers,
                signal_to_noise_db=self.signal_to_noise_db,
                seed=self.seed,
                resolution_m=self.resolution_m,
                visible=visible,
                progress=self.progress,
            )
        )


def _from_echoes(target: Target, radar: _Echoes, spacing_m: float, points: int) -> _Ours:
    found = radar.found(target, 1.0)
    frames = [each.frame for each in found]
    surface = carved_surface(found, spacing_m=spacing_m)
    accumulated, _ = accumulated_lines(
        ISEA, frames, spacing_m=spacing_m, most=points, progress=radar.progress
    )
    return _Ours(
        found=found,
        surface=surface,
        lines=hull_lines(OURS, surface),
        accumulated=accumulated,
        motion=wide_motion(frames, np.random.default_rng(radar.seed)),
    )


def _hull_with_missing(
    target: Target, radar: _Echoes, spacing_m: float, share: float
) -> LinesFound:
    surface = carved_surface(radar.found(target, 1 - share), spacing_m=spacing_m)
    return hull_lines(f"{OURS}, {100 * share:.0f} % missing", surface)


def _cases(tracked: Tracked, features: Sequence[LineFeature]) -> list[LinesFound]:
    rows = []
    for name, glint, robust in CASES:
        found = factored(
            tracked, features, name=f"factorization, {name}", glint=glint, robust=robust
        )
        rows += [found, with_known_length(found, KNOWN, suffix="; l2 known")]
    return rows


def _pass_cases(tracked: Tracked, features: Sequence[LineFeature]) -> list[LinesFound]:
    unscaled = Tracked(
        points_m=tracked.points_m, motion=tracked.motion, scaled=False, seed=tracked.seed
    )
    rows = []
    for name, glint, robust in CASES:
        for form, each in (("unscaled", unscaled), ("scaled", tracked)):
            title = f"{form}, {name}"
            rows.append(factored(each, features, name=title, glint=glint, robust=robust))
    name, glint, _ = CASES[1]
    forced = factored(
        unscaled,
        features,
        name=f"unscaled, {name}, its best guess",
        glint=glint,
        even_if_ambiguous=True,
    )
    return [*rows, forced]


def _figures(
    ours: _Ours,
    on_wide: Sequence[LinesFound],
    missed: Mapping[str, Mapping[float, LinesFound]],
) -> tuple[Figure, ...]:
    names = [feature.name for feature in mro_like().features]
    figures = [
        Figure(
            name="ours: mean length error",
            value=ours.lines.mean_error_percent(),
            unit="%",
            wanted=LENGTH_WANTED,
        ),
        *(
            Figure(
                name=f"ours: attitude error of {name}", value=v, unit="°", wanted=ATTITUDE_WANTED
            )
            for name, v in zip(names, ours.lines.attitude_errors_deg(), strict=True)
        ),
    ]
    shares = [each for rows in missed.values() for each in rows.values() if each is not ours.lines]
    for each in (*on_wide, ours.accumulated, *shares):
        figures += _reported(each)
    return tuple(figures)


def _reported(each: LinesFound) -> list[Figure]:
    return [
        Figure(name=f"{each.method}: mean length error", value=each.mean_error_percent(), unit="%"),
        Figure(
            name=f"{each.method}: worst attitude error", value=each.worst_attitude_deg(), unit="°"
        ),
    ]


def _pass_table(seen: BeijingPass, features: Sequence[LineFeature]) -> Table:
    constrained = observability(lit_sides(seen))
    cells = [
        f"{constrained.grade(each.direction)} ({constrained.dilution(each.direction):.1f})"
        for each in features
    ]
    return Table(
        title="Our hull on that pass alone: grade and dilution of lengths along each line",
        columns=("frames", *(feature.name for feature in features)),
        rows=((f"{len(seen.intervals)} lit sides", *cells),),
    )


def _missing_table(missed: Mapping[str, Mapping[float, LinesFound]]) -> Table:
    shares = sorted({share for rows in missed.values() for share in rows})
    return Table(
        title="Points missing from tracks (noise of 0.3 cells), scatterers missing from echoes: "
        "mean length error and worst attitude error",
        columns=("missing in each frame", *missed),
        rows=tuple(
            (f"{100 * share:.0f} %", *(_errors_text(rows.get(share)) for rows in missed.values()))
            for share in shares
        ),
    )


def _errors_text(found: LinesFound | None) -> str:
    if found is None:
        return "not run"
    mean, worst = found.mean_error_percent(), found.worst_attitude_deg()
    if mean is None or worst is None:
        return found.note or "a line is lost"
    return f"{mean:.3f} %, {worst:.3f}°"


def _finding(ours: _Ours, on_wide: Sequence[LinesFound]) -> str:
    perfect, glinting, robust = on_wide[0], on_wide[4], on_wide[6]
    return (
        "Mean length error and worst attitude error on wide views: from echoes our hull has "
        f"{_errors_text(ours.lines)}, energy accumulation {_errors_text(ours.accumulated)}. "
        f"Factorization, which is given tracks, has {_errors_text(perfect)} on perfect ones, "
        f"{_errors_text(glinting)} when 30 % of their points are missing and 10 % wrong, and "
        f"{_errors_text(robust)} with a robust loss."
    )


def _pictures(
    ours: _Ours,
    target: Target,
    missed: Mapping[str, Mapping[float, LinesFound]],
) -> tuple[Picture, ...]:
    return (
        frames_picture(
            ours.found,
            target,
            name="factorization-frames",
            caption="Radar frames of the orbiter with the outlines found and the true ones.",
        ),
        sides_picture(
            ours.surface, target, name="factorization-hull", what="Hull from wide views' echoes"
        ),
        *error_pictures(ours.surface, target, name="factorization-errors", most_m=1.0),
        missing_picture(missed),
    )
