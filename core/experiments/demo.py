"""The built-in demo: three passes of a Tiangong-1-like laboratory over Beijing."""

from collections.abc import Iterator
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta

import numpy as np
from numpy.random import Generator

from core.frame import Frame
from core.geometry.orbit import (
    MeanElements,
    Station,
    line_of_sight_track,
    passes,
    satellite_from_elements,
)
from core.geometry.track import LineOfSightTrack
from core.parallel import in_order
from core.radar.course import PassCourse, pass_course
from core.radar.echoes import simulate_echoes
from core.radar.imaging import ImagingSettings, interval_frame
from core.radar.intervals import CoherentInterval, divide
from core.radar.phase_history import PhaseHistory
from core.radar.scatterers import Scatterers, surface_scatterers
from core.radar.waveform import Waveform
from core.targets import tiangong_like

DEMO_ORBIT = MeanElements(
    name="Tiangong-1-like",
    epoch_utc=datetime(2016, 3, 11, tzinfo=UTC) + timedelta(days=0.47512016),
    inclination_deg=42.7628,
    node_deg=110.5320,
    eccentricity=0.0009524,
    argument_of_perigee_deg=97.7639,
    mean_anomaly_deg=50.1243,
    mean_motion_rev_per_day=15.59909646,
    drag_per_earth_radius=2.1761e-4,
)
"""The elements of Tiangong-1 (catalogue number 37820) of day 71.475 of 2016, as published by
USSPACECOM."""

DEMO_STATION = Station(latitude_deg=39.9, longitude_deg=116.4, height_m=88.0, name="Beijing")

DEMO_PASSES = (0, 1, 7)
"""Which passes after 2016-03-11 15:00 UTC: culminating 42° high in the north, 57° in the south
and, a day later, 84°. One pass sees almost one plane only; these three see the body from both
sides and from below. Above it, always turned away from the station, the hull stays too high."""

FRAMES_PER_PASS = 20

_MASK_RAD = float(np.deg2rad(10.0))


def demo_tracks(waveform: Waveform) -> tuple[LineOfSightTrack, ...]:
    """Return the demo's passes, one track each."""
    satellite = satellite_from_elements(DEMO_ORBIT)
    found = passes(
        satellite,
        DEMO_STATION,
        start_utc=datetime(2016, 3, 11, 15, tzinfo=UTC),
        duration_s=32 * 3600.0,
        elevation_mask_rad=_MASK_RAD,
    )
    return tuple(
        line_of_sight_track(
            satellite,
            DEMO_STATION,
            start_utc=each.rise_utc,
            duration_s=each.duration_s,
            pulse_repetition_frequency_hz=waveform.pulse_repetition_frequency_hz,
        )
        for each in (found[index] for index in DEMO_PASSES)
    )


def demo_intervals(waveform: Waveform) -> list[tuple[int, LineOfSightTrack, CoherentInterval]]:
    """Return the demo's coherent intervals as (pass number from 1, its track, interval).

    Of each pass, `FRAMES_PER_PASS` intervals evenly spread over its turn.
    """
    chosen = []
    for number, track in enumerate(demo_tracks(waveform), start=1):
        intervals = divide(
            track,
            wavelength_m=waveform.wavelength_m,
            cross_range_resolution_m=ImagingSettings().cross_range_resolution_m,
        )
        even = np.linspace(0, len(intervals) - 1, FRAMES_PER_PASS).round().astype(int)
        chosen += [(number, track, intervals[index]) for index in even]
    return chosen


def demo_courses() -> tuple[PassCourse, ...]:
    """Return the course of each of the demo's passes, labelled as its frames are.

    Intervals are judged for the whole target by what polar format, which images them, leaves. The
    demo images all of them whole.
    """
    waveform = Waveform()
    radius_m = float(np.linalg.norm(tiangong_like().mesh().vertices, axis=1).max().round(1))
    settings = ImagingSettings(target_radius_m=radius_m, criterion="bending")
    division = settings.division(waveform.wavelength_m)
    return tuple(
        pass_course(track, division, label=_label(number), images_whole=True)
        for number, track in enumerate(demo_tracks(waveform), start=1)
    )


def demo_frames(*, seed: int = 1, scatterers: int = 25_000) -> Iterator[Frame]:
    """Simulate the demo's echoes interval by interval and yield their images as they come.

    Args:
        seed: of the random generators, one for the target and one for each interval's noise.
        scatterers: points on the target's surface.
    """

    def frame(work: _Work) -> Frame:
        history, interval, label = _echoes(work)
        return interval_frame(history, interval, ImagingSettings(), label=label)

    yield from in_order(frame, _work(seed, scatterers))


def demo_echoes(
    *, seed: int = 1, scatterers: int = 25_000
) -> Iterator[tuple[PhaseHistory, CoherentInterval, str]]:
    """Yield what `demo_frames` makes its images of: (echoes, their interval, label).

    Args:
        seed: of the random generators, one for the target and one for each interval's noise.
        scatterers: points on the target's surface.
    """
    yield from in_order(_echoes, _work(seed, scatterers))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Work:
    """One interval of the demo to be simulated."""

    points: Scatterers
    number: int
    track: LineOfSightTrack
    interval: CoherentInterval
    waveform: Waveform
    random: Generator


def _work(seed: int, scatterers: int) -> Iterator[_Work]:
    waveform = Waveform()
    intervals = demo_intervals(waveform)
    of_target, *of_noise = np.random.default_rng(seed).spawn(1 + len(intervals))
    points = surface_scatterers(tiangong_like(), count=scatterers, random=of_target)
    for (number, track, interval), random in zip(intervals, of_noise, strict=True):
        yield _Work(
            points=points,
            number=number,
            track=track,
            interval=interval,
            waveform=waveform,
            random=random,
        )


def _echoes(work: _Work) -> tuple[PhaseHistory, CoherentInterval, str]:
    history = simulate_echoes(
        work.points,
        work.track.part(work.interval.start, work.interval.stop),
        work.waveform,
        signal_to_noise_db=20.0,
        random=work.random,
    )
    return history, work.interval.alone(), _label(work.number)


def _label(number: int) -> str:
    return f"pass {number}"
