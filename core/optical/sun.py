"""Where the sun stands, whether it reaches the satellite, and whether the station has night."""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta

import numpy as np
from skyfield.api import EarthSatellite, load, wgs84
from skyfield.sgp4lib import TEME
from skyfield.timelib import Time

from core.arrays import Floats, frozen
from core.geometry.local_orbital_frame import lvlh_axes
from core.geometry.orbit import Station
from core.geometry.track import LineOfSightTrack

ASTRONOMICAL_UNIT_M = 149_597_870_700.0
"""IAU 2012 resolution B2."""

SUN_RADIUS_M = 6.957e8
"""IAU 2015 resolution B3, nominal."""

EARTH_RADIUS_M = 6_378_137.0
"""WGS 84, equatorial; the air's refraction and absorption are left out of the shadow."""

CIVIL_TWILIGHT_RAD = float(np.deg2rad(-6.0))
"""Below this elevation of the sun at the station the sky is dark enough for a telescope."""

_FIRST_YEAR, _LAST_YEAR = 1950, 2050
_TIMESCALE = load.timescale(builtin=True)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Illumination:
    """How the sun lights a satellite over time.

    Attributes:
        sun_direction: (times, 3) unit vectors from the target to the sun, in LVLH.
        sunlit_fraction: (times,) share of the sun's disc that the Earth leaves free; 0 in the
            umbra, where every picture is dark.
        earth_distance_m: (times,) from the geocentre to the target.
    """

    sun_direction: Floats
    sunlit_fraction: Floats
    earth_distance_m: Floats

    def __post_init__(self) -> None:
        sun = frozen(self.sun_direction, np.float64, (None, 3), "Sun directions")
        object.__setattr__(self, "sun_direction", sun)
        for name in ("sunlit_fraction", "earth_distance_m"):
            object.__setattr__(
                self, name, frozen(getattr(self, name), np.float64, (len(sun),), name)
            )


def sun_position_of_date(julian_date: Floats) -> Floats:
    """Return the sun's apparent geocentric position (…, 3) in metres, to 0.01° of direction.

    Axes: true equator and mean equinox of date to that precision, which is TEME.

    Args:
        julian_date: (…,) terrestrial time; universal time does as well.

    Raises:
        ValueError: a date outside 1950 to 2050, where the series is not that good.

    Source: The Astronomical Almanac, section C, "Low precision formulas for the Sun".
    """
    days = np.asarray(julian_date, dtype=np.float64) - 2451545.0
    years = 2000.0 + days / 365.25
    if not np.all((years >= _FIRST_YEAR) & (years <= _LAST_YEAR)):
        raise ValueError(
            f"The sun's position is good to 0.01° from {_FIRST_YEAR} to {_LAST_YEAR} only; got "
            f"{float(np.min(years)):.1f} to {float(np.max(years)):.1f}."
        )
    mean_longitude = np.deg2rad(280.460 + 0.9856474 * days)
    anomaly = np.deg2rad(357.528 + 0.9856003 * days)
    longitude = mean_longitude + np.deg2rad(1.915 * np.sin(anomaly) + 0.020 * np.sin(2 * anomaly))
    obliquity = np.deg2rad(23.439 - 0.0000004 * days)
    distance = ASTRONOMICAL_UNIT_M * (
        1.00014 - 0.01671 * np.cos(anomaly) - 0.00014 * np.cos(2 * anomaly)
    )
    unit = np.stack(
        [
            np.cos(longitude),
            np.cos(obliquity) * np.sin(longitude),
            np.sin(obliquity) * np.sin(longitude),
        ],
        axis=-1,
    )
    position: Floats = distance[..., None] * unit
    return position


def illumination(satellite: EarthSatellite, times_utc: Sequence[datetime]) -> Illumination:
    """Return how the sun lights an Earth-pointing satellite at some times, in its LVLH frame.

    Args:
        satellite: from `satellite_from_tle` or `satellite_from_elements`.
        times_utc: with a time zone.

    Raises:
        ValueError: a time outside 1950 to 2050, or to which the orbit cannot be propagated.
    """
    times = _TIMESCALE.from_datetimes(list(times_utc))
    state = satellite.at(times)
    position, velocity = state.position.m.T, state.velocity.m_per_s.T
    if not np.all(np.isfinite(position)):
        raise ValueError(
            f"The orbit of {satellite.name or 'the satellite'} cannot be propagated to "
            f"{times[0].utc_iso()}: its elements are too old or it has decayed."
        )
    to_sun = _sun_inertial(times) - position
    direction = to_sun / np.linalg.norm(to_sun, axis=1, keepdims=True)
    return Illumination(
        sun_direction=np.einsum("nij,nj->ni", lvlh_axes(position, velocity), direction),
        sunlit_fraction=sunlit_fraction(position, to_sun),
        earth_distance_m=np.linalg.norm(position, axis=1),
    )


