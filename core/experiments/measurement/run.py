"""`radarhull experiment measurement`: every part, one after another."""

from collections.abc import Callable, Mapping
from dataclasses import asdict
from functools import partial

from core.experiments.interval_coverage import interval_coverage
from core.experiments.measurement.accuracies import echoes_part, exact_part
from core.experiments.measurement.key_points import key_points_part
from core.experiments.measurement.pictures import coverage_picture
from core.experiments.measurement.settings import MeasurementSettings
from core.experiments.physics.part import Part, Progress
from core.experiments.results import Results
from core.experiments.study import Study
from core.hull.surface import EMPTY_SURFACE

PARTS = ("exact", "echoes", "coverage", "key-points")
"""Names of the parts, in the order in which they run."""


def run_measurement(
    *,
    parts: tuple[str, ...] = PARTS,
    settings: MeasurementSettings | None = None,
    progress: Progress = lambda _stage, _done, _total: None,
) -> Study:
    """Measure known targets, count how often intervals hold, and place key points.

    Parts carve hulls of their own; none of them is what the whole is about.

    Args:
        parts: names out of `PARTS`.
        settings: how much is simulated.
        progress: told of stage, steps done and steps in all.

    Raises:
        ValueError: an unknown part or target.
    """
    unknown = [name for name in parts if name not in PARTS]
    if unknown:
        raise ValueError(
            f'There is no part "{unknown[0]}" of the measurement; take {", ".join(PARTS)}.'
        )
    settings = settings or MeasurementSettings()
    found = [_RUNS[name](settings, progress) for name in parts]
    results = Results(
        name="measurement",
        settings={"parts": list(parts)} | _plain(settings),
        figures=tuple(figure for part in found for figure in part.figures),
    )
    pictures = tuple(picture for part in found for picture in part.pictures)
    return Study(results=results, pictures=pictures, hull=EMPTY_SURFACE)


def _plain(settings: MeasurementSettings) -> dict[str, object]:
    values = asdict(settings).items()
    return {name: list(value) if isinstance(value, tuple) else value for name, value in values}


def _coverage_part(settings: MeasurementSettings, progress: Progress) -> Part:
    sets = min(4, settings.draws)
    results = interval_coverage(
        draws=settings.draws,
        view_sets=sets,
        seed=settings.seed,
        progress=partial(_named, progress, "intervals"),
    )
    return Part(figures=results.figures, pictures=(coverage_picture(results.figures),))


def _named(progress: Progress, title: str, stage: str, done: int, total: int) -> None:
    progress(f"{title}: {stage}", done, total)


_RUNS: Mapping[str, Callable[[MeasurementSettings, Progress], Part]] = {
    "exact": exact_part,
    "echoes": echoes_part,
    "coverage": _coverage_part,
    "key-points": key_points_part,
}
