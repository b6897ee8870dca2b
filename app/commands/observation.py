"""Which pass of which orbit over which station: the options, and the track they mean."""

from dataclasses import dataclass
from datetime import UTC, datetime
from typing import TypeVar

import numpy as np
from skyfield.api import EarthSatellite

from app.commands.options import OptionalFile
from core.experiments.demo import DEMO_ORBIT, DEMO_STATION
from core.formats.element_sets import read_element_sets
from core.formats.untrusted_hdf5 import MAX_BYTES
from core.geometry.orbit import (
    Pass,
    Station,
    line_of_sight_track,
    passes,
    satellite_from_elements,
    satellite_from_tle,
)
from core.geometry.track import LineOfSightTrack
from core.radar.waveform import Waveform

Item = TypeVar("Item")

SEARCH_DAYS = 2


@dataclass(frozen=True)
class Observation:
    """Which pass of which orbit over which station."""

    tle: OptionalFile = None
    """File of two-line element sets; without one, Tiangong-1's orbit of March 2016."""
    tle_index: int = 0
    """Which set of the file, from 0."""
    latitude_deg: float = DEMO_STATION.latitude_deg
    """Of the station, degrees north."""
    longitude_deg: float = DEMO_STATION.longitude_deg
    """Of the station, degrees east."""
    height_m: float = DEMO_STATION.height_m
    """Of the station above the WGS 84 ellipsoid, metres."""
    start: str = "2016-03-11T15:00:00"
    """Look for passes in the two days from this UTC time on."""
    pass_index: int = 0
    """Which of those passes, from 0."""
    mask_deg: float = 10.0
    """Elevation mask, degrees."""


DEFAULT_OBSERVATION = Observation()


def pass_track(observation: Observation, waveform: Waveform) -> LineOfSightTrack:
    """Return the line of sight along the chosen pass.

    Raises:
        ValueError: no such element set, time or pass, or more echoes than a pass file may hold.
    """
    station = Station(
        latitude_deg=observation.latitude_deg,
        longitude_deg=observation.longitude_deg,
        height_m=observation.height_m,
    )
    satellite = observed_satellite(observation)
    found = passes(
        satellite,
        station,
        start_utc=utc_time(observation.start),
        duration_s=SEARCH_DAYS * 86400.0,
        elevation_mask_rad=float(np.deg2rad(observation.mask_deg)),
    )
    each = _chosen(
        found, observation.pass_index, "pass", f"the {SEARCH_DAYS} days from {observation.start}"
    )
    _check_memory(each, waveform)
    return line_of_sight_track(
        satellite,
        station,
        start_utc=each.rise_utc,
        duration_s=each.duration_s,
        pulse_repetition_frequency_hz=waveform.pulse_repetition_frequency_hz,
    )


def _check_memory(each: Pass, waveform: Waveform) -> None:
    pulses = each.duration_s * waveform.pulse_repetition_frequency_hz
    needed = pulses * waveform.frequency_count * np.dtype(np.complex64).itemsize
    if needed > MAX_BYTES:
        raise ValueError(
            f"{pulses:.4g} pulses of {waveform.frequency_count} frequencies need "
            f"{needed / 2**30:,.1f} GiB; a pass file holds at most {MAX_BYTES / 2**30:.0f} GiB. "
            "Lower --prf-hz or --frequency-count, or raise --mask-deg."
        )


def observed_satellite(observation: Observation) -> EarthSatellite:
    """Return whose pass it is.

    Raises:
        ValueError: no readable element set of that number.
    """
    if observation.tle is None:
        return satellite_from_elements(DEMO_ORBIT)
    sets = read_element_sets(observation.tle)
    return satellite_from_tle(
        *_chosen(sets, observation.tle_index, "element set", str(observation.tle))
    )


def utc_time(text: str) -> datetime:
    """Return the time that a text in ISO 8601 means; without a zone it is UTC.

    Raises:
        ValueError: no such time.
    """
    try:
        when = datetime.fromisoformat(text)
        return when.replace(tzinfo=UTC) if when.tzinfo is None else when.astimezone(UTC)
    except (ValueError, OverflowError) as error:
        raise ValueError(f'A time reads like "2016-03-11T15:00:00" (UTC); got "{text}".') from error


def _chosen(items: tuple[Item, ...], index: int, noun: str, place: str) -> Item:
    if not 0 <= index < len(items):
        raise ValueError(
            f"There is no {noun} number {index} in {place}: {len(items)} found, counted from 0."
        )
    return items[index]
