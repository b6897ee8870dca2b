"""`radarhull bench image`: from echoes to frames."""

import time
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from core.benchmarks.gridding import numpy_polar_format
from core.benchmarks.measuring import Progress, machine, measured, median_s
from core.experiments.demo import DEMO_PASSES, FRAMES_PER_PASS, demo_echoes
from core.experiments.results import Figure, Results
from core.frame import Frame
from core.parallel import in_order
from core.radar.aperture import aperture_of
from core.radar.backprojection import backproject
from core.radar.imaging import ImagingSettings, Method, interval_frame, interval_projection
from core.radar.intervals import CoherentInterval
from core.radar.phase_history import PhaseHistory

Echoes = tuple[PhaseHistory, CoherentInterval]

WANTED = "<= 6 s"
SCATTERERS = 1000
"""Of the target; imaging takes no notice of how many."""
COMPARED_EVERY = 10
"""Frames apart that slow rivals image."""
ROWS_EVERY = 16
"""Rows apart that back-projection images; its time grows with the pixels."""


def run_image(
    *,
    repeats: int = 3,
    echoes: Sequence[Echoes] | None = None,
    settings: ImagingSettings | None = None,
    seed: int = 1,
    progress: Progress = lambda _stage, _done, _total: None,
) -> Results:
    """Time the demo's frames from their echoes on, by every method and by plain NumPy.

    Args:
        repeats: runs; the median counts.
        echoes: with their intervals; None for the demo's.
        settings: of the images.
        seed: of the echoes.
        progress: told of stage, steps done and steps in all.
    """
    before = machine()
    settings = settings or ImagingSettings()
    is_demo = echoes is None
    echoes = echoes or _demo(seed, progress)
    figures = _all_frames(echoes, settings, repeats, WANTED if is_demo else None, progress)
    figures += _rivals(echoes[::COMPARED_EVERY], settings, repeats, progress)
    return Results(
        name="image",
        settings={
            "frames": len(echoes),
            "pulses": sum(len(history.track) for history, _ in echoes),
            "shape": list(settings.shape),
            "repeats": repeats,
            "seed": seed,
            "rivals": f"every {COMPARED_EVERY}th frame; back-projection of every {ROWS_EVERY}th "
            "row, what the time grows by per row taken for all rows",
            "threads": before["threads"],
            "load_average": before["load_average"],
            "load_average_at_end": machine()["load_average"],
        },
        figures=tuple(figures),
    )


def _demo(seed: int, progress: Progress) -> list[Echoes]:
    echoes: list[Echoes] = []
    for history, interval, _ in demo_echoes(seed=seed, scatterers=SCATTERERS):
        echoes.append((history, interval))
        progress("simulating echoes", len(echoes), len(DEMO_PASSES) * FRAMES_PER_PASS)
    return echoes


def _all_frames(
    echoes: Sequence[Echoes],
    settings: ImagingSettings,
    repeats: int,
    wanted: str | None,
    progress: Progress,
) -> list[Figure]:
    seconds, busy_s = [], []
    for done in range(1, repeats + 1):
        began_s = time.process_time()
        seconds.append(measured(lambda: _imaged(echoes, settings)).seconds)
        busy_s.append(time.process_time() - began_s)
        progress("polar format", done, repeats)
    wall_s = median_s(seconds)
    name = f"{len(echoes)} frames from their echoes"
    return [
        Figure(name=name, value=wall_s, unit="s", wanted=wanted),
        Figure(name=f"{name}, processor time", value=median_s(busy_s), unit="s"),
        Figure(name=f"{name}, per second", value=len(echoes) / wall_s, unit="frames/s"),
    ]


def _imaged(echoes: Sequence[Echoes], settings: ImagingSettings) -> list[Frame]:
    def frame(work: Echoes) -> Frame:
        return interval_frame(*work, settings)

    return list(in_order(frame, echoes))


