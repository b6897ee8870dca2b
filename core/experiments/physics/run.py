"""`radarhull experiment physics`: every part, one after another."""

from collections.abc import Callable, Mapping
from functools import partial

from core.experiments.physics.imaging import imaging_part
from core.experiments.physics.intervals import intervals_part
from core.experiments.physics.optics import optics_part
from core.experiments.physics.part import Part, Progress
from core.experiments.physics.scattering import scattering_part
from core.experiments.pictures import Picture
from core.experiments.results import Results

PARTS: Mapping[str, Callable[[Progress], Part]] = {
    "scattering": scattering_part,
    "intervals": intervals_part,
    "imaging": imaging_part,
    "optics": optics_part,
}


def run_physics(
    *,
    parts: tuple[str, ...] = tuple(PARTS),
    progress: Progress = lambda _stage, _done, _total: None,
) -> tuple[Results, tuple[Picture, ...]]:
    """Hold each part of the physics against theory and data, and return figures and pictures.

    Args:
        parts: names out of `PARTS`.
        progress: told of stage, steps done and steps in all.

    Raises:
        ValueError: an unknown part.
    """
    unknown = [name for name in parts if name not in PARTS]
    if unknown:
        raise ValueError(
            f'There is no part "{unknown[0]}" of the physics; take {", ".join(PARTS)}.'
        )
    found = [PARTS[name](partial(_within, progress, name)) for name in parts]
    results = Results(
        name="physics",
        settings={"parts": list(parts)},
        figures=tuple(figure for part in found for figure in part.figures),
    )
    return results, tuple(picture for part in found for picture in part.pictures)


def _within(progress: Progress, part: str, stage: str, done: int, total: int) -> None:
    """Report a part's stage under both names."""
    progress(stage if stage.startswith(part) else f"{part}: {stage}", done, total)
