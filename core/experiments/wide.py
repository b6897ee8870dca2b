"""The paper's experiment A: a Tiangong-like target under views from all around."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.experiments.frame_pictures import OutlinedFrame, frames_picture
from core.experiments.hull_pictures import error_pictures, sides_picture
from core.experiments.pictures import Picture
from core.experiments.results import Figure, Results, Table
from core.experiments.study import Progress, Study
from core.frame import Frame
from core.geometry.grid import VoxelGrid
from core.geometry.track import random_views_track
from core.hull.shadow import CarvingRule, carving_view
from core.hull.surface import Surface, hull_surface
from core.hull.view import View
from core.hull.votes import VoteCounts
from core.measurement.comparison import Agreement, voxel_agreement
from core.measurement.lines import LineMeasurement, angle_between_lines_rad, principal_lines
from core.parallel import in_order
from core.radar.echoes import simulate_echoes
from core.radar.imaging import ImagingSettings, frames
from core.radar.scatterers import Scatterers, surface_scatterers
from core.radar.tracking_error import displaced
from core.radar.waveform import Waveform
from core.silhouettes.extraction import extract_silhouette
from core.targets import LineFeature, Target, tiangong_like

WANTED = {
    "IoU, shadow rule": ">= 0.75",
    "span error, shadow rule": "<= 2 %",
    "length error, shadow rule": "<= 2 %",
    "diameter error, shadow rule": "<= 8 %",
}


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Carved:
    """A hull, how it agrees with the truth, and its lines beside the target's features."""

    agreement: Agreement
    surface: Surface
    lines: tuple[tuple[LineFeature, LineMeasurement | None], ...]


def run_wide(
    *,
    views: int = 80,
    spacing_m: float = 0.15,
    scatterers: int = 60_000,
    signal_to_noise_db: float = 20.0,
    seed: int = 1,
    progress: Progress = lambda _stage, _done, _total: None,
) -> Study:
    """Simulate echoes, image them, extract silhouettes, carve by both rules, compare with truth.

    The truth enters only the last step; silhouettes come from the simulated echoes alone.

    Args:
        views: random directions over the sphere, one coherent interval each.
        spacing_m: voxel spacing.
        scatterers: points on the target's surface.
        signal_to_noise_db: as in `simulate_echoes`.
        seed: of the random generator.
        progress: told of stage, steps done and steps in all.

    Raises:
        ValueError: fewer than two views, or parameters a stage refuses.
    """
    if views < 2:
        raise ValueError(f"A hull needs at least 2 views, got {views}.")
    target = tiangong_like()
    images = simulated_frames(
        target,
        views=views,
        scatterers=scatterers,
        signal_to_noise_db=signal_to_noise_db,
        random=np.random.default_rng(seed),
        progress=progress,
    )
    found = []
    for number, frame in enumerate(images, start=1):
        found.append(OutlinedFrame(frame=frame, silhouette=extract_silhouette(frame)))
        progress("silhouettes", number, len(images))
    grid = VoxelGrid.cube(side_m=21.0, spacing_m=spacing_m)
    truth = target.voxels(grid)
    rules: tuple[CarvingRule, ...] = ("shadow", "strict")
    hulls = {rule: _carved(found, grid, truth, rule, target, progress) for rule in rules}
    results = Results(
        name="wide",
        settings={
            "target": target.name,
            "views": views,
            "spacing_m": spacing_m,
            "scatterers": scatterers,
            "signal_to_noise_db": signal_to_noise_db,
            "seed": seed,
        },
        figures=tuple(each for rule, hull in hulls.items() for each in _figures(rule, hull)),
        tables=(_table(hulls),),
        finding=_finding(hulls["shadow"], hulls["strict"]),
    )
    ours = hulls["shadow"].surface
    return Study(results=results, pictures=_pictures(found, ours, target), hull=ours)


def simulated_frames(
    target: Target,
    *,
    views: int,
    scatterers: int,
    signal_to_noise_db: float,
    random: np.random.Generator,
    tracking_error_m: Floats | None = None,
    waveform: Waveform | None = None,
    imaging: ImagingSettings | None = None,
    pulses_per_view: int = 256,
    visible: float = 1.0,
    progress: Progress = lambda _stage, _done, _total: None,
) -> list[Frame]:
    """Return radar frames of a target from random directions, imaged from simulated echoes.

    Args:
        target: what is seen.
        views: number of frames.
        scatterers: points on the surface.
        signal_to_noise_db: as in `simulate_echoes`.
        random: for directions, scatterers and noise.
        tracking_error_m: (views, 2) how far in range and cross-range every view's echoes are off
            what its projection says.
        waveform: with samples enough for the target's size; the usual one unless given.
        imaging: with images large enough for it; the usual unless given.
        pulses_per_view: enough for its size across the line of sight.
        visible: probability that a scatterer is seen in a frame, each frame on its own.
        progress: told of stage, steps done and steps in all.
    """
    waveform, imaging = waveform or Waveform(), imaging or ImagingSettings()
    points = surface_scatterers(target, count=scatterers, random=random)
    track = random_views_track(
        views=views,
        turn_rad=waveform.wavelength_m / (2 * imaging.cross_range_resolution_m),
        pulses_per_view=pulses_per_view,
        pulse_repetition_frequency_hz=waveform.pulse_repetition_frequency_hz,
        random=random,
    )
    bursts = track.bursts()

    errors_m = np.zeros((len(bursts), 2)) if tracking_error_m is None else tracking_error_m

    def frame(work: tuple[tuple[int, int], Floats, np.random.Generator]) -> Frame:
        (start, stop), (range_m, cross_range_m), of_noise = work
        history = simulate_echoes(
            points if visible >= 1 else _glinting(points, visible, of_noise),
            track.part(start, stop),
            waveform,
            signal_to_noise_db=signal_to_noise_db,
            random=of_noise,
        )
        if range_m or cross_range_m:
            history = displaced(history, range_m=range_m, cross_range_m=cross_range_m)
        (image,) = frames(history, imaging)
        return image

    images: list[Frame] = []
    works = zip(bursts, errors_m, random.spawn(len(bursts)), strict=True)
    for image in in_order(frame, works):
        images.append(image)
        progress("echoes and images", len(images), views)
    return images


