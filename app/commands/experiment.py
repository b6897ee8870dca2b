"""`radarhull experiment`."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, Literal

import tyro

from app.commands.console import progress_bars
from app.commands.options import (
    JsonTo,
    OptionalFloat,
    OptionalFolder,
    OptionalInt,
    checked_seed,
    checked_snr_db,
)
from app.commands.outputs import (
    STANDARD_OUTPUT,
    checked_folder,
    checked_json,
    show_results,
    write_json,
)
from core.experiments.factorization import run_factorization
from core.experiments.fusion import run_fusion
from core.experiments.human import run_human
from core.experiments.limited import run_limited
from core.experiments.measurement.run import PARTS as MEASUREMENT_PARTS
from core.experiments.measurement.run import run_measurement
from core.experiments.physics.run import PARTS, run_physics
from core.experiments.pictures import Picture, write_pictures
from core.experiments.report import write_report
from core.experiments.results import Results
from core.experiments.study import Study
from core.experiments.temple import run_temple
from core.experiments.wide import run_wide
from core.formats.surfaces import write_surface

Experiment = Literal[
    "wide", "limited", "fusion", "factorization", "human", "temple", "physics", "measurement"
]

STUDIES: Mapping[str, Callable[..., Study]] = {
    "limited": run_limited,
    "fusion": run_fusion,
    "factorization": run_factorization,
    "human": run_human,
}
"""Experiments that hand out pictures and a hull too; they take a spacing, noise and a seed."""


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
    lengths, by the shadow rule and by the paper's strict rule. limited: the same target from one
    pass over Beijing, radar alone, and which directions stay unobserved. fusion: that pass with a
    telescope beside the radar. factorization: three lines of an MRO-like orbiter by factorization,
    by energy accumulation and by our hull. human: a person with a knife from near-field echoes all
    around, bare and under a cover. temple: the hull of a real object from 16 calibrated
    photographs (Middlebury templeSparseRing). physics: scattering, coherent intervals, imaging,
    focusing, registration and optics against theory and measured data. measurement: lengths and
    attitude of two known targets from exact outlines and from echoes, how often intervals hold the
    truth, and key points against noise (some five minutes).

    Args:
        name: which experiment.
        json: write settings and figures as JSON to this file, or to standard output for "-".
        data: folder of the photographs (temple), or of the measured Gotcha history (physics).
        out: folder to write results.json, report.html, hull.glb and the pictures into (not wide,
            not temple; physics and measurement have no hull).
        part: parts of the physics or the measurement to run, all by default.
        views: number of views (wide only; 80 by default).
        spacing_m: voxel spacing in metres; 0.15, or 0.2 (factorization), 0.01 (human) or 0.0005
            (temple) by default.
        snr_db: signal-to-noise ratio per pulse and frequency sample (not temple, not physics; 20 dB
            by default).
        seed: of the random generator (not temple, not physics; 1 by default).
    """
    checked_json(json)
    if name in ("physics", "measurement"):
        _refuse_foreign(name, {"--views": views, "--spacing-m": spacing_m, "--snr-db": snr_db})
        _refuse_foreign(name, {"--seed": seed})
        if name == "measurement":
            _refuse_foreign(name, {"--data": data})
        _pictured(name, part, data, out, json)
        return
    _refuse_foreign(name, {"--part": part or None})
    chosen = {
        "spacing_m": spacing_m,
        "signal_to_noise_db": None if snr_db is None else checked_snr_db(snr_db),
        "seed": None if seed is None else checked_seed(seed),
    }
    if name in STUDIES:
        _refuse_foreign(name, {"--views": views, "--data": data})
        _study(STUDIES[name], chosen, out, json)
        return
    _refuse_foreign(name, {"--out": out})
    if name == "wide":
        _refuse_foreign(name, {"--data": data})
        with progress_bars() as report:
            results = run_wide(**_given({**chosen, "views": views}), progress=report)
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


def _given(settings: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in settings.items() if value is not None}


def _study(
    run: Callable[..., Study], settings: Mapping[str, Any], out: Path | None, json: str | None
) -> None:
    if out is not None:
        checked_folder(out)
    with progress_bars() as report:
        study = run(**_given(settings), progress=report)
    if out is not None:
        _write(out, study.results, study.pictures)
        if not study.hull.is_empty:
            write_surface(out / "hull.glb", study.hull)
    show_results(study.results, json)
    if json != STANDARD_OUTPUT:
        print(study.results.finding)


def _write(out: Path, results: Results, pictures: Sequence[Picture]) -> None:
    write_pictures(pictures, out)
    write_report(out / "report.html", results, pictures)
    write_json(str(out / "results.json"), results.to_json())


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
        _write(out, results, pictures)
    show_results(results, json)


def _refuse_foreign(name: Experiment, options: Mapping[str, object]) -> None:
    given = [option for option, value in options.items() if value is not None]
    if given:
        raise ValueError(f"The {name} experiment has no use for {', '.join(given)}; leave it out.")
