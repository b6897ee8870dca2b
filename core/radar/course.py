"""The course of a pass: its geometry over time, and how it is divided into images."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.arrays import Floats, frozen
from core.geometry.track import LineOfSightTrack
from core.radar.imaging import ImagingSettings, assessed_intervals
from core.radar.intervals import AssessedInterval, CoherentInterval, Division, assess
from core.radar.phase_history import PhaseHistory

MOST_SAMPLES = 400
"""Of a pass, to draw it by: more than a plot on a screen has pixels for each of several passes."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class CourseInterval:
    """An interval of a pass with its place in time.

    Attributes:
        assessed: the interval, what is used of it, and the verdict.
        imaged: what its image is made of; of a rejected interval, what was wanted.
        start_s, stop_s: times of the first and the last pulse wanted.
        imaged_start_s, imaged_stop_s: times of the first and the last pulse imaged.
        middle_s: time of the image.
    """

    assessed: AssessedInterval
    imaged: CoherentInterval
    start_s: float
    stop_s: float
    imaged_start_s: float
    imaged_stop_s: float
    middle_s: float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PassCourse:
    """A pass over time, thinned out to be drawn, with all of its intervals.

    Attributes:
        label: what the pass and its frames are called.
        time_s: (samples,) growing, since the track's epoch.
        line_of_sight: (samples, 3) unit vectors, target frame.
        rotation_rate_rad_per_s: (samples,) |dk/dt|.
        resolution_m: (samples,) Rayleigh resolution in cross-range up to which the image around
            that time is sharp; NaN where no interval is or the interval was rejected.
        azimuth_rad: (samples,) at the station, clockwise from north, None without a station.
        elevation_rad: (samples,) at the station, above the horizon, None without a station.
        intervals: all of them in order, the rejected ones too; none where it is not known how the
            pass was divided.
        division: by which they were made and judged, None where that is not known.
        images_whole: whether images are made of the intervals as wanted, whatever the verdict.
        epoch_utc: ISO 8601 time of time_s = 0, empty without an orbit.
    """

    label: str
    time_s: Floats
    line_of_sight: Floats
    rotation_rate_rad_per_s: Floats
    resolution_m: Floats
    azimuth_rad: Floats | None
    elevation_rad: Floats | None
    intervals: tuple[CourseInterval, ...]
    division: Division | None
    images_whole: bool = False
    epoch_utc: str = ""

    def __post_init__(self) -> None:
        time_s = frozen(self.time_s, np.float64, (None,), "Times of the course")
        object.__setattr__(self, "time_s", time_s)
        samples = len(time_s)
        sight = frozen(self.line_of_sight, np.float64, (samples, 3), "line of sight")
        object.__setattr__(self, "line_of_sight", sight)
        for name in ("rotation_rate_rad_per_s", "azimuth_rad", "elevation_rad"):
            value = getattr(self, name)
            if value is not None:
                object.__setattr__(self, name, frozen(value, np.float64, (samples,), name))
        if self.resolution_m.shape != (samples,):
            raise ValueError(
                f"resolution_m: wanted an array of shape {samples}, got {self.resolution_m.shape}."
            )
        self.resolution_m.flags.writeable = False

    def interval_at(self, time_s: float) -> CourseInterval | None:
        """Return the interval whose image belongs to a time, None outside all of them.

        Of intervals that overlap, the one whose middle is nearest.
        """
        holding = [each for each in self.intervals if each.start_s <= time_s <= each.stop_s]
        return min(holding, key=lambda each: abs(each.middle_s - time_s), default=None)


def undivided_course(track: LineOfSightTrack, *, label: str = "") -> PassCourse:
    """Return the course of a track of which it is not known how it was divided."""
    return _course(track, None, (), label)


def pass_course(
    track: LineOfSightTrack, division: Division, *, label: str = "", images_whole: bool = False
) -> PassCourse:
    """Return the course of a track that is divided into intervals.

    Args:
        track: the line of sight at every pulse.
        division: how it is divided and by what intervals are judged.
        label: what the pass and its frames are called.
        images_whole: whether images are made of the intervals as wanted, whatever the verdict.

    Raises:
        ValueError: no burst turns far enough for even one interval, or the pulses are too sparse.
    """
    return _course(track, division, assess(track, division), label, images_whole)


def course_of_echoes(
    history: PhaseHistory, settings: ImagingSettings | None = None, *, label: str = ""
) -> PassCourse:
    """Return the course of a phase history as `core.radar.imaging.frames` divides it.

    Args:
        history: the echoes with their track.
        settings: how they become frames.
        label: what the pass and its frames are called.

    Raises:
        ValueError: as `core.radar.imaging.assessed_intervals`.
    """
    settings = settings or ImagingSettings()
    assessed = assessed_intervals(history, settings)
    return _course(history.track, settings.division(history.wavelength_m), assessed, label)


def _course(
    track: LineOfSightTrack,
    division: Division | None,
    assessed: Sequence[AssessedInterval],
    label: str,
    images_whole: bool = False,
) -> PassCourse:
    count = min(len(track), MOST_SAMPLES)
    chosen = np.linspace(0, len(track) - 1, count).round().astype(int)
    intervals = tuple(_placed(track, each, images_whole) for each in assessed)
    return PassCourse(
        label=label,
        time_s=track.time_s[chosen],
        line_of_sight=track.line_of_sight[chosen],
        rotation_rate_rad_per_s=track.rotation_rate_rad_per_s()[chosen],
        resolution_m=_resolution_m(track.time_s[chosen], intervals),
        azimuth_rad=None if track.azimuth_rad is None else track.azimuth_rad[chosen],
        elevation_rad=None if track.elevation_rad is None else track.elevation_rad[chosen],
        intervals=intervals,
        division=division,
        images_whole=images_whole,
        epoch_utc=track.epoch_utc,
    )


def _placed(
    track: LineOfSightTrack, assessed: AssessedInterval, images_whole: bool
) -> CourseInterval:
    wanted = assessed.wanted
    imaged = wanted if images_whole or assessed.used is None else assessed.used
    return CourseInterval(
        assessed=assessed,
        imaged=imaged,
        start_s=float(track.time_s[wanted.start]),
        stop_s=float(track.time_s[wanted.stop - 1]),
        imaged_start_s=float(track.time_s[imaged.start]),
        imaged_stop_s=float(track.time_s[imaged.stop - 1]),
        middle_s=float(track.time_s[imaged.middle]),
    )


def _resolution_m(time_s: Floats, intervals: Sequence[CourseInterval]) -> Floats:
    """Return the sharp resolution at each time, NaN outside intervals and in rejected ones."""
    resolution_m = np.full(len(time_s), np.nan)
    distance_s = np.full(len(time_s), np.inf)
    for each in intervals:
        away_s = np.abs(time_s - each.middle_s)
        nearer = (time_s >= each.start_s) & (time_s <= each.stop_s) & (away_s < distance_s)
        distance_s[nearer] = away_s[nearer]
        is_rejected = each.assessed.used is None
        resolution_m[nearer] = np.nan if is_rejected else each.assessed.verdict.resolution_m
    return resolution_m
