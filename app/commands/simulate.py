"""`radarhull simulate`."""

from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, TypeVar

import numpy as np
import tyro
from skyfield.api import EarthSatellite

from app.commands.console import progress_bars
from core.experiments.demo import DEMO_ORBIT, DEMO_STATION
from core.formats.element_sets import read_element_sets
from core.formats.meshes import read_mesh
from core.formats.pass_file import RecordedPass, write_pass
from core.geometry.orbit import (
    Station,
    line_of_sight_track,
    passes,
    satellite_from_elements,
    satellite_from_tle,
)
from core.geometry.track import LineOfSightTrack
from core.radar.echoes import simulate_echoes
from core.radar.scatterers import surface_scatterers
from core.radar.targets import Target, tiangong_like
from core.radar.waveform import Waveform

Item = TypeVar("Item")

SEARCH_DAYS = 2


@dataclass(frozen=True)
class Observation:
    """Which pass of which orbit over which station."""

    tle: Path | None = None
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


@dataclass(frozen=True)
class Radar:
    """What the radar sends."""

    carrier_hz: float = 16.7e9
    """Centre frequency, hertz."""
    bandwidth_hz: float = 1.0e9
    """Bandwidth, hertz."""
    prf_hz: float = 100.0
    """Pulses per second."""
    snr_db: float = 20.0
    """Mean echo power over noise power, per pulse and frequency sample, decibels."""


def simulate(
    out: Annotated[Path, tyro.conf.Positional],
    /,
    *,
    mesh: Path | None = None,
    mesh_unit_m: float = 1.0,
    observation: Annotated[Observation, tyro.conf.arg(name="")] = Observation(),
    radar: Annotated[Radar, tyro.conf.arg(name="")] = Radar(),
    scatterers: int = 60_000,
    seed: int = 1,
) -> None:
    """Simulate the echoes of one pass of a self-shadowing target and write a pass file.

    Args:
        out: pass file to write (.h5).
        mesh: target as GLB, PLY, OBJ or STL; without one, a Tiangong-1-like laboratory.
        mesh_unit_m: metres per unit of the mesh file.
        observation: which pass of which orbit over which station.
        radar: what the radar sends.
        scatterers: points on the target's surface.
        seed: of the random generator.
    """
    random = np.random.default_rng(seed)
    target = tiangong_like() if mesh is None else _mesh_target(mesh, mesh_unit_m)
    waveform = Waveform(
        carrier_frequency_hz=radar.carrier_hz,
        bandwidth_hz=radar.bandwidth_hz,
        pulse_repetition_frequency_hz=radar.prf_hz,
    )
    track = pass_track(observation, radar.prf_hz)
    points = surface_scatterers(target, count=scatterers, random=random)
    with progress_bars() as report:
        history = simulate_echoes(
            points,
            track,
            waveform,
            signal_to_noise_db=radar.snr_db,
            random=random,
            progress=lambda done, total: report("pulses", done, total),
        )
    write_pass(out, RecordedPass(history=history))
    print(f"{out}: {len(track)} pulses of {target.name} from {track.epoch_utc} on.")


def pass_track(observation: Observation, pulse_repetition_frequency_hz: float) -> LineOfSightTrack:
    """Return the line of sight along the chosen pass.

    Raises:
        ValueError: no such element set, time or pass.
    """
    station = Station(
        latitude_deg=observation.latitude_deg,
        longitude_deg=observation.longitude_deg,
        height_m=observation.height_m,
    )
    satellite = _satellite(observation)
    found = passes(
        satellite,
        station,
        start_utc=_utc(observation.start),
        duration_s=SEARCH_DAYS * 86400.0,
        elevation_mask_rad=float(np.deg2rad(observation.mask_deg)),
    )
    each = _chosen(
        found, observation.pass_index, "pass", f"the {SEARCH_DAYS} days from {observation.start}"
    )
    return line_of_sight_track(
        satellite,
        station,
        start_utc=each.rise_utc,
        duration_s=each.duration_s,
        pulse_repetition_frequency_hz=pulse_repetition_frequency_hz,
    )


def _mesh_target(path: Path, unit_m: float) -> Target:
    return Target(name=path.stem, parts=(read_mesh(path, unit_m=unit_m),))


def _satellite(observation: Observation) -> EarthSatellite:
    if observation.tle is None:
        return satellite_from_elements(DEMO_ORBIT)
    sets = read_element_sets(observation.tle)
    return satellite_from_tle(
        *_chosen(sets, observation.tle_index, "element set", str(observation.tle))
    )


def _utc(text: str) -> datetime:
    try:
        when = datetime.fromisoformat(text)
    except ValueError as error:
        raise ValueError(f'A time reads like "2016-03-11T15:00:00" (UTC); got "{text}".') from error
    return when.replace(tzinfo=UTC) if when.tzinfo is None else when.astimezone(UTC)


def _chosen(items: tuple[Item, ...], index: int, noun: str, place: str) -> Item:
    if not 0 <= index < len(items):
        raise ValueError(
            f"There is no {noun} number {index} in {place}: {len(items)} found, counted from 0."
        )
    return items[index]
