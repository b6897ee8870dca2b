"""`radarhull experiment`."""

from pathlib import Path
from typing import Annotated, Literal

import tyro

from app.commands.console import progress_bars, show_results
from core.experiments.temple import run_temple
from core.experiments.wide import run_wide


def experiment(
    name: Annotated[Literal["wide", "temple"], tyro.conf.Positional],
    /,
    *,
    json: str | None = None,
    data: Path | None = None,
    views: int = 80,
    spacing_m: float | None = None,
    snr_db: float = 20.0,
    seed: int = 1,
) -> None:
    """Run an experiment and print its table.

    wide: a Tiangong-like target under views over the whole sphere, from simulated echoes to
    lengths, by the shadow rule and by the paper's strict rule. temple: the hull of a real object
    from 16 calibrated photographs (Middlebury templeSparseRing).

    Args:
        name: which experiment.
        json: write settings and figures as JSON to this file, or to standard output for "-".
        data: folder of the photographs (temple).
        views: number of views (wide).
        spacing_m: voxel spacing in metres; the experiment's own by default.
        snr_db: signal-to-noise ratio per pulse and frequency sample, decibels (wide).
        seed: of the random generator (wide).
    """
    with progress_bars() as report:
        if name == "wide":
            results = run_wide(
                views=views,
                spacing_m=0.15 if spacing_m is None else spacing_m,
                signal_to_noise_db=snr_db,
                seed=seed,
                progress=report,
            )
        else:
            if data is None:
                raise ValueError(
                    "The temple experiment needs its photographs: --data FOLDER with "
                    "templeSR_par.txt and the PNG files of Middlebury's templeSparseRing."
                )
            results = run_temple(data, spacing_m=spacing_m, progress=report)
    show_results(results, json)
