"""What a hull from echoes is worth under given noise, resolution and number of frames."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from core.experiments.frame_pictures import OutlinedFrame
from core.geometry.grid import VoxelGrid
from core.geometry.track import random_views_track
from core.hull.shadow import carving_view
from core.hull.surface import EMPTY_SURFACE, Surface, hull_surface
from core.hull.view import View
from core.hull.votes import VoteCounts
from core.measurement.comparison import voxel_agreement
from core.measurement.lines import angle_between_lines_rad, principal_lines
from core.parallel import in_order
from core.radar.echoes import receiver_noise, simulate_echoes
from core.radar.imaging import ImagingSettings, frames
from core.radar.phase_history import PhaseHistory
from core.radar.scatterers import surface_scatterers
from core.radar.waveform import SPEED_OF_LIGHT_M_PER_S, Waveform
from core.silhouettes.extraction import extract_silhouette
from core.targets import Target

SWATH_M = 38.4
"""Width of what echoes tell apart, in range and cross-range, at every resolution."""

IMAGE_M = 30.72
"""Width of the images."""

PIXELS_PER_CELL = 2.5
"""The resolution is so many pixels wide, so that every step in pixels means the same."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Condition:
    """What is varied.

    Attributes:
        signal_to_noise_db: per pulse and frequency sample, as in `simulate_echoes`.
        resolution_m: Rayleigh resolution in range (bandwidth) and cross-range (turn).
        frames: that vote.
    """

    signal_to_noise_db: float
    resolution_m: float
    frames: int

    def waveform(self) -> Waveform:
        """Return the waveform of this resolution, its samples enough for the swath."""
        return Waveform(
            bandwidth_hz=SPEED_OF_LIGHT_M_PER_S / (2 * self.resolution_m),
            frequency_count=_even(SWATH_M / self.resolution_m),
        )

    def imaging(self) -> ImagingSettings:
        """Return the settings of images of this resolution."""
        pixel_m = self.resolution_m / PIXELS_PER_CELL
        side = _even(IMAGE_M / pixel_m)
        return ImagingSettings(
            cross_range_resolution_m=self.resolution_m,
            pixel_spacing_m=pixel_m,
            shape=(side, side),
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Accuracy:
    """What one hull is worth; an empty one has no lines.

    Attributes:
        intersection_over_union: with the true voxels.
        coverage: share of the true voxels that it keeps.
        length_error_percent: mean size of the three principal lines' errors.
        attitude_error_deg: mean of their angles to the true ones.
    """

    intersection_over_union: float
    coverage: float
    length_error_percent: float | None
    attitude_error_deg: float | None


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Sight:
    """What one view shows at every level of noise.

    Attributes:
        views: as it votes at each level in dB; None where no target is found.
        shown: the frame with the outline found at each level; only the first view keeps them.
    """

    views: Mapping[float, View | None]
    shown: Mapping[float, OutlinedFrame]


def sights(
    target: Target,
    condition: Condition,
    levels_db: Sequence[float],
    *,
    scatterers: int,
    seed: int,
) -> Iterator[Sight]:
    """Yield what views from random directions show at several levels of noise on equal echoes.

    The same seed looks from the same directions at every resolution, and a view's noise is the
    same at every level but for its strength.

    Args:
        target: what is seen.
        condition: resolution and number of frames; its noise means nothing here.
        levels_db: signal-to-noise ratios as in `simulate_echoes`.
        scatterers: points on the target's surface.
        seed: of directions, scatterers and noise.
    """
    random = np.random.default_rng(seed)
    points = surface_scatterers(target, count=scatterers, random=random)
    waveform, imaging = condition.waveform(), condition.imaging()
    track = random_views_track(
        views=condition.frames,
        turn_rad=waveform.wavelength_m / (2 * condition.resolution_m),
        pulses_per_view=waveform.frequency_count,
        pulse_repetition_frequency_hz=waveform.pulse_repetition_frequency_hz,
        random=random,
    )
    power = points.mean_echo_power()

    def sight(work: tuple[int, tuple[int, int], np.random.Generator]) -> Sight:
        number, (start, stop), of_noise = work
        clean = simulate_echoes(
            points,
            track.part(start, stop),
            waveform,
            signal_to_noise_db=np.inf,
            random=of_noise,
        )
        noise = receiver_noise(clean.samples.shape, power, of_noise)
        found = {
            level: _outlined(_noisy(clean, noise, level), imaging, condition.resolution_m, level)
            for level in levels_db
        }
        views = {level: _vote(each) for level, each in found.items()}
        return Sight(views=views, shown=found if number == 0 else {})

    bursts = track.bursts()
    works = zip(range(len(bursts)), bursts, random.spawn(len(bursts)), strict=True)
    yield from in_order(sight, works)


def hull_accuracy(
    views: Sequence[View], grid: VoxelGrid, truth: NDArray[np.bool_], target: Target
) -> tuple[Accuracy, Surface]:
    """Carve a hull and hold it against the truth, its lines against the target's features.

    Args:
        views: as they vote; none leave nothing to carve, which counts as nothing found.
        grid: to carve on.
        truth: (nx, ny, nz) voxels of the target.
        target: with three features.
    """
    if not views:
        return _nothing(), EMPTY_SURFACE
    volume = VoteCounts(grid)
    for view in views:
        volume.add(view)
    agreement, surface = voxel_agreement(volume.hull(), truth), hull_surface(volume)
    length_percent, angle_deg = _line_errors(surface, target)
    accuracy = Accuracy(
        intersection_over_union=agreement.intersection_over_union,
        coverage=agreement.coverage,
        length_error_percent=length_percent,
        attitude_error_deg=angle_deg,
    )
    return accuracy, surface


def _nothing() -> Accuracy:
    return Accuracy(
        intersection_over_union=0.0,
        coverage=0.0,
        length_error_percent=None,
        attitude_error_deg=None,
    )


def _line_errors(surface: Surface, target: Target) -> tuple[float | None, float | None]:
    if surface.is_empty:
        return None, None
    features = sorted(target.features, key=lambda feature: -feature.length_m)
    first, second, third = (feature.name for feature in features)
    pairs = list(zip(features, principal_lines(surface, (first, second, third)), strict=True))
    lengths = [abs(line.length_m / feature.length_m - 1) for feature, line in pairs]
    angles = [angle_between_lines_rad(line.direction, feature.direction) for feature, line in pairs]
    return 100 * float(np.mean(lengths)), float(np.rad2deg(np.mean(angles)))


def _noisy(clean: PhaseHistory, noise: NDArray[np.complex64], level_db: float) -> PhaseHistory:
    return replace(clean, samples=clean.samples + noise * np.float32(10 ** (-level_db / 20)))


def _outlined(
    history: PhaseHistory, imaging: ImagingSettings, resolution_m: float, level_db: float
) -> OutlinedFrame:
    (image,) = frames(history, imaging)
    named = replace(image, label=f"{level_db:g} dB, {resolution_m:g} m")
    return OutlinedFrame(frame=named, silhouette=extract_silhouette(named))


def _vote(each: OutlinedFrame) -> View | None:
    if each.silhouette.is_empty:
        return None
    view = View(silhouette=each.silhouette, projection=each.frame.projection)
    return carving_view(view, "shadow")


def _even(count: float) -> int:
    return 2 * round(count / 2)
