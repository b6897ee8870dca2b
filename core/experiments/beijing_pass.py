"""The pass of the paper's experiment B: a satellite 400 km up crosses over Beijing."""

from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime

import numpy as np
from skyfield.api import EarthSatellite

from core.frame import Frame
from core.geometry.orbit import (
    MeanElements,
    Station,
    line_of_sight_track,
    passes,
    satellite_from_elements,
)
from core.geometry.track import LineOfSightTrack, angles_from_line_of_sight
from core.hull.sunlight import MOST_PHASE_RAD
from core.optical.simulation import OpticalSettings, simulate_optical_frames
from core.optical.sun import Illumination, phase_angle_rad, track_illumination
from core.parallel import in_order
from core.radar.echoes import simulate_echoes
from core.radar.imaging import ImagingSettings, interval_frame
from core.radar.intervals import CoherentInterval, divide
from core.radar.scatterers import Scatterers, surface_scatterers
from core.radar.waveform import Waveform
from core.targets import Target

ORBIT = MeanElements(
    name="400 km",
    epoch_utc=datetime(2024, 5, 20, 20, tzinfo=UTC),
    inclination_deg=42.8,
    node_deg=241.862,
    eccentricity=0.0001,
    argument_of_perigee_deg=190.626,
    mean_anomaly_deg=188.732,
    mean_motion_rev_per_day=15.557,
)
"""A circular orbit 400 km up in Tiangong-1's inclination. Of 150 days of its passes this one comes
near the paper's spans while the satellite is sunlit over a dark station, so that radar and
telescope can both see it."""

STATION = Station(latitude_deg=39.9, longitude_deg=116.4, height_m=88.0, name="Beijing")

MASK_RAD = float(np.deg2rad(10.0))

PAPER_SPANS_DEG = (158.26, 49.58)
"""Azimuth and elevation that the paper's pass spans."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class BeijingPass:
    """The pass as the station sees it.

    Attributes:
        satellite: on its orbit.
        track: the line of sight at every pulse.
        intervals: coherent intervals, one frame each.
        waveform: of the radar.
    """

    satellite: EarthSatellite
    track: LineOfSightTrack
    intervals: tuple[CoherentInterval, ...]
    waveform: Waveform

    def station_spans_deg(self) -> tuple[float, float]:
        """Return what azimuth and elevation at the station span, in degrees."""
        azimuth, elevation = self.track.azimuth_rad, self.track.elevation_rad
        if azimuth is None or elevation is None:  # a track of an orbit has both
            raise ValueError("The track has no station, so it has no azimuth.")
        return _span_deg(azimuth), _span_deg(elevation)

    def target_spans_deg(self) -> tuple[float, float]:
        """Return what the paper's φ and θ span in the target frame, in degrees (eq. 3)."""
        elevation, azimuth = angles_from_line_of_sight(self.track.line_of_sight)
        return _span_deg(np.unwrap(azimuth)), _span_deg(elevation)

    def times_s(self) -> list[float]:
        """Return the time of each interval's image."""
        return [float(self.track.time_s[interval.middle]) for interval in self.intervals]

    def illumination(self) -> Illumination:
        """Return the light at each interval's image."""
        return track_illumination(self.satellite, self.track, np.array(self.times_s()))

    def fit_moments(self) -> list[int]:
        """Return the numbers of the intervals at which a telescope's outline may carve.

        The satellite must be sunlit, and the sun not too far from behind the observer.
        """
        light = self.illumination()
        middles = [interval.middle for interval in self.intervals]
        return [
            number
            for number, k in enumerate(self.track.line_of_sight[middles])
            if light.sunlit_fraction[number] > 0
            and float(phase_angle_rad(k, light.sun_direction[number])) <= MOST_PHASE_RAD
        ]


def beijing_pass(*, frames: int | None = None) -> BeijingPass:
    """Return the pass, divided into coherent intervals of 0.15 m cross-range resolution.

    Args:
        frames: of all intervals, so many evenly chosen; None for all.

    Raises:
        ValueError: fewer than two frames.
    """
    if frames is not None and frames < 2:
        raise ValueError(f"A pass needs at least 2 frames, got {frames}.")
    waveform = Waveform()
    satellite = satellite_from_elements(ORBIT)
    (seen,) = passes(
        satellite,
        STATION,
        start_utc=ORBIT.epoch_utc,
        duration_s=1800.0,
        elevation_mask_rad=MASK_RAD,
    )
    track = line_of_sight_track(
        satellite,
        STATION,
        start_utc=seen.rise_utc,
        duration_s=seen.duration_s,
        pulse_repetition_frequency_hz=waveform.pulse_repetition_frequency_hz,
    )
    intervals = divide(
        track,
        wavelength_m=waveform.wavelength_m,
        cross_range_resolution_m=ImagingSettings().cross_range_resolution_m,
    )
    count = len(intervals) if frames is None else min(frames, len(intervals))
    even = np.linspace(0, len(intervals) - 1, count).round().astype(int)
    return BeijingPass(
        satellite=satellite,
        track=track,
        intervals=tuple(intervals[index] for index in even),
        waveform=waveform,
    )


def radar_frames(
    seen: BeijingPass,
    target: Target,
    *,
    scatterers: int,
    signal_to_noise_db: float,
    random: np.random.Generator,
    progress: Callable[[int, int], None] = lambda _done, _total: None,
) -> list[Frame]:
    """Return the radar's frames of the pass, imaged from simulated echoes.

    Args:
        seen: the pass.
        target: what is seen.
        scatterers: points on its surface.
        signal_to_noise_db: as in `simulate_echoes`.
        random: for scatterers and noise.
        progress: told of frames done and frames in all.
    """
    points = surface_scatterers(target, count=scatterers, random=random)

    def frame(work: tuple[CoherentInterval, np.random.Generator]) -> Frame:
        return _radar_frame(seen, points, *work, signal_to_noise_db=signal_to_noise_db)

    works = zip(seen.intervals, random.spawn(len(seen.intervals)), strict=True)
    images = []
    for image in in_order(frame, works):
        images.append(image)
        progress(len(images), len(seen.intervals))
    return images


def optical_frames(
    seen: BeijingPass,
    target: Target,
    moments: list[int],
    settings: OpticalSettings,
    *,
    random: np.random.Generator,
    progress: Callable[[int, int], None] = lambda _done, _total: None,
) -> list[Frame]:
    """Return what a telescope beside the radar photographs at the moments of radar frames.

    Args:
        seen: the pass.
        target: what is seen.
        moments: numbers of the radar frames.
        settings: of telescope and detector.
        random: for photons and reading.
        progress: told of frames done and frames in all.
    """
    times_s, light = seen.times_s(), seen.illumination()
    return list(
        simulate_optical_frames(
            target,
            seen.track,
            [times_s[number] for number in moments],
            Illumination(
                sun_direction=light.sun_direction[moments],
                sunlit_fraction=light.sunlit_fraction[moments],
                earth_distance_m=light.earth_distance_m[moments],
            ),
            settings,
            random=random,
            progress=progress,
        )
    )


def _radar_frame(
    seen: BeijingPass,
    points: Scatterers,
    interval: CoherentInterval,
    random: np.random.Generator,
    *,
    signal_to_noise_db: float,
) -> Frame:
    history = simulate_echoes(
        points,
        seen.track.part(interval.start, interval.stop),
        seen.waveform,
        signal_to_noise_db=signal_to_noise_db,
        random=random,
    )
    return interval_frame(history, interval.alone(), ImagingSettings(), label="radar")


def _span_deg(angle_rad: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> float:
    return float(np.rad2deg(np.ptp(angle_rad)))
