"""An MRO-like orbiter seen from all around: its echoes, hull, scatterers, tracks, and lines."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import trimesh

from core.arrays import Floats
from core.energy_accumulation.extraction import extract_scatterers
from core.experiments.beijing_pass import BeijingPass
from core.experiments.exact_features import mro_features
from core.experiments.frame_pictures import OutlinedFrame
from core.experiments.lines_found import LinesFound, line_found
from core.experiments.study import Progress
from core.experiments.wide import simulated_frames
from core.factorization.tracks import Glint, glinting, tracks_of
from core.frame import Frame
from core.geometry.grid import VoxelGrid
from core.geometry.projection import range_doppler_projection
from core.hull.bounds import hull_bounds_m
from core.hull.shadow import carving_view
from core.hull.surface import Surface, hull_surface
from core.hull.view import View
from core.hull.votes import VoteCounts
from core.measurement.anchors import Extreme
from core.measurement.measuring import measure_all
from core.measurement.results import Lost
from core.measurement.specs import LineFeature as LineSpec
from core.radar.imaging import ImagingSettings
from core.radar.waveform import Waveform
from core.silhouettes.extraction import extract_silhouette
from core.silhouettes.silhouette import Silhouette
from core.targets import Target, mro_like

FINE_M, FINE_BANDWIDTH_HZ = 0.15, 1.0e9
"""The built-in radar's resolution and its band; a coarser one has less."""

SWATH_M = 76.8
"""What the echoes tell apart in range and cross-range; the target spans 58 m."""

IMAGE_M = 61.44
"""Side of an image."""

PIXELS_PER_CELL = 2.5

POINTS = 755
"""Scatterers that the paper's factorization tracks."""

REACH_M = 3.0
"""How far from a line's true end an analyst takes a scatterer for it."""

