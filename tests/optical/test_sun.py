from dataclasses import replace
from datetime import UTC, datetime, timedelta

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import brentq

from core.experiments.demo import DEMO_ORBIT, DEMO_STATION
from core.geometry.orbit import Station, line_of_sight_track, satellite_from_elements
from core.optical.sun import (
    ASTRONOMICAL_UNIT_M,
    EARTH_RADIUS_M,
    SUN_RADIUS_M,
    illumination,
    phase_angle_rad,
    sun_elevation_rad,
    sun_position_of_date,
    sunlit_fraction,
    track_illumination,
)

TT_LESS_UTC_S = 68.0


def utc(text):
    return datetime.fromisoformat(text).replace(tzinfo=UTC)


def right_ascension_and_declination_deg(julian_date):
    x, y, z = sun_position_of_date(np.array(julian_date)) / ASTRONOMICAL_UNIT_M
    return np.rad2deg(np.arctan2(y, x)) % 360, np.rad2deg(np.arctan2(z, np.hypot(x, y)))


@pytest.mark.parametrize(
    ("julian_date", "right_ascension_deg", "declination_deg", "distance_au"),
    [
        # Meeus, "Astronomical algorithms", 1998, example 25.b (by VSOP87): 1992 October 13, 0h TD.
        (2448908.5, 198.378124, -7.783817, 0.99760775),
        # Reda and Andreas, "Solar position algorithm", NREL 2008, table A5.1.
        (2452930.312847 + 67 / 86400, 202.22741, -9.31434, 0.99654230),
    ],
)
def test_the_sun_stands_where_published(
    julian_date, right_ascension_deg, declination_deg, distance_au
):
    found = right_ascension_and_declination_deg(julian_date)
    assert found == pytest.approx((right_ascension_deg, declination_deg), abs=0.01)
    distance = np.linalg.norm(sun_position_of_date(np.array(julian_date)))
    assert distance / ASTRONOMICAL_UNIT_M == pytest.approx(distance_au, abs=1e-4)


@pytest.mark.parametrize(
    ("when", "longitude_deg"),
    [
        ("2016-03-20T04:30", 0.0),
        ("2016-06-20T22:34", 90.0),
        ("2016-09-22T14:21", 180.0),
        ("2016-12-21T10:44", 270.0),
    ],
)
def test_seasons_begin_at_their_published_minutes(when, longitude_deg):
    """US Naval Observatory, "Earth's seasons", 2016; 0.01° are a quarter of an hour."""
    julian_date = (utc(when) - datetime(2000, 1, 1, 12, tzinfo=UTC)).total_seconds() / 86400
    julian_date += 2451545.0 + TT_LESS_UTC_S / 86400
    x, y, z = sun_position_of_date(np.array(julian_date))
    obliquity = np.deg2rad(23.437)
    along = np.arctan2(y * np.cos(obliquity) + z * np.sin(obliquity), x)
    off = (np.rad2deg(along) - longitude_deg + 180) % 360 - 180
    assert abs(off) < 0.01


def test_the_sun_stands_as_high_as_published():
    """Reda and Andreas, table A5.1: topocentric elevation without refraction in Golden."""
    golden = Station(latitude_deg=39.742476, longitude_deg=-105.1786, height_m=1830.14)
    (elevation,) = sun_elevation_rad(golden, [utc("2003-10-17T19:30:30")])
    assert np.rad2deg(elevation) == pytest.approx(39.872046, abs=0.01)


def test_a_date_beyond_the_series_is_refused():
    with pytest.raises(ValueError, match="1950 to 2050 only; got 2100"):
        sun_position_of_date(np.array([2488070.0]))


def test_the_demos_pass_lies_in_the_earths_shadow_and_a_dusk_pass_in_the_sun():
    satellite = satellite_from_elements(DEMO_ORBIT)
    night = [utc("2016-03-11T17:12:17") + timedelta(seconds=s) for s in range(0, 373, 30)]
    assert np.all(illumination(satellite, night).sunlit_fraction == 0)
    dusk = [utc("2016-03-24T10:56:11") + timedelta(seconds=s) for s in range(0, 382, 30)]
    light = illumination(satellite, dusk)
    assert np.all(light.sunlit_fraction == 1)
    assert np.linalg.norm(light.sun_direction, axis=1) == pytest.approx(np.ones(len(dusk)))
    # In the west the sun has just set at the station: it lights the satellite from behind and
    # hardly from above, as the satellite flies east.
    assert np.all(light.sun_direction[:, 0] < 0)
    assert np.all(np.abs(sun_elevation_rad(DEMO_STATION, dusk)) < np.deg2rad(7))