def _rivals(
    echoes: Sequence[Echoes], settings: ImagingSettings, repeats: int, progress: Progress
) -> list[Figure]:
    """Return how many times faster polar format is than the other ways, all on the same frames."""

    def by(method: Method) -> Callable[[], object]:
        return lambda: _imaged(echoes, replace(settings, method=method))

    ours_s = _median(by("polar"), repeats)
    ways: dict[str, Callable[[], float]] = {
        "keystone": lambda: _median(by("keystone"), repeats),
        "plain range-Doppler": lambda: _median(by("range-doppler"), repeats),
        "plain NumPy of the same algorithm": lambda: _median(
            lambda: _by_numpy(echoes, settings), repeats
        ),
        "back-projection": lambda: _back_projection_s(echoes, settings),
    }
    figures = []
    for done, (name, seconds) in enumerate(ways.items(), start=1):
        rival_s = seconds()
        figures += [
            Figure(name=f"{name}, per second", value=len(echoes) / rival_s, unit="frames/s"),
            Figure(name=f"polar format, times faster than {name}", value=rival_s / ours_s),
        ]
        progress("rivals", done, len(ways))
    return [*figures, *_agreement(echoes[:1], settings)]


def _median(work: Callable[[], object], repeats: int) -> float:
    return median_s([measured(work).seconds for _ in range(repeats)])


def _by_numpy(echoes: Sequence[Echoes], settings: ImagingSettings) -> list[NDArray[np.float64]]:
    """Return the same images by plain NumPy, spread over threads like ours."""

    def image(work: Echoes) -> NDArray[np.float64]:
        aperture = aperture_of(*work, interval_projection(*work, settings), settings.window)
        return np.abs(numpy_polar_format(aperture, settings.shape, settings.spacing_m))

    return list(in_order(image, echoes))


def _back_projection_s(echoes: Sequence[Echoes], settings: ImagingSettings) -> float:
    """Return how long back-projection would take over the same images.

    Range profiles take their time whatever the number of rows, and rows all the same.
    """
    rows = settings.shape[0]
    few, many = np.arange(1), np.arange(0, rows, ROWS_EVERY)
    _back_projected(echoes[:1], settings, few)  # compiles

    def seconds(which: NDArray[np.int64]) -> float:
        return measured(lambda: _back_projected(echoes, settings, which)).seconds

    few_s, many_s = seconds(few), seconds(many)
    return many_s + (rows - len(many)) * max(many_s - few_s, 0.0) / (len(many) - 1)


def _back_projected(
    echoes: Sequence[Echoes], settings: ImagingSettings, rows: NDArray[np.int64]
) -> list[NDArray[np.complex64]]:
    """Return some rows of the same images by back-projection, which has its own threads."""
    places = np.stack(np.meshgrid(rows, np.arange(settings.shape[1]), indexing="ij"), axis=-1)
    images = []
    for history, interval in echoes:
        points_m = interval_projection(history, interval, settings).plane_points(
            places.astype(float)
        )
        images.append(backproject(history, points_m, window=settings.window))
    return images


def _agreement(echoes: Sequence[Echoes], settings: ImagingSettings) -> list[Figure]:
    """Return how far the rivals' images differ from ours, as a share of the brightest pixel."""
    (frame,) = _imaged(echoes, settings)
    peak = float(frame.amplitude.max())
    by_numpy = _by_numpy(echoes, settings)[0] - frame.amplitude
    rows = np.arange(0, settings.shape[0], ROWS_EVERY)
    projected = np.abs(_back_projected(echoes, settings, rows)[0]) - frame.amplitude[rows]
    return [
        Figure(
            name=f"polar format differs from {name} by up to, of the peak",
            value=100 * float(np.abs(difference).max()) / peak,
            unit="%",
            wanted=wanted,
        )
        for name, difference, wanted in (
            ("plain NumPy", by_numpy, "<= 0.1 %"),
            ("back-projection", projected, "<= 2 %"),
        )
    ]
