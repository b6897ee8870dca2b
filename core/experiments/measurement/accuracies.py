"""Lengths and attitude off hulls of exact outlines, and off hulls of simulated echoes."""

from collections.abc import Sequence

import numpy as np

from core.experiments.exact_features import accuracy, carved, exact_views
from core.experiments.measurement.pictures import Measured, errors_picture, hull_picture
from core.experiments.measurement.settings import Case, MeasurementSettings, case_named
from core.experiments.physics.part import Part, Progress
from core.experiments.results import Figure
from core.experiments.wide import simulated_frames
from core.hull.closed_mesh import Surface
from core.hull.shadow import carving_view
from core.hull.view import View
from core.measurement.measuring import measure_all
from core.parallel import in_order
from core.silhouettes.extraction import extract_silhouette

ECHO_LENGTH_WANTED = "<= 2 %"
"""As for span and length in the wide experiment; no attitude was promised from echoes."""

ECHO_MARGIN_M = 3.0
"""By how much the grid reaches beyond the target, so that it cuts nothing off the hull."""


def exact_part(settings: MeasurementSettings, progress: Progress) -> Part:
    """Measure each target on the hulls of exact outlines, for every seed of their directions.

    Args:
        settings: targets, views, seeds and voxels.
        progress: told of stage, steps done and steps in all.
    """
    works = [(case_named(name), seed) for name in settings.targets for seed in settings.exact_seeds]

    def hull(work: tuple[Case, int]) -> Surface:
        case, seed = work
        views = exact_views(case.target, views=settings.exact_views, seed=seed)
        return carved(case.target, views, spacing_m=settings.spacing_m)

    figures: list[Figure] = []
    for (case, seed), surface in zip(works, in_order(hull, works), strict=True):
        figures += accuracy(f"exact outlines, {case.name}, seed {seed}", case.features, surface)
        progress("hulls of exact outlines", len(figures), len(figures) + 1)
    progress("hulls of exact outlines", len(figures) + 1, len(figures) + 1)
    caption = (
        f"Errors on hulls of {settings.exact_views} exact outlines at {settings.spacing_m:g} m "
        "voxels, one dot for each set of directions. Dashed: what is wanted."
    )
    return Part(
        figures=tuple(figures),
        pictures=(errors_picture("exact-accuracy", caption, figures, (0.25, 0.1)),),
    )


def echoes_part(settings: MeasurementSettings, progress: Progress) -> Part:
    """Measure each target on the hull of outlines that were found in images of its echoes.

    Args:
        settings: targets, views, scatterers, noise and voxels.
        progress: told of stage, steps done and steps in all.
    """
    figures: list[Figure] = []
    shown: list[Measured] = []
    for name in settings.targets:
        case = case_named(name)
        surface = _echo_hull(case, settings, progress)
        figures += accuracy(
            f"from echoes, {name}",
            case.features,
            surface,
            length_wanted=ECHO_LENGTH_WANTED,
            attitude_wanted=None,
        )
        results = measure_all([feature.spec for feature in case.features], surface)
        shown.append(Measured(case=case, surface=surface, results=results))
    caption = (
        f"Hulls of {settings.echo_views} coherent intervals from random directions, imaged from "
        f"echoes at {settings.signal_to_noise_db:g} dB, in the target frame. Grey: the hull's "
        "vertices; orange: the lines as measured; blue: the true ones."
    )
    errors = "Errors on hulls from echoes. Dashed: what is wanted of lengths."
    return Part(
        figures=tuple(figures),
        pictures=(
            errors_picture("echo-accuracy", errors, figures, (2.0, None)),
            hull_picture("echo-hulls", caption, shown),
        ),
    )


def _echo_hull(case: Case, settings: MeasurementSettings, progress: Progress) -> Surface:
    frames = simulated_frames(
        case.target,
        views=settings.echo_views,
        scatterers=settings.scatterers,
        signal_to_noise_db=settings.signal_to_noise_db,
        random=np.random.default_rng(settings.seed),
        waveform=case.waveform,
        imaging=case.imaging,
        pulses_per_view=case.pulses_per_view,
        progress=lambda stage, done, total: progress(f"{stage}, {case.name}", done, total),
    )
    views: Sequence[View] = list(
        in_order(
            lambda frame: carving_view(
                View(silhouette=extract_silhouette(frame), projection=frame.projection), "shadow"
            ),
            frames,
        )
    )
    return carved(case.target, views, spacing_m=settings.spacing_m, margin_m=ECHO_MARGIN_M)
