"""Tables, figures and finding of the experiment on passes and stations."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import spearmanr

from core.arrays import Floats
from core.experiments.carved_hull import COLUMNS, CarvedHull
from core.experiments.results import Figure, Results, Table
from core.hull.view import View

CRITERIA = ("expected carving", "ball's hull", "culmination")
"""What candidates are ranked by: the first is ours, the others are there to compare."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SeenHull:
    """The hull of some arcs.

    Attributes:
        views: from echoes, as they voted.
        echoes: the hull they carve.
        true: the hull of the true outlines of the same frames.
        unobserved_percent: share of directions along which the views measure nothing.
    """

    views: tuple[View, ...]
    echoes: CarvedHull
    true: CarvedHull
    unobserved_percent: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Candidate:
    """A pass that may be observed next.

    Attributes:
        label: of the pass.
        elevation_deg: of its culmination at the station.
        predicted_m3: volume that it is expected to carve.
        ball_m3: by how much it would reduce the hull of a ball, whatever the target is.
        confirmed_m3: volume that its echoes truly carved.
    """

    label: str
    elevation_deg: float
    predicted_m3: float
    ball_m3: float
    confirmed_m3: float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Seen:
    """All that was observed.

    Attributes:
        true_m3: volume of the target's voxels.
        true_extents_m: of the target along x, y, z.
        growth: hulls of 1, 2, 4, 8 passes.
        together: hulls of stations that see one pass.
        bistatic_deg: least and greatest angle of the bistatic pair.
        candidates: by the number of passes that they would follow.
    """

    true_m3: float
    true_extents_m: Sequence[float]
    growth: Mapping[str, SeenHull]
    together: Mapping[str, SeenHull]
    bistatic_deg: tuple[float, float]
    candidates: Mapping[int, tuple[Candidate, ...]]


def rank_correlations(candidates: Sequence[Candidate]) -> tuple[float, ...]:
    """Return Spearman's ρ of each of `CRITERIA` with what was carved; 0 if one never differs."""
    scores, confirmed = _scores(candidates), _confirmed_m3(candidates)
    return tuple(
        0.0
        if np.ptp(score) == 0 or np.ptp(confirmed) == 0
        else float(spearmanr(score, confirmed).statistic)
        for score in scores
    )


def gain_percent(candidates: Sequence[Candidate]) -> tuple[float, ...]:
    """Return what each criterion's best pass carved, in percent of what the truly best did."""
    confirmed = _confirmed_m3(candidates)
    best = float(confirmed.max())
    return tuple(
        100 * float(confirmed[score.argmax()]) / best if best > 0 else 100.0
        for score in _scores(candidates)
    )


def passes_results(seen: Seen, settings: Mapping[str, object]) -> Results:
    """Return the experiment's results, finding included."""
    tables = (
        _hulls_table("Passes over Beijing, one after another", seen.growth, seen),
        _hulls_table("One pass, several stations at once", seen.together, seen),
        *(_candidates_table(count, each) for count, each in seen.candidates.items()),
        _criteria_table(seen.candidates),
    )
    return Results(
        name="passes",
        settings=settings,
        figures=_figures(seen),
        tables=tables,
        finding=_finding(seen),
    )


def extent_error_percent(hull: CarvedHull, axis: int, true_m: float) -> float | None:
    """Return the error of an extent in percent, None where it is not bounded."""
    if not hull.extents or not hull.extents[axis].is_bounded:
        return None
    return 100 * (hull.extents[axis].value_m / true_m - 1)


def _scores(candidates: Sequence[Candidate]) -> tuple[Floats, ...]:
    return tuple(
        np.array([getattr(each, name) for each in candidates])
        for name in ("predicted_m3", "ball_m3", "elevation_deg")
    )


def _confirmed_m3(candidates: Sequence[Candidate]) -> Floats:
    return np.array([each.confirmed_m3 for each in candidates])


def _figures(seen: Seen) -> tuple[Figure, ...]:
    figures: list[Figure] = []
    for name, each in {**seen.growth, **seen.together}.items():
        figures += each.echoes.figures(name)
        figures.append(
            Figure(name=f"{name}: directions unobserved", value=each.unobserved_percent, unit="%")
        )
        for axis, true_m in enumerate(seen.true_extents_m):
            error = extent_error_percent(each.echoes, axis, true_m)
            title = f"{name}: error of extent {'xyz'[axis]}"
            figures.append(Figure(name=title, value=error, unit="%"))
        volume_m3, iou = each.true.volume_m3, each.true.agreement.intersection_over_union
        figures.append(Figure(name=f"{name}, true outlines: volume", value=volume_m3, unit="m³"))
        figures.append(Figure(name=f"{name}, true outlines: IoU", value=iou))
    for count, candidates in seen.candidates.items():
        after = f"next after {count}"
        ranks, gains = rank_correlations(candidates), gain_percent(candidates)
        for criterion, rank, gain in zip(CRITERIA, ranks, gains, strict=True):
            figures.append(Figure(name=f"{after}, {criterion}: rank correlation", value=rank))
            title = f"{after}, {criterion}: its best carves, of the best"
            figures.append(Figure(name=title, value=gain, unit="%"))
    return tuple(figures)


