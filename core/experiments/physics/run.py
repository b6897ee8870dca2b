"""`radarhull experiment physics`: every part, one after another."""

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path

from core.experiments.physics.focusing import focusing_part
from core.experiments.physics.imaging import imaging_part
from core.experiments.physics.intervals import intervals_part
from core.experiments.physics.near_field import near_field_part
from core.experiments.physics.optics import optics_part
from core.experiments.physics.part import Part, Progress
from core.experiments.physics.registration import registration_part
from core.experiments.physics.scattering import scattering_part
from core.experiments.results import Results
from core.experiments.study import Study
from core.hull.surface import EMPTY_SURFACE

PARTS = ("scattering", "intervals", "imaging", "focusing", "near-field", "registration", "optics")
"""Names of the parts, in the order in which an echo meets them."""


def run_physics(
    *,
    parts: tuple[str, ...] = PARTS,
    data: Path | None = None,
    progress: Progress = lambda _stage, _done, _total: None,
) -> Study:
    """Hold each part of the physics against theory and data; there is no hull.

    Args:
        parts: names out of `PARTS`.
        data: folder of the measured Gotcha history; without it nothing measured is focused.
        progress: told of stage, steps done and steps in all.

    Raises:
        ValueError: an unknown part.
    """
    unknown = [name for name in parts if name not in PARTS]
    if unknown:
        raise ValueError(
            f'There is no part "{unknown[0]}" of the physics; take {", ".join(PARTS)}.'
        )
    runs = _runs(data)
    found = [runs[name](partial(_within, progress, name)) for name in parts]
    results = Results(
        name="physics",
        settings={"parts": list(parts), "measured data": "none" if data is None else "Gotcha"},
        figures=tuple(figure for part in found for figure in part.figures),
    )
    pictures = tuple(picture for part in found for picture in part.pictures)
    return Study(results=results, pictures=pictures, hull=EMPTY_SURFACE)


def _runs(gotcha: Path | None) -> Mapping[str, Callable[[Progress], Part]]:
    return {
        "scattering": scattering_part,
        "intervals": intervals_part,
        "imaging": imaging_part,
        "focusing": partial(focusing_part, gotcha=gotcha),
        "near-field": near_field_part,
        "registration": registration_part,
        "optics": optics_part,
    }


def _within(progress: Progress, part: str, stage: str, done: int, total: int) -> None:
    """Report a part's stage under both names."""
    progress(stage if stage.startswith(part) else f"{part}: {stage}", done, total)