def track_illumination(
    satellite: EarthSatellite, track: LineOfSightTrack, time_s: Floats
) -> Illumination:
    """Return how the sun lights a satellite at times (moments,) of a track, in its LVLH frame.

    Raises:
        ValueError: a track without an epoch, or what `illumination` refuses.
    """
    if not track.epoch_utc:
        raise ValueError(
            "The track has no epoch, so the sun's direction is unknown; use a track of an orbit."
        )
    epoch = datetime.fromisoformat(track.epoch_utc)
    return illumination(satellite, [epoch + timedelta(seconds=float(s)) for s in time_s])


def sunlit_fraction(position_m: Floats, to_sun_m: Floats) -> Floats:
    """Return the share (…,) of the sun's disc that the Earth leaves free, 0 in the umbra.

    Args:
        position_m: (…, 3) from the geocentre to the satellite.
        to_sun_m: (…, 3) from the satellite to the sun.

    Source: Montenbruck and Gill, "Satellite orbits", 2000, section 3.4.2: a conical shadow.
    """
    radius = np.linalg.norm(position_m, axis=-1)
    distance = np.linalg.norm(to_sun_m, axis=-1)
    sun = np.arcsin(SUN_RADIUS_M / distance)
    earth = np.arcsin(np.minimum(EARTH_RADIUS_M / radius, 1.0))
    cosine = -np.sum(position_m * to_sun_m, axis=-1) / (radius * distance)
    apart = np.arccos(np.clip(cosine, -1.0, 1.0))
    fraction: Floats = 1 - _overlap(sun, earth, apart) / (np.pi * sun**2)
    return fraction


def sun_elevation_rad(station: Station, times_utc: Sequence[datetime]) -> Floats:
    """Return the sun's elevation (times,) above a station's horizon, without refraction."""
    times = _TIMESCALE.from_datetimes(list(times_utc))
    place = wgs84.latlon(station.latitude_deg, station.longitude_deg, station.height_m).at(times)
    position = place.position.m.T
    to_sun = _sun_inertial(times) - position
    # The ellipsoid's normal is the third axis of the station's own frame, seen from space.
    up = np.moveaxis(place.target.rotation_at(times), -1, 0)[:, 2]
    sine = np.sum(up * to_sun, axis=1) / np.linalg.norm(to_sun, axis=1)
    elevation: Floats = np.arcsin(sine)
    return elevation


def phase_angle_rad(line_of_sight: Floats, sun_direction: Floats) -> Floats:
    """Return the angle (…,) at the target between sun and observer, 0 with the sun behind him.

    Args:
        line_of_sight: (…, 3) unit vectors from sensor to target.
        sun_direction: (…, 3) unit vectors from target to sun.
    """
    cosine = -np.sum(np.asarray(line_of_sight) * np.asarray(sun_direction), axis=-1)
    angle: Floats = np.arccos(np.clip(cosine, -1.0, 1.0))
    return angle


def _sun_inertial(times: Time) -> Floats:
    """Return the sun's geocentric position (times, 3) in metres, GCRS as skyfield's states."""
    to_teme = np.moveaxis(TEME.rotation_at(times), -1, 0)
    position: Floats = np.einsum("nji,nj->ni", to_teme, sun_position_of_date(times.tt))
    return position


def _overlap(sun: Floats, earth: Floats, apart: Floats) -> Floats:
    """Return the area shared by two discs of these radii, in the small angles' square."""
    apart = np.maximum(apart, 1e-12)
    sun_part = np.clip((apart**2 + sun**2 - earth**2) / (2 * apart * sun), -1.0, 1.0)
    earth_part = np.clip((apart**2 + earth**2 - sun**2) / (2 * apart * earth), -1.0, 1.0)
    kite = (sun + earth - apart) * (apart + sun - earth) * (apart - sun + earth)
    lens = 0.5 * np.sqrt(np.maximum(kite * (apart + sun + earth), 0.0))
    area: Floats = sun**2 * np.arccos(sun_part) + earth**2 * np.arccos(earth_part) - lens
    return area
