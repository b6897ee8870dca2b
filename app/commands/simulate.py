"""`radarhull simulate`."""

from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated

import numpy as np
import tyro

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


def simulate(
    out: Annotated[Path, tyro.conf.Positional],
    /,
    *,
    mesh: Path | None = None,
    mesh_unit_m: float = 1.0,
    tle: Path | None = None,
    tle_index: int = 0,
    latitude_deg: float = DEMO_STATION.latitude_deg,
    longitude_deg: float = DEMO_STATION.longitude_deg,
    height_m: float = DEMO_STATION.height_m,
    start: str = "2016-03-11T15:00:00",
    pass_index: int = 0,
    mask_deg: float = 10.0,
    carrier_hz: float = 16.7e9,
    bandwidth_hz: float = 1.0e9,
    prf_hz: float = 100.0,
    snr_db: float = 20.0,
    scatterers: int = 60_000,
    seed: int = 1,
) -> None:
    """Simulate the echoes of one pass of a self-shadowing target and write a pass file.

    Args:
        out: pass file to write (.h5).
        mesh: target as GLB, PLY, OBJ or STL; without one, a Tiangong-1-like laboratory.
        mesh_unit_m: metres per unit of the mesh file.
        tle: file of two-line element sets; without one, Tiangong-1's orbit of March 2016.
        tle_index: which set of the file, from 0.
        latitude_deg: of the station, degrees north.
        longitude_deg: of the station, degrees east.
        height_m: of the station above the WGS 84 ellipsoid, metres.
        start: look for passes in the two days from this UTC time on.
        pass_index: which of those passes, from 0.
        mask_deg: elevation mask, degrees.
        carrier_hz: centre frequency, hertz.
        bandwidth_hz: bandwidth, hertz.
        prf_hz: pulses per second.
        snr_db: signal-to-noise ratio per pulse and frequency sample, decibels.
        scatterers: points on the target's surface.
        seed: of the random generator.
    """
    random = np.random.default_rng(seed)
    waveform = Waveform(
        carrier_frequency_hz=carrier_hz,
        bandwidth_hz=bandwidth_hz,
        pulse_repetition_frequency_hz=prf_hz,
    )
    target = tiangong_like() if mesh is None else _mesh_target(mesh, mesh_unit_m)
    station = Station(latitude_deg=latitude_deg, longitude_deg=longitude_deg, height_m=height_m)
    track = _pass_track(tle, tle_index, station, start, pass_index, mask_deg, prf_hz)
    points = surface_scatterers(target, count=scatterers, random=random)
    with progress_bars() as report:
        history = simulate_echoes(
            points,
            track,
            waveform,
            signal_to_noise_db=snr_db,
            random=random,
            progress=lambda done, total: report("echoes", done, total),
        )
    write_pass(out, RecordedPass(history=history))
    print(f"{out}: {len(track)} pulses of {target.name} from {track.epoch_utc}.")


def _mesh_target(path: Path, unit_m: float) -> Target:
    return Target(name=path.stem, parts=(read_mesh(path, unit_m=unit_m),))


def _pass_track(
    tle: Path | None,
    tle_index: int,
    station: Station,
    start: str,
    pass_index: int,
    mask_deg: float,
    prf_hz: float,
) -> LineOfSightTrack:
    satellite = (
        satellite_from_elements(DEMO_ORBIT)
        if tle is None
        else satellite_from_tle(*_chosen(read_element_sets(tle), tle_index, "element set", str(tle)))
    )
    found = passes(
        satellite,
        station,
        start_utc=_utc(start),
        duration_s=2 * 86400.0,
        elevation_mask_rad=float(np.deg2rad(mask_deg)),
    )
    each = _chosen(found, pass_index, "pass", f"the two days from {start}")
    return line_of_sight_track(
        satellite,
        station,
        start_utc=each.rise_utc,
        duration_s=each.duration_s,
        pulse_repetition_frequency_hz=prf_hz,
    )


def _utc(text: str) -> datetime:
    try:
        when = datetime.fromisoformat(text)
    except ValueError as error:
        raise ValueError(
            f'A time reads like "2016-03-11T15:00:00" (UTC); got "{text}".'
        ) from error
    return when.replace(tzinfo=UTC) if when.tzinfo is None else when.astimezone(UTC)


def _chosen(items: tuple[Item, ...], index: int, noun: str, place: str) -> Item:
    if not 0 <= index < len(items):
        raise ValueError(
            f"There is no {noun} number {index} in {place}: {len(items)} found, counted from 0."
        )
    return items[index]
