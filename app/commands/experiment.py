"""`radarhull experiment`."""

import inspect
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, Literal

import tyro

from app.commands.all_experiments import run_all
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
    checked_folder,
    checked_json,
    show_results,
    write_study,
)
from core.experiments.factorization import run_factorization
from core.experiments.fusion import run_fusion
from core.experiments.human import run_human
from core.experiments.limited import run_limited
from core.experiments.measurement.run import run_measurement
from core.experiments.noise import run_noise
from core.experiments.passes import run_passes
from core.experiments.physics.run import run_physics
from core.experiments.shadow import run_shadow
from core.experiments.spin import run_spin
from core.experiments.study import Study
from core.experiments.temple import run_temple
from core.experiments.threshold.run import run_threshold
from core.experiments.wide import run_wide

Experiment = Literal[
    "wide",
    "limited",
    "fusion",
    "factorization",
    "shadow",
    "spin",
    "threshold",
    "passes",
    "human",
    "noise",
    "temple",
    "physics",
    "measurement",
    "all",
]

STUDIES: Mapping[str, Callable[..., Study]] = {
    "wide": run_wide,
    "limited": run_limited,
    "fusion": run_fusion,
    "factorization": run_factorization,
    "shadow": run_shadow,
    "spin": run_spin,
    "threshold": run_threshold,
    "passes": run_passes,
    "human": run_human,
    "noise": run_noise,
    "temple": run_temple,
    "physics": run_physics,
    "measurement": run_measurement,
}
"""Every experiment. What a function's signature names (see `_PARAMETERS`) is an option of its
experiment, and one without a default must be given."""

NEEDED_DATA: Mapping[str, str] = {
    "temple": "templeSR_par.txt and the PNG files of Middlebury's templeSparseRing"
}
"""What --data must hold for an experiment that cannot run without it."""

_PARAMETERS = {
    "--part": "parts",
    "--views": "views",
    "--spacing-m": "spacing_m",
    "--snr-db": "signal_to_noise_db",
    "--seed": "seed",
    "--data": "data",
}
"""Which parameter of an experiment's function each option sets."""


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
    by energy accumulation and by our hull. shadow: rules of voting on targets that shadow
    themselves. spin: axis and rate of a spinning target seen by several stations, and its hull.
    threshold: silhouettes wrong in some frames, and what repairs the hull. passes: how the hull
    falls with passes and stations, and the best next pass, predicted and then confirmed. noise:
    accuracy against noise, resolution and number of frames, one at a time. temple: the hull of a
    real object from 16 calibrated photographs (Middlebury templeSparseRing). physics: scattering,
    coherent intervals, imaging, focusing, registration and optics against theory and measured data.
    measurement: lengths and attitude of two known targets from exact outlines and from echoes, how
    often intervals hold the truth, and key points against noise (some five minutes). all: every one
    of these in turn with its own settings, each into its own folder of --out, with a page
    index.html that tells what each found and links its report, and one results.json; one that fails
    does not stop the others, and the exit code is then 1.

    Args:
        name: which experiment.
        json: write settings and figures as JSON to this file, or to standard output for "-".
        data: folder of the photographs (temple; all, which skips the temple without it), or of the
            measured Gotcha history (physics).
        out: folder to write results.json, report.html, hull.glb and the pictures into (physics and
            measurement have no hull); all needs it.
        part: parts of the physics or the measurement to run, all by default.
        views: number of views (wide, factorization and noise only; 80 by default).
        spacing_m: voxel spacing in metres; 0.15, or 0.2 (factorization) or 0.0005 (temple) by
            default.
        snr_db: signal-to-noise ratio per pulse and frequency sample (not temple, not physics, not
            measurement; 20 dB by default).
        seed: of the random generator (not temple, not physics, not measurement; 1 by default).
    """
    checked_json(json)
    options = {
        "--part": part or None,
        "--views": views,
        "--spacing-m": spacing_m,
        "--snr-db": None if snr_db is None else checked_snr_db(snr_db),
        "--seed": None if seed is None else checked_seed(seed),
        "--data": data,
    }
    if name == "all":
        _all(options, out, json)
        return
    run = STUDIES[name]
    settings = _settings(name, run, options)
    if out is not None:
        checked_folder(out)
    with progress_bars() as report:
        study = run(**settings, progress=report)
    if out is not None:
        write_study(out, study)
    show_results(study.results, json)


def _all(options: Mapping[str, object], out: Path | None, json: str | None) -> None:
    foreign = [
        option for option, value in options.items() if value is not None and option != "--data"
    ]
    _refuse("all", foreign)
    if out is None:
        raise ValueError(
            "All experiments write a folder each and a page that lists them: --out FOLDER."
        )
    data = options["--data"]
    run_all(STUDIES, NEEDED_DATA, data if isinstance(data, Path) else None, out, json)


def _refuse(name: str, foreign: Sequence[str]) -> None:
    if foreign:
        raise ValueError(
            f"The {name} experiment has no use for {', '.join(foreign)}; leave it out."
        )


def _settings(
    name: str, run: Callable[..., Study], options: Mapping[str, object]
) -> dict[str, Any]:
    """Return the options that were given as an experiment's arguments.

    Raises:
        ValueError: it has no use for one, or cannot do without one.
    """
    given = {option: value for option, value in options.items() if value is not None}
    taken = inspect.signature(run).parameters
    foreign = [option for option in given if _PARAMETERS[option] not in taken]
    _refuse(name, foreign)
    if name in NEEDED_DATA and "--data" not in given:
        raise ValueError(
            f"The {name} experiment needs its data: --data FOLDER with {NEEDED_DATA[name]}."
        )
    return {_PARAMETERS[option]: value for option, value in given.items()}