def _hulls_table(title: str, hulls: Mapping[str, SeenHull], seen: Seen) -> Table:
    rows = []
    for name, each in hulls.items():
        unobserved = f"{each.unobserved_percent:.0f} %"
        rows.append((*each.echoes.row(name), unobserved, f"{len(each.views)}"))
        rows.append((*each.true.row(f"{name}, true outlines"), "", f"{len(each.views)}"))
    sizes = (f"{size:.2f}" for size in seen.true_extents_m)
    rows.append(("truth", "1.000", "1.000", f"{seen.true_m3:.1f}", *sizes, "", ""))
    return Table(title=title, columns=(*COLUMNS, "unobserved", "frames"), rows=tuple(rows))


def _candidates_table(count: int, candidates: Sequence[Candidate]) -> Table:
    *places, came = (_places(score) for score in (*_scores(candidates), _confirmed_m3(candidates)))
    rows = tuple(
        (
            each.label,
            f"{each.elevation_deg:.0f}° ({places[2][number]})",
            f"{each.predicted_m3:.1f} ({places[0][number]})",
            f"{each.ball_m3:.1f} ({places[1][number]})",
            f"{each.confirmed_m3:.1f} ({came[number]})",
        )
        for number, each in enumerate(candidates)
    )
    return Table(
        title=f"The next pass after {count}: predicted and confirmed, rank in brackets",
        columns=(
            "pass",
            "culmination",
            "expected carving (m³)",
            "ball's hull (m³)",
            "carved by its echoes (m³)",
        ),
        rows=rows,
    )


def _places(score: Floats) -> list[int]:
    """Return every score's place, 1 for the greatest."""
    return [1 + int(np.count_nonzero(score > each)) for each in score]


def _criteria_table(candidates: Mapping[int, Sequence[Candidate]]) -> Table:
    rows = []
    for count, each in candidates.items():
        for row in zip(CRITERIA, rank_correlations(each), gain_percent(each), strict=True):
            criterion, rank, gain = row
            verdict = "yes" if gain == 100 else "no"
            rows.append((f"after {count}: {criterion}", f"{rank:+.2f}", verdict, f"{gain:.1f} %"))
    return Table(
        title="How well each criterion ranked the candidates",
        columns=("criterion", "rank correlation", "best found", "carved, of the best"),
        rows=tuple(rows),
    )


def _finding(seen: Seen) -> str:
    growth = list(seen.growth.values())
    first, last = growth[0], growth[-1]
    steps = ", ".join(f"{each.echoes.volume_m3:.0f}" for each in growth)
    counts = ", ".join(name.split()[0] for name in seen.growth)
    stations = list(seen.together.values())
    three, pair = stations[-2], stations[2]
    least, most = seen.bistatic_deg
    return (
        f"Of a body of {seen.true_m3:.0f} m³, {counts} passes over one station leave {steps} m³ "
        f"(IoU {_iou(first.echoes)} to {_iou(last.echoes)}; true outlines up to "
        f"{_iou(last.true)}), and the share of unobserved directions falls from "
        f"{first.unobserved_percent:.0f} to {last.unobserved_percent:.0f} %; "
        f"three stations in one pass leave {three.echoes.volume_m3:.0f} m³, one station with a "
        f"bistatic receiver ({least:.0f} to {most:.0f}°) {pair.echoes.volume_m3:.0f} m³. "
        + " ".join(_choice(count, each) for count, each in seen.candidates.items())
    )


def _choice(count: int, candidates: Sequence[Candidate]) -> str:
    ranks, gain = rank_correlations(candidates), gain_percent(candidates)[0]
    ratios = [
        100 * each.predicted_m3 / each.confirmed_m3 for each in candidates if each.confirmed_m3 > 0
    ]
    best = "was the best" if gain == 100 else f"brought {gain:.1f} % of what the best did"
    others = " and ".join(
        f"{rank:.2f} by {name}" for name, rank in zip(CRITERIA[1:], ranks[1:], strict=True)
    )
    volumes = (
        f"; the expected volumes were {min(ratios):.0f} to {max(ratios):.0f} % of what came"
        if ratios
        else ""
    )
    return (
        f"After {count}, the pass expected to carve most {best} of {len(candidates)}, but the "
        f"whole list is ranked {_quality(ranks)}: rank correlation {ranks[0]:.2f}, against "
        f"{others}{volumes}."
    )


def _quality(ranks: Sequence[float]) -> str:
    return "better than by the others" if ranks[0] > max(ranks[1:]) else "no better than by others"


def _iou(hull: CarvedHull) -> str:
    return f"{hull.agreement.intersection_over_union:.3f}"
