"""`radarhull experiment`."""

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

import tyro

from app.commands.console import Report, progress_bars
from app.commands.options import (
    JsonTo,
    OptionalFloat,
    OptionalFolder,
    OptionalInt,
    checked_seed,
    checked_snr_db,
)
from app.commands.outputs import checked_folder, checked_json, show_results, write_json
from core.experiments.measurement.run import PARTS as MEASUREMENT_PARTS
from core.experiments.measurement.run import run_measurement
from core.experiments.physics.run import PARTS, run_physics
from core.experiments.pictures import write_pictures
from core.experiments.report import write_report
from core.experiments.results import Results
from core.experiments.temple import run_temple
from core.experiments.wide import run_wide

Experiment = Literal["wide", "temple", "physics", "measurement"]


def experiment(
    name: Annotated[Experiment, tyro.conf.Positional],
    /,
    *,
    json: JsonTo = None,
    data: OptionalFolder = None,
    out: OptionalFolder = None,
    part: Annotated[tuple[str, ...], tyro.conf.arg(metavar="PART", help_behavior_hint="")] = (),
    views: OptionalInt = None,
    spacing_m: OptionalFloat = None,
    snr_db: OptionalFloat = None,
    seed: OptionalInt = None,
) -> None:
    """Run an experiment and print its table.

    wide: a Tiangong-like target under views over the whole sphere, from simulated echoes to
    lengths, by the shadow rule and by the paper's strict rule. temple: the hull of a real object
    from 16 calibrated photographs (Middlebury templeSparseRing). physics: scattering, coherent
    intervals, imaging, focusing, registration and optics against theory and measured data.
    measurement: lengths and attitude of two known targets from exact outlines and from echoes, how
    often intervals hold the truth, and key points against noise (some five minutes).

    Args:
        name: which experiment.
        json: write settings and figures as JSON to this file, or to standard output for "-".
        data: folder of the photographs (temple), or of the measured Gotcha history (physics).
        out: folder to write results.json, report.html and the pictures into (physics and
            measurement).
        part: parts of the physics or the measurement to run, all by default.
        views: number of views (wide only; 80 by default).
        spacing_m: voxel spacing in metres; 0.15 (wide) or 0.0005 (temple) by default.
        snr_db: signal-to-noise ratio per pulse and frequency sample (wide only; 20 dB by default).
        seed: of the random generator (wide only; 1 by default).
    """
    checked_json(json)
    if name in ("physics", "measurement"):
        _refuse_foreign(name, {"--views": views, "--spacing-m": spacing_m, "--snr-db": snr_db})
        _refuse_foreign(name, {"--seed": seed})
        if name == "measurement":
            _refuse_foreign(name, {"--data": data})
        _pictured(name, part, data, out, json)
        return
    _refuse_foreign(name, {"--out": out, "--part": part or None})
    if name == "wide":
        _refuse_foreign(name, {"--data": data})
        settings = {
            "views": views,
            "spacing_m": spacing_m,
            "signal_to_noise_db": None if snr_db is None else checked_snr_db(snr_db),
            "seed": None if seed is None else checked_seed(seed),
        }
        with progress_bars() as report:
            results = _wide(settings, report)
    else:
        _refuse_foreign(name, {"--views": views, "--snr-db": snr_db, "--seed": seed})
        if data is None:
            raise ValueError(
                "The temple experiment needs its photographs: --data FOLDER with "
                "templeSR_par.txt and the PNG files of Middlebury's templeSparseRing."
            )
        with progress_bars() as report:
            results = run_temple(data, spacing_m=spacing_m, progress=report)
    show_results(results, json)


def _wide(settings: Mapping[str, Any], report: Report) -> Results:
    chosen = {name: value for name, value in settings.items() if value is not None}
    return run_wide(**chosen, progress=report)


def _pictured(
    name: Experiment,
    parts: tuple[str, ...],
    gotcha: Path | None,
    out: Path | None,
    json: str | None,
) -> None:
    if out is not None:
        checked_folder(out)
    with progress_bars() as report:
        if name == "measurement":
            results, pictures = run_measurement(parts=parts or MEASUREMENT_PARTS, progress=report)
        else:
            results, pictures = run_physics(parts=parts or PARTS, gotcha=gotcha, progress=report)
    if out is not None:
        write_pictures(pictures, out)
        write_report(out / "report.html", results, pictures)
        write_json(str(out / "results.json"), results.to_json())
    show_results(results, json)


def _refuse_foreign(name: Experiment, options: Mapping[str, object]) -> None:
    given = [option for option, value in options.items() if value is not None]
    if given:
        raise ValueError(f"The {name} experiment has no use for {', '.join(given)}; leave it out.")