def test_at_noon_under_the_sun_it_stands_opposite_to_nadir():
    """Where the sun is in the zenith of the point below, it is at −z, and the Earth at +z."""
    satellite = satellite_from_elements(DEMO_ORBIT)
    times = [DEMO_ORBIT.epoch_utc + timedelta(seconds=20 * s) for s in range(280)]
    light = illumination(satellite, times)
    assert light.sun_direction[:, 2].min() < -0.8
    assert np.all(light.sunlit_fraction[light.sun_direction[:, 2] < 0] == 1)
    # Deep behind the Earth the sun stands beyond it, at +z.
    dark = light.sun_direction[light.sunlit_fraction == 0]
    assert len(dark) > 50
    assert np.all(
        dark[:, 2] > 0.9 * np.sqrt(1 - (EARTH_RADIUS_M / light.earth_distance_m.min()) ** 2)
    )


@given(height_km=st.floats(200, 40000), angle=st.floats(0, np.pi), turn=st.floats(0, 6.3))
def test_the_share_of_the_sun_is_that_of_points_spread_over_its_disc(height_km, angle, turn):
    position = (EARTH_RADIUS_M + 1e3 * height_km) * np.array([1.0, 0, 0])
    to_sun = ASTRONOMICAL_UNIT_M * np.array(
        [np.cos(angle), np.sin(angle) * np.cos(turn), np.sin(angle) * np.sin(turn)]
    )
    fraction = float(sunlit_fraction(position, to_sun))
    sun = np.arcsin(SUN_RADIUS_M / ASTRONOMICAL_UNIT_M)
    random = np.random.default_rng(1)
    disc = random.uniform(-sun, sun, (4000, 2))
    disc = disc[np.hypot(*disc.T) < sun]
    apart = np.hypot(np.pi - angle + disc[:, 0], disc[:, 1])
    free = np.mean(apart > np.arcsin(EARTH_RADIUS_M / np.linalg.norm(position)))
    # The Earth's limb is a little less curved on the sphere than on the plane: up to 1 %.
    assert fraction == pytest.approx(free, abs=0.05)
    assert -1e-9 <= fraction <= 1 + 1e-9


def test_shadow_begins_and_ends_with_the_limbs_touching():
    position = 1.06 * EARTH_RADIUS_M * np.array([1.0, 0, 0])
    sun, earth = np.arcsin(SUN_RADIUS_M / ASTRONOMICAL_UNIT_M), np.arcsin(1 / 1.06)

    def fraction(apart):
        to_sun = ASTRONOMICAL_UNIT_M * np.array([-np.cos(apart), np.sin(apart), 0])
        return float(sunlit_fraction(position, to_sun))

    assert fraction(earth - sun - 1e-6) == pytest.approx(0, abs=1e-9)
    assert fraction(earth + sun + 1e-6) == pytest.approx(1)
    half = brentq(lambda apart: fraction(apart) - 0.5, earth - sun, earth + sun)
    assert half == pytest.approx(earth, abs=0.01 * sun)


def test_the_phase_angle_is_nought_with_the_sun_behind_the_observer():
    ahead = np.array([[0.0, 1, 0]] * 3)
    sun = np.array([[0.0, -1, 0], [1, 0, 0], [0, 1, 0]])
    assert phase_angle_rad(ahead, sun) == pytest.approx([0, np.pi / 2, np.pi])


def test_a_track_knows_the_times_of_its_pulses():
    satellite = satellite_from_elements(DEMO_ORBIT)
    start = utc("2016-03-24T10:56:11")
    track = line_of_sight_track(
        satellite,
        DEMO_STATION,
        start_utc=start,
        duration_s=300.0,
        pulse_repetition_frequency_hz=1.0,
    )
    along = track_illumination(satellite, track, np.array([0.0, 200.0]))
    alone = illumination(satellite, [start, start + timedelta(seconds=200)])
    assert along.sun_direction == pytest.approx(alone.sun_direction)
    with pytest.raises(ValueError, match="no epoch"):
        track_illumination(satellite, replace(track, epoch_utc=""), np.array([0.0]))
