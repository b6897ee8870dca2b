"""Arcs of an orbit over real stations: whole passes, and what a bistatic pair sees together."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import datetime

import numpy as np
from skyfield.api import EarthSatellite

from core.experiments.frame_pictures import OutlinedFrame
from core.frame import Frame
from core.geometry.bistatic import bistatic_track
from core.geometry.orbit import Pass, Station, line_of_sight_track, passes
from core.geometry.track import LineOfSightTrack
from core.parallel import in_order
from core.radar.echoes import ScatteringModel, simulate_echoes
from core.radar.imaging import ImagingSettings, interval_frame
from core.radar.intervals import CoherentInterval, divide
from core.radar.waveform import Waveform
from core.silhouettes.extraction import extract_silhouette

MASK_RAD = float(np.deg2rad(10.0))

DAY_S = 86400.0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Arc:
    """A stretch of the orbit that one radar, or one bistatic pair, images.

    Attributes:
        label: what a person calls it.
        track: line of sight at every pulse; of a pair, its bisector.
        intervals: coherent intervals, one frame each.
    """

    label: str
    track: LineOfSightTrack
    intervals: tuple[CoherentInterval, ...]

    def highest_elevation_deg(self) -> float | None:
        """Return the culmination above the station's horizon, None of a pair."""
        elevation = self.track.elevation_rad
        return None if elevation is None else float(np.rad2deg(elevation.max()))


def station_arcs(
    satellite: EarthSatellite,
    station: Station,
    waveform: Waveform,
    *,
    start_utc: datetime,
    count: int,
    frames: int,
) -> tuple[Arc, ...]:
    """Return a station's next passes, whole and in order.

    Args:
        satellite: on its orbit.
        station: the radar.
        waveform: of the radar.
        start_utc: when the search begins.
        count: passes.
        frames: of each pass's intervals, so many evenly chosen, or all where it has fewer.

    Raises:
        ValueError: the orbit does not come over the station so often within a day for each.
    """
    found = _passes(satellite, station, start_utc, count * DAY_S)[:count]
    if len(found) < count:
        raise ValueError(
            f"{count} passes over {station.name} are wanted, one a day at least; from "
            f"{start_utc.isoformat()} there are {len(found)}."
        )
    return tuple(
        _arc(
            f"{number}: {each.rise_utc:%d %b %H:%M}",
            _track(satellite, station, waveform, each.rise_utc, each.duration_s),
            waveform,
            frames,
        )
        for number, each in enumerate(found, start=1)
    )


def same_pass(
    satellite: EarthSatellite, station: Station, seen: Arc, waveform: Waveform, *, frames: int
) -> Arc:
    """Return the pass over another station that overlaps an arc.

    Raises:
        ValueError: the other station does not see the satellite then.
    """
    start_utc = datetime.fromisoformat(seen.track.epoch_utc)
    stop_s = float(seen.track.time_s[-1])
    for each in _passes(satellite, station, start_utc, DAY_S, before_s=1200.0):
        rise_s = (each.rise_utc - start_utc).total_seconds()
        if rise_s < stop_s and rise_s + each.duration_s > 0:
            track = _track(satellite, station, waveform, each.rise_utc, each.duration_s)
            return _arc(station.name, track, waveform, frames)
    raise ValueError(
        f"{station.name} does not see the satellite during the pass of {seen.track.epoch_utc}; "
        "choose stations nearer to each other."
    )


def pair_arc(
    satellite: EarthSatellite,
    transmitter: Station,
    receiver: Station,
    arcs: tuple[Arc, Arc],
    waveform: Waveform,
    *,
    frames: int,
) -> Arc:
    """Return what a pair of stations sees while both stand in sight of the satellite.

    Args:
        satellite: on its orbit.
        transmitter: sends.
        receiver: receives.
        arcs: of the transmitter and of the receiver, the same pass.
        waveform: of the transmitter.
        frames: of the intervals, so many evenly chosen.

    Raises:
        ValueError: both never see the satellite together, or stand too far apart for a pair.
    """
    rises = [datetime.fromisoformat(arc.track.epoch_utc) for arc in arcs]
    start_utc = max(rises)
    duration_s = min(
        float(arc.track.time_s[-1]) - (start_utc - rise).total_seconds()
        for arc, rise in zip(arcs, rises, strict=True)
    )
    if not duration_s > 0:
        raise ValueError(
            f"{transmitter.name} and {receiver.name} never see the satellite at the same time."
        )
    track = bistatic_track(
        *(
            _track(satellite, station, waveform, start_utc, duration_s)
            for station in (transmitter, receiver)
        )
    )
    return _arc(f"{transmitter.name} → {receiver.name}", track, waveform, frames)


def outlined_frames(
    arc: Arc,
    target: ScatteringModel,
    waveform: Waveform,
    *,
    signal_to_noise_db: float,
    random: np.random.Generator,
    progress: Callable[[int, int], None] = lambda _done, _total: None,
) -> list[OutlinedFrame]:
    """Return the frames of an arc, imaged from simulated echoes, with the outlines found in them.

    Args:
        arc: whose intervals are imaged.
        target: what scatters.
        waveform: of the radar.
        signal_to_noise_db: as in `simulate_echoes`.
        random: for the noise.
        progress: told of frames done and frames in all.
    """

    def outlined(work: tuple[CoherentInterval, np.random.Generator]) -> OutlinedFrame:
        interval, of_noise = work
        history = simulate_echoes(
            target,
            arc.track.part(interval.start, interval.stop),
            waveform,
            signal_to_noise_db=signal_to_noise_db,
            random=of_noise,
        )
        frame: Frame = interval_frame(history, interval.alone(), ImagingSettings(), label=arc.label)
        return OutlinedFrame(frame=frame, silhouette=extract_silhouette(frame))

    works = zip(arc.intervals, random.spawn(len(arc.intervals)), strict=True)
    found = []
    for each in in_order(outlined, works):
        found.append(each)
        progress(len(found), len(arc.intervals))
    return found


def _passes(
    satellite: EarthSatellite,
    station: Station,
    start_utc: datetime,
    duration_s: float,
    before_s: float = 0.0,
) -> tuple[Pass, ...]:
    return passes(
        satellite,
        station,
        start_utc=datetime.fromtimestamp(start_utc.timestamp() - before_s, tz=start_utc.tzinfo),
        duration_s=duration_s + before_s,
        elevation_mask_rad=MASK_RAD,
    )


def _track(
    satellite: EarthSatellite,
    station: Station,
    waveform: Waveform,
    start_utc: datetime,
    duration_s: float,
) -> LineOfSightTrack:
    return line_of_sight_track(
        satellite,
        station,
        start_utc=start_utc,
        duration_s=duration_s,
        pulse_repetition_frequency_hz=waveform.pulse_repetition_frequency_hz,
    )


def _arc(label: str, track: LineOfSightTrack, waveform: Waveform, frames: int) -> Arc:
    scale = 1.0 if track.bisector_scale is None else float(track.bisector_scale.mean())
    intervals: Sequence[CoherentInterval] = divide(
        track,
        wavelength_m=waveform.wavelength_m / scale,
        cross_range_resolution_m=ImagingSettings().cross_range_resolution_m,
    )
    count = min(frames, len(intervals))
    even = np.linspace(0, len(intervals) - 1, count).round().astype(int)
    return Arc(label=label, track=track, intervals=tuple(intervals[index] for index in even))
