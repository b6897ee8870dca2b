"""`radarhull simulate`."""

from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, TypeVar

import numpy as np
import tyro
from skyfield.api import EarthSatellite

from app.commands.console import progress_bars
from app.commands.echo_options import DEFAULT_ERRORS, DEFAULT_SURFACE, Errors, Surface
from app.commands.options import (
    Gigahertz,
    JsonTo,
    OptionalFile,
    OutputFile,
    checked_seed,
    checked_snr_db,
)
from app.commands.outputs import checked_json, checked_pass, echo_facts, show_summary
from core.experiments.demo import DEMO_ORBIT, DEMO_STATION
from core.formats.element_sets import read_element_sets
from core.formats.meshes import read_mesh
from core.formats.pass_file import RecordedPass, write_pass
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
from core.radar.echoes import ScatteringModel, simulate_echoes
from core.radar.phase_history import PhaseHistory
from core.radar.pulse_errors import with_pulse_errors
from core.radar.waveform import Waveform
from core.targets import Target, tiangong_like

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


@dataclass(frozen=True)
class Radar:
    """What the radar sends."""

    carrier_hz: Gigahertz = 16.7e9
    """Centre frequency, hertz."""
    bandwidth_hz: Gigahertz = 1.0e9
    """Bandwidth, hertz."""
    frequency_count: int = 256
    """Frequency samples across the band; more of them tell a larger target apart in range."""
    prf_hz: float = 100.0
    """Pulses per second."""
    snr_db: float = 20.0
    """Mean echo power over noise power, per pulse and frequency sample, decibels."""

    def waveform(self) -> Waveform:
        """Return what these options mean.

        Raises:
            ValueError: a frequency that is not positive, or too few samples.
        """
        return Waveform(
            carrier_frequency_hz=self.carrier_hz,
            bandwidth_hz=self.bandwidth_hz,
            pulse_repetition_frequency_hz=self.prf_hz,
            frequency_count=self.frequency_count,
        )


def simulate(
    out: OutputFile,
    /,
    *,
    mesh: OptionalFile = None,
    mesh_unit_m: float = 1.0,
    observation: Annotated[Observation, tyro.conf.arg(name="")] = Observation(),
    radar: Annotated[Radar, tyro.conf.arg(name="")] = Radar(),
    surface: Annotated[Surface, tyro.conf.arg(name="")] = DEFAULT_SURFACE,
    errors: Annotated[Errors, tyro.conf.arg(name="")] = DEFAULT_ERRORS,
    seed: int = 1,
    json: JsonTo = None,
) -> None:
    """Simulate the echoes of one pass of a self-shadowing target and write a pass file.

    Args:
        out: pass file to write (.h5).
        mesh: target as GLB, PLY, OBJ or STL; without one, a Tiangong-1-like laboratory.
        mesh_unit_m: metres per unit of the mesh file.
        observation: which pass of which orbit over which station.
        radar: what the radar sends.
        surface: how the target's surface scatters.
        errors: what goes wrong from pulse to pulse.
        seed: of the random generator.
        json: write a summary as JSON to this file, or to standard output for "-".
    """
    checked_pass(out)
    checked_json(json)
    checked_snr_db(radar.snr_db)
    checked_seed(seed)
    disturbance = errors.pulse_errors()
    random = np.random.default_rng(seed)
    target = tiangong_like() if mesh is None else _mesh_target(mesh, mesh_unit_m)
    scattering = surface.scattering(target, random)
    track = pass_track(observation, radar.waveform())
    received = _echoes(scattering, track, radar, random)
    # Errors are drawn last, so that the same seed gives the same echoes with and without them.
    history, _ = with_pulse_errors(received, disturbance, random)
    write_pass(out, RecordedPass(history=history))
    show_summary(
        f"{out}: {len(track)} pulses of {target.name} from {track.epoch_utc} on.",
        {
            "file": str(out),
            "target": target.name,
            "seed": seed,
            **asdict(surface),
            **asdict(errors),
            **echo_facts(history),
        },
        json,
    )


def _echoes(
    scattering: ScatteringModel,
    track: LineOfSightTrack,
    radar: Radar,
    random: np.random.Generator,
) -> PhaseHistory:
    with progress_bars() as report:
        return simulate_echoes(
            scattering,
            track,
            radar.waveform(),
            signal_to_noise_db=radar.snr_db,
            random=random,
            progress=lambda done, total: report("pulses", done, total),
        )


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
        return when.replace(tzinfo=UTC) if when.tzinfo is None else when.astimezone(UTC)
    except (ValueError, OverflowError) as error:
        raise ValueError(f'A time reads like "2016-03-11T15:00:00" (UTC); got "{text}".') from error


def _chosen(items: tuple[Item, ...], index: int, noun: str, place: str) -> Item:
    if not 0 <= index < len(items):
        raise ValueError(
            f"There is no {noun} number {index} in {place}: {len(items)} found, counted from 0."
        )
    return items[index]