def _glinting(points: Scatterers, visible: float, random: np.random.Generator) -> Scatterers:
    """Return the scatterers that a frame shows; what shades them stays whole."""
    seen = random.random(len(points.reflectivity)) < visible
    return replace(
        points,
        position_m=points.position_m[seen],
        normal=points.normal[seen],
        reflectivity=points.reflectivity[seen],
    )


def _carved(
    found: Sequence[OutlinedFrame],
    grid: VoxelGrid,
    truth: NDArray[np.bool_],
    rule: CarvingRule,
    target: Target,
    progress: Progress,
) -> _Carved:
    volume = VoteCounts(grid)
    for number, each in enumerate(found, start=1):
        view = View(silhouette=each.silhouette, projection=each.frame.projection)
        volume.add(carving_view(view, rule))
        progress(f"votes, {rule} rule", number, len(found))
    surface = hull_surface(volume)
    return _Carved(
        agreement=voxel_agreement(volume.hull(), truth),
        surface=surface,
        lines=tuple(_measured(surface, target)),
    )


def _measured(surface: Surface, target: Target) -> list[tuple[LineFeature, LineMeasurement | None]]:
    """Pair the target's features, longest first, with the hull's principal lines."""
    features = sorted(target.features, key=lambda feature: -feature.length_m)
    if surface.is_empty:
        return [(feature, None) for feature in features]
    first, second, third = (feature.name for feature in features)
    return list(zip(features, principal_lines(surface, (first, second, third)), strict=True))


def _figures(rule: CarvingRule, hull: _Carved) -> list[Figure]:
    named: list[tuple[str, float | None, str]] = [
        ("IoU", hull.agreement.intersection_over_union, ""),
        ("coverage", hull.agreement.coverage, ""),
    ]
    for feature, line in hull.lines:
        error = angle = length = None
        if line is not None:
            length = line.length_m
            error = abs(_error_percent(line, feature))
            angle = float(np.rad2deg(angle_between_lines_rad(line.direction, feature.direction)))
        named += [
            (feature.name, length, "m"),
            (f"{feature.name} error", error, "%"),
            (f"{feature.name} attitude error", angle, "°"),
        ]
    return [
        Figure(
            name=f"{name}, {rule} rule",
            value=value,
            unit=unit,
            wanted=WANTED.get(f"{name}, {rule} rule"),
        )
        for name, value, unit in named
    ]


def _row(rule: CarvingRule, hull: _Carved) -> tuple[str, ...]:
    lines = [
        "none" if line is None else f"{line.length_m:.2f}, {_error_percent(line, feature):+.1f} %"
        for feature, line in hull.lines
    ]
    return (
        rule,
        f"{hull.agreement.intersection_over_union:.3f}",
        f"{hull.agreement.coverage:.3f}",
        *lines,
    )


def _error_percent(line: LineMeasurement, feature: LineFeature) -> float:
    return (line.length_m / feature.length_m - 1) * 100


def _table(hulls: Mapping[CarvingRule, _Carved]) -> Table:
    features = [feature for feature, _ in hulls["shadow"].lines]
    truth = ("truth", "1.000", "1.000", *(f"{feature.length_m:.2f}" for feature in features))
    return Table(
        title="Hull from simulated echoes against the truth",
        columns=("rule", "IoU", "coverage", *(f"{feature.name} (m)" for feature in features)),
        rows=(*(_row(rule, hull) for rule, hull in hulls.items()), truth),
    )


def _finding(ours: _Carved, strict: _Carved) -> str:
    errors = [
        f"{feature.name} {_error_percent(line, feature):+.1f} %"
        for feature, line in ours.lines
        if line is not None
    ]
    return (
        f"From all around, the shadow rule keeps {100 * ours.agreement.coverage:.1f} % of the "
        f"target at an IoU of {ours.agreement.intersection_over_union:.3f} "
        f"({', '.join(errors) if errors else 'nothing is left to measure'}); the paper's strict "
        "rule, on the same outlines, carves the shaded sides away and keeps "
        f"{100 * strict.agreement.coverage:.1f} % (IoU "
        f"{strict.agreement.intersection_over_union:.3f})."
    )


def _pictures(found: Sequence[OutlinedFrame], ours: Surface, target: Target) -> tuple[Picture, ...]:
    return (
        frames_picture(
            found,
            target,
            name="wide-frames",
            caption="Radar frames from all around with the outlines found and the true ones: "
            "range down, cross-range right, 45 dB of amplitude.",
        ),
        sides_picture(ours, target, name="wide-hull", what="Hull of the shadow rule"),
        *error_pictures(ours, target, name="wide-errors", most_m=0.5),
    )
