"""From an orbit and a station to passes and their lines of sight."""

from dataclasses import dataclass
from datetime import UTC, datetime, timedelta

import numpy as np
from scipy.interpolate import CubicSpline
from sgp4.api import WGS72, Satrec
from skyfield.api import EarthSatellite, load, wgs84
from skyfield.timelib import Time

from core.arrays import Floats
from core.geometry.local_orbital_frame import lvlh_axes
from core.geometry.track import LineOfSightTrack

KNOT_INTERVAL_S = 1.0
"""Orbits are computed once a second; a cubic spline between is good to 10⁻⁹ rad."""

MAX_HEIGHT_M = 100e3

FIRST_YEAR, LAST_YEAR = 1957, 2056
"""Of element sets, whose epochs give two digits of the year, from Sputnik on."""

_TIMESCALE = load.timescale(builtin=True)


@dataclass(frozen=True, slots=True, kw_only=True)
class Station:
    """A radar on the ground.

    Attributes:
        latitude_deg, longitude_deg: geodetic, WGS 84, north and east positive.
        height_m: above the ellipsoid.
        name: what a person calls it.
    """

    latitude_deg: float
    longitude_deg: float
    height_m: float
    name: str = "station"

    def __post_init__(self) -> None:
        if not (abs(self.latitude_deg) <= 90 and abs(self.longitude_deg) <= 360):
            raise ValueError(
                "A station needs a latitude within ±90° and a longitude within ±360°; got "
                f"{self.latitude_deg} and {self.longitude_deg}."
            )
        if not abs(self.height_m) <= MAX_HEIGHT_M:
            raise ValueError(
                "A station stands within ±100 km of the ellipsoid; got a height of "
                f"{self.height_m} m."
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class Pass:
    """A stretch of time in which a satellite stands above a station's elevation mask.

    Attributes:
        rise_utc, set_utc: when it crosses the mask.
        highest_elevation_rad: at its culmination.
    """

    rise_utc: datetime
    set_utc: datetime
    highest_elevation_rad: float

    @property
    def duration_s(self) -> float:
        """Seconds from rise to set."""
        return (self.set_utc - self.rise_utc).total_seconds()


def satellite_from_tle(line_1: str, line_2: str, name: str = "") -> EarthSatellite:
    """Return the satellite of a two-line element set.

    Raises:
        ValueError: a line of the wrong length or number, a wrong checksum, or two lines of
            different satellites.
    """
    lines = (line_1.rstrip(), line_2.rstrip())
    for number, line in enumerate(lines, start=1):
        if len(line) != 69 or not line.startswith(f"{number} "):
            raise ValueError(
                f"Line {number} of an element set has 69 characters and begins with "
                f'"{number} "; got {len(line)} characters: "{line[:24]}…".'
            )
        wanted = tle_checksum(line)
        if line[68] != str(wanted):
            raise ValueError(
                f"Line {number} of the element set has checksum {line[68]}, but its characters "
                f"add up to {wanted}; the line is damaged, fetch it again."
            )
    if lines[0][2:7] != lines[1][2:7]:
        raise ValueError(
            f"The two lines belong to different satellites, {lines[0][2:7]} and {lines[1][2:7]}."
        )
    return EarthSatellite(*lines, name, _TIMESCALE)


def tle_checksum(line: str) -> int:
    """Return the checksum of an element set's line: its digits, minus signs as 1, modulo 10."""
    return sum(int(c) if c.isdigit() else c == "-" for c in line[:68]) % 10


@dataclass(frozen=True, slots=True, kw_only=True)
class MeanElements:
    """SGP4 mean elements as plain numbers, for orbits that do not come from a file.

    Attributes:
        epoch_utc: of the elements.
        inclination_deg, node_deg, argument_of_perigee_deg, mean_anomaly_deg: TEME.
        eccentricity: without unit.
        mean_motion_rev_per_day: Kozai's.
        drag_per_earth_radius: SGP4's B*.
        name: what a person calls the satellite.
    """

    epoch_utc: datetime
    inclination_deg: float
    node_deg: float
    eccentricity: float
    argument_of_perigee_deg: float
    mean_anomaly_deg: float
    mean_motion_rev_per_day: float
    drag_per_earth_radius: float = 0.0
    name: str = "satellite"


def satellite_from_elements(elements: MeanElements) -> EarthSatellite:
    """Return the satellite of mean elements."""
    record = Satrec()
    since_1949 = elements.epoch_utc - datetime(1949, 12, 31, tzinfo=UTC)
    record.sgp4init(
        WGS72,
        "i",
        0,
        since_1949 / timedelta(days=1),
        elements.drag_per_earth_radius,
        0.0,
        0.0,
        elements.eccentricity,
        np.deg2rad(elements.argument_of_perigee_deg),
        np.deg2rad(elements.inclination_deg),
        np.deg2rad(elements.mean_anomaly_deg),
        elements.mean_motion_rev_per_day * 2 * np.pi / 1440.0,
        np.deg2rad(elements.node_deg),
    )
    satellite = EarthSatellite.from_satrec(record, _TIMESCALE)
    satellite.name = elements.name
    return satellite


def passes(
    satellite: EarthSatellite,
    station: Station,
    *,
    start_utc: datetime,
    duration_s: float,
    elevation_mask_rad: float,
) -> tuple[Pass, ...]:
    """Return the whole passes of a satellite over a station in a stretch of time.

    Raises:
        ValueError: the orbit has decayed, the mask is not below the zenith, or the time is not
            of the space age.
    """
    if not FIRST_YEAR <= start_utc.year <= LAST_YEAR:
        raise ValueError(
            f"Passes are searched from {FIRST_YEAR} to {LAST_YEAR}, the years that element sets "
            f"can name; got {start_utc.year}."
        )
    if not 0 <= elevation_mask_rad < np.pi / 2:
        raise ValueError(
            "The elevation mask lies between the horizon and the zenith, 0° to below 90°; got "
            f"{np.rad2deg(elevation_mask_rad):g}°."
        )
    begin = _TIMESCALE.from_datetime(start_utc)
    end = _TIMESCALE.from_datetime(start_utc + timedelta(seconds=duration_s))
    place = wgs84.latlon(station.latitude_deg, station.longitude_deg, station.height_m)
    times, events = satellite.find_events(
        place, begin, end, altitude_degrees=float(np.rad2deg(elevation_mask_rad))
    )
    found = []
    for index in range(len(events) - 2):
        if list(events[index : index + 3]) == [0, 1, 2]:
            altitude, _, _ = (satellite - place).at(times[index + 1]).altaz()
            found.append(
                Pass(
                    rise_utc=times[index].utc_datetime(),
                    set_utc=times[index + 2].utc_datetime(),
                    highest_elevation_rad=float(altitude.radians),
                )
            )
    return tuple(found)


def line_of_sight_track(
    satellite: EarthSatellite,
    station: Station,
    *,
    start_utc: datetime,
    duration_s: float,
    pulse_repetition_frequency_hz: float,
) -> LineOfSightTrack:
    """Return the line of sight to an Earth-pointing satellite at every pulse, in LVLH.

    Args:
        satellite: from `satellite_from_tle` or `satellite_from_elements`.
        station: the radar.
        start_utc: time of the first pulse.
        duration_s: until the last pulse.
        pulse_repetition_frequency_hz: pulses per second.

    Raises:
        ValueError: fewer than two pulses, or the orbit cannot be propagated that far.
    """
    pulses = int(np.floor(duration_s * pulse_repetition_frequency_hz)) + 1
    if pulses < 2:
        raise ValueError(
            f"{duration_s:g} s at {pulse_repetition_frequency_hz:g} pulses per second hold "
            f"{pulses} pulse; at least 2 are needed."
        )
    time_s = np.arange(pulses) / pulse_repetition_frequency_hz
    return _track(satellite, station, start_utc, time_s, (0.0, duration_s), in_lvlh=True)


def inertial_track(
    satellite: EarthSatellite, station: Station, *, epoch_utc: datetime, time_s: Floats
) -> LineOfSightTrack:
    """Return the line of sight to a satellite at chosen times in inertial axes (GCRS).

    For a target that does not keep the local orbital frame: `core.geometry.spin` turns the
    track into the frame of a spinning one.

    Args:
        satellite: from `satellite_from_tle` or `satellite_from_elements`.
        station: the radar.
        epoch_utc: time 0.
        time_s: (pulses,) since then, growing; negative before it.

    Raises:
        ValueError: fewer than two times or times that do not grow, or the orbit cannot be
            propagated to them.
    """
    times = np.asarray(time_s, dtype=np.float64)
    if times.size < 2:
        raise ValueError(f"A track needs at least 2 times, got {times.size}.")
    span_s = (float(times[0]), float(times[-1]))
    return _track(satellite, station, epoch_utc, times, span_s, in_lvlh=False)


def _track(
    satellite: EarthSatellite,
    station: Station,
    epoch_utc: datetime,
    time_s: Floats,
    span_s: tuple[float, float],
    *,
    in_lvlh: bool,
) -> LineOfSightTrack:
    """Return the track at times (pulses,) by a spline through knots over a span around them."""
    knots = max(8, int(np.ceil((span_s[1] - span_s[0]) / KNOT_INTERVAL_S)) + 1)
    knot_s = np.linspace(*span_s, knots)
    base = _TIMESCALE.from_datetime(epoch_utc)
    times = _TIMESCALE.tt_jd(base.whole, base.tt_fraction + knot_s / 86400.0)
    baseline, azimuth, elevation = _topocentric(satellite, station, times, in_lvlh=in_lvlh)
    spline = CubicSpline(knot_s, baseline)
    vector, velocity = spline(time_s), spline(time_s, 1)
    distance = np.linalg.norm(vector, axis=1, keepdims=True)
    unit = vector / distance
    rate = (velocity - unit * np.sum(unit * velocity, axis=1, keepdims=True)) / distance
    return LineOfSightTrack(
        time_s=time_s,
        line_of_sight=unit,
        line_of_sight_rate_per_s=rate,
        range_m=distance[:, 0],
        azimuth_rad=CubicSpline(knot_s, np.unwrap(azimuth))(time_s),
        elevation_rad=CubicSpline(knot_s, elevation)(time_s),
        epoch_utc=epoch_utc.astimezone(UTC).isoformat().replace("+00:00", "Z"),
    )


def _topocentric(
    satellite: EarthSatellite, station: Station, times: Time, *, in_lvlh: bool
) -> tuple[Floats, Floats, Floats]:
    """Return station-to-satellite vectors (n, 3), azimuth and elevation (n,).

    The vectors are in LVLH metres, or in GCRS ones.
    """
    place = wgs84.latlon(station.latitude_deg, station.longitude_deg, station.height_m)
    state = satellite.at(times)
    position, velocity = state.position.m.T, state.velocity.m_per_s.T
    if not np.all(np.isfinite(position)):
        raise ValueError(
            f"The orbit of {satellite.name or 'the satellite'} cannot be propagated to "
            f"{times[0].utc_iso()}: its elements are too old or it has decayed."
        )
    difference = (satellite - place).at(times)
    baseline = difference.position.m.T
    if in_lvlh:
        baseline = np.einsum("nij,nj->ni", lvlh_axes(position, velocity), baseline)
    altitude, azimuth, _ = difference.altaz()
    return baseline, np.asarray(azimuth.radians), np.asarray(altitude.radians)