ROTATION_RATE_RAD_PER_S = (0.005, 0.015)
"""Of wide views, different in every frame and unknown to the unscaled factorization."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Motion:
    """The line of sight in the middle of every frame.

    Attributes:
        line_of_sight: (frames, 3) unit vectors k.
        rate_per_s: (frames, 3) dk/dt.
    """

    line_of_sight: Floats
    rate_per_s: Floats

    def tracks(
        self, points_m: Floats, glint: Glint, random: np.random.Generator, *, scaled: bool
    ) -> Floats:
        """Return the tracks (frames, points, 2) of scatterers as glint leaves them.

        Args:
            points_m: (points, 3), target frame.
            glint: the model.
            random: of it.
            scaled: in metres of cross-range instead of range rates.
        """
        rate = np.linalg.norm(self.rate_per_s, axis=1)
        tracks = glinting(
            tracks_of(points_m, self.line_of_sight, self.rate_per_s),
            glint,
            rotation_rate_rad_per_s=rate,
            random=random,
        )
        unit = np.stack([np.ones_like(rate), rate if scaled else np.ones_like(rate)], axis=1)
        scaled_tracks: Floats = tracks / unit[:, None]
        return scaled_tracks


def wide_motion(frames: Sequence[Frame], random: np.random.Generator) -> Motion:
    """Return the motion of frames from all around, each turning at a rate of its own."""
    across = np.array([frame.projection.matrix[1, :3] for frame in frames])
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    rate = random.uniform(*ROTATION_RATE_RAD_PER_S, (len(frames), 1))
    return Motion(
        line_of_sight=np.array([frame.line_of_sight for frame in frames]), rate_per_s=rate * across
    )


def pass_motion(seen: BeijingPass) -> Motion:
    """Return the motion of a pass in the middle of its intervals."""
    middles = [interval.middle for interval in seen.intervals]
    return Motion(
        line_of_sight=seen.track.line_of_sight[middles],
        rate_per_s=seen.track.line_of_sight_rate_per_s[middles],
    )


def lit_sides(seen: BeijingPass) -> list[View]:
    """Return views of a pass that bound what lit sides do, whatever their target looks like."""
    square = np.array([[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]])
    views = []
    for interval in seen.intervals:
        projection = range_doppler_projection(
            line_of_sight=seen.track.line_of_sight[interval.middle],
            line_of_sight_rate_per_s=seen.track.line_of_sight_rate_per_s[interval.middle],
            row_spacing_m=1.0,
            column_spacing_m=1.0,
            shape=(4, 4),
        )
        side = Silhouette(rings=(square + 2,), image_shape=(4, 4), claim="lit side")
        views.append(carving_view(View(silhouette=side, projection=projection), "shadow"))
    return views


def line_ends_m() -> Floats:
    """Return the true ends of the lines of `mro_like`, (lines, 2, 3), target frame."""
    return np.array([[start.near_m, end.near_m] for start, end in map(_anchors, _specs())])


def scatterers_with_ends(count: int, random: np.random.Generator) -> Floats:
    """Return the ends of all lines, then scatterers spread over the surface, (count, 3)."""
    ends = line_ends_m().reshape(-1, 3)
    spread, _ = trimesh.sample.sample_surface(
        mro_like().mesh(), count - len(ends), seed=int(random.integers(2**32))
    )
    return np.concatenate([ends, spread])


def echo_frames(
    target: Target,
    *,
    views: int,
    scatterers: int,
    signal_to_noise_db: float,
    seed: int,
    resolution_m: float = FINE_M,
    visible: float = 1.0,
    progress: Progress,
) -> list[Frame]:
    """Return frames from random directions; the same seed gives the same directions.

    Args:
        target: what is seen.
        views: number of frames.
        scatterers: points on the surface.
        signal_to_noise_db: as in `simulate_echoes`.
        seed: of directions, scatterers and noise.
        resolution_m: in range and cross-range.
        visible: probability that a scatterer is seen in a frame.
        progress: told of stage, steps done and steps in all.
    """
    samples = round(SWATH_M / resolution_m)
    pixel_m = resolution_m / PIXELS_PER_CELL
    side_px = round(IMAGE_M / pixel_m)
    return simulated_frames(
        target,
        views=views,
        scatterers=scatterers,
        signal_to_noise_db=signal_to_noise_db,
        random=np.random.default_rng(seed),
        waveform=Waveform(
            bandwidth_hz=FINE_BANDWIDTH_HZ * FINE_M / resolution_m, frequency_count=samples
        ),
        imaging=ImagingSettings(
            cross_range_resolution_m=resolution_m,
            shape=(side_px, side_px),
            pixel_spacing_m=pixel_m,
        ),
        pulses_per_view=samples,
        visible=visible,
        progress=progress,
    )


def outlined(frames: Sequence[Frame]) -> list[OutlinedFrame]:
    """Return frames with their extracted silhouettes; those that show no target are left out."""
    pairs = [OutlinedFrame(frame=each, silhouette=extract_silhouette(each)) for each in frames]
    return [each for each in pairs if not each.silhouette.is_empty]


def carved_surface(found: Sequence[OutlinedFrame], *, spacing_m: float) -> Surface:
    """Return the hull under the shadow rule, on the grid that the silhouettes leave."""
    views = [
        carving_view(View(silhouette=each.silhouette, projection=each.frame.projection), "shadow")
        for each in found
    ]
    lower_m, upper_m = hull_bounds_m(views)
    margin_m = 2 * spacing_m
    grid = VoxelGrid.over(
        lower_m=lower_m - margin_m, upper_m=upper_m + margin_m, spacing_m=spacing_m
    )
    volume = VoteCounts(grid)
    for view in views:
        volume.add(view)
    return hull_surface(volume)


def hull_lines(method: str, surface: Surface) -> LinesFound:
    """Return the lines as an analyst measures them on a hull: picked near each end."""
    features = mro_like().features
    specs = _specs()
    if surface.is_empty:
        return LinesFound(method=method, lines=(None,) * len(specs), note="empty hull")
    ends = [
        None if isinstance(each, Lost) else each.points_m for each in measure_all(specs, surface)
    ]
    return LinesFound(method=method, lines=tuple(map(line_found, features, ends)))


def accumulated_lines(
    method: str,
    frames: Sequence[Frame],
    *,
    spacing_m: float,
    most: int,
    progress: Progress,
) -> tuple[LinesFound, Floats]:
    """Return lines between ISEA's scatterers, and the scatterers (n, 3).

    A line ends at the scatterer farthest along it of those near its true end.

    Args:
        method: what it is called.
        frames: all frames.
        spacing_m: of the candidate places.
        most: scatterers to find.
        progress: told of stage, steps done and steps in all.
    """
    reach_m = 1.0 + np.abs(mro_like().mesh().vertices).max(axis=0)
    grid = VoxelGrid.over(lower_m=-reach_m, upper_m=reach_m, spacing_m=spacing_m)
    points = extract_scatterers(
        frames, grid, most=most, measure="energy", progress=progress
    ).position_m
    features = mro_like().features
    ends = [
        _farthest(points, pair, feature.direction)
        for pair, feature in zip(line_ends_m(), features, strict=True)
    ]
    return LinesFound(method=method, lines=tuple(map(line_found, features, ends))), points


def _farthest(points_m: Floats, near_m: Floats, direction: Floats) -> Floats | None:
    ends = []
    for place, outward in zip(near_m, (-direction, direction), strict=True):
        close = points_m[np.linalg.norm(points_m - place, axis=1) < REACH_M]
        if not len(close):
            return None
        ends.append(close[np.argmax(close @ outward)])
    return np.array(ends)


def _specs() -> list[LineSpec]:
    return [each.spec for each in mro_features() if isinstance(each.spec, LineSpec)]


def _anchors(spec: LineSpec) -> tuple[Extreme, Extreme]:
    if not (isinstance(spec.start, Extreme) and isinstance(spec.end, Extreme)):
        raise TypeError(f'"{spec.name}" does not end where a part ends.')
    return spec.start, spec.end
