from datetime import UTC, datetime, timedelta

import numpy as np
import pytest
from skyfield.api import load

from core.experiments.demo import DEMO_ORBIT
from core.formats.element_sets import read_element_sets
from core.geometry.local_orbital_frame import lvlh_axes
from core.geometry.orbit import (
    Station,
    inertial_track,
    line_of_sight_track,
    passes,
    satellite_from_elements,
    satellite_from_tle,
    tle_checksum,
)

BEIJING = Station(latitude_deg=39.9, longitude_deg=116.4, height_m=88.0)


@pytest.fixture(scope="module")
def demo_track():
    satellite = satellite_from_elements(DEMO_ORBIT)
    found = passes(
        satellite,
        BEIJING,
        start_utc=datetime(2016, 3, 11, 17, tzinfo=UTC),
        duration_s=3600.0,
        elevation_mask_rad=np.deg2rad(10),
    )
    return line_of_sight_track(
        satellite,
        BEIJING,
        start_utc=found[0].rise_utc,
        duration_s=found[0].duration_s,
        pulse_repetition_frequency_hz=10.0,
    )


def test_the_published_pass_over_beijing_has_the_stated_spans(shared_data):
    sets = read_element_sets(shared_data("tiangong1") / "tiangong1.tle")
    satellite = satellite_from_tle(*sets[1])
    found = passes(
        satellite,
        BEIJING,
        start_utc=datetime(2016, 3, 11, 17, tzinfo=UTC),
        duration_s=3600.0,
        elevation_mask_rad=np.deg2rad(10),
    )
    assert found[0].rise_utc.isoformat().startswith("2016-03-11T17:12:17")
    assert found[0].duration_s == pytest.approx(373, abs=0.5)
    track = line_of_sight_track(
        satellite,
        BEIJING,
        start_utc=found[0].rise_utc,
        duration_s=found[0].duration_s,
        pulse_repetition_frequency_hz=10.0,
    )
    assert np.rad2deg(np.ptp(track.azimuth_rad)) == pytest.approx(160.5, abs=0.05)
    assert np.rad2deg(np.ptp(track.elevation_rad)) == pytest.approx(46.6, abs=0.05)
    assert track.range_m.min() / 1000 == pytest.approx(455, abs=0.5)


def test_demo_elements_are_the_published_ones(shared_data):
    lines = read_element_sets(shared_data("tiangong1") / "tiangong1.tle")[1]
    when = datetime(2016, 3, 12, tzinfo=UTC)
    from_file, from_numbers = satellite_from_tle(*lines), satellite_from_elements(DEMO_ORBIT)
    time = passes_time(when)
    difference = from_file.at(time).position.m - from_numbers.at(time).position.m
    assert np.linalg.norm(difference) < 1.0


def passes_time(when):
    from core.geometry.orbit import _TIMESCALE

    return _TIMESCALE.from_datetime(when)


def test_rate_is_the_finite_difference_and_perpendicular(demo_track):
    numeric = np.gradient(demo_track.line_of_sight, demo_track.time_s, axis=0)
    assert np.abs(numeric - demo_track.line_of_sight_rate_per_s)[2:-2].max() < 2e-7
    radial = np.sum(demo_track.line_of_sight * demo_track.line_of_sight_rate_per_s, axis=1)
    assert np.abs(radial).max() < 1e-12


def test_doppler_is_the_finite_difference_of_range(demo_track):
    """A point's range changes as k·p does: f_d = −(2/λ) dR/dt with dR/dt = dk/dt·p."""
    point = np.array([3.0, -4.0, 5.0])
    antenna = -demo_track.range_m[:, None] * demo_track.line_of_sight
    differential = np.linalg.norm(point - antenna, axis=1) - demo_track.range_m
    numeric = np.gradient(differential, demo_track.time_s)
    analytic = demo_track.line_of_sight_rate_per_s @ point
    # Wavefront curvature at 455 km leaves |p|²/2R, less than 0.1 mm of range.
    assert np.abs(numeric - analytic)[2:-2].max() < 1e-5


def test_the_satellite_flies_along_x_above_the_station(demo_track):
    """At first the station lies ahead (+x) and always below (+z): k points back and up."""
    first, last = demo_track.line_of_sight[0], demo_track.line_of_sight[-1]
    assert first[0] < -0.8
    assert last[0] > 0.8
    assert np.all(demo_track.line_of_sight[:, 2] < -0.3)


def test_an_inertial_track_is_the_lvlh_one_before_its_frame_is_turned(demo_track):
    satellite = satellite_from_elements(DEMO_ORBIT)
    epoch_utc = datetime.fromisoformat(demo_track.epoch_utc) + timedelta(seconds=100)
    chosen = slice(900, 1101, 50)
    time_s = demo_track.time_s[chosen] - 100
    track = inertial_track(satellite, BEIJING, epoch_utc=epoch_utc, time_s=time_s)
    assert track.time_s[0] == pytest.approx(-10)
    assert track.range_m == pytest.approx(demo_track.range_m[chosen], abs=0.1)
    assert track.elevation_rad == pytest.approx(demo_track.elevation_rad[chosen], abs=1e-6)
    state = satellite.at(load.timescale(builtin=True).from_datetime(epoch_utc))
    axes = lvlh_axes(state.position.m, state.velocity.m_per_s)
    assert axes @ track.line_of_sight[2] == pytest.approx(
        demo_track.line_of_sight[chosen][2], abs=1e-6
    )


def test_an_inertial_rate_is_the_finite_difference():
    satellite = satellite_from_elements(DEMO_ORBIT)
    epoch_utc, time_s = datetime(2016, 3, 11, 17, 15, tzinfo=UTC), np.array([-0.1, 0.0, 0.1])
    track = inertial_track(satellite, BEIJING, epoch_utc=epoch_utc, time_s=time_s)
    sight, rate = track.line_of_sight, track.line_of_sight_rate_per_s
    assert rate[1] == pytest.approx((sight[2] - sight[0]) / 0.2, abs=1e-7)


def test_an_inertial_track_of_one_time_is_refused():
    with pytest.raises(ValueError, match="at least 2 times, got 1"):
        inertial_track(
            satellite_from_elements(DEMO_ORBIT),
            BEIJING,
            epoch_utc=datetime(2016, 3, 11, 17, tzinfo=UTC),
            time_s=np.zeros(1),
        )


def test_a_wrong_checksum_is_refused():
    line_1 = "1 37820U 11053A   16071.47512016  .00017711  00000-0  21761-3 0  9997"
    line_2 = "2 37820  42.7628 110.5320 0009524  97.7639  50.1243 15.59909646255308"
    with pytest.raises(ValueError, match="checksum 7, but its characters add up to 8"):
        satellite_from_tle(line_1, line_2)
    assert tle_checksum(line_2) == 8


def test_a_short_line_is_refused():
    with pytest.raises(ValueError, match="has 69 characters"):
        satellite_from_tle("1 37820U", "2 37820")


@pytest.mark.parametrize("height_m", [np.nan, np.inf, 1e12])
def test_a_station_off_the_earth_is_refused(height_m):
    with pytest.raises(ValueError, match="stands within ±100 km"):
        Station(latitude_deg=39.9, longitude_deg=116.4, height_m=height_m)


@pytest.mark.parametrize("year", [1, 1956, 2057, 9999])
def test_passes_outside_the_space_age_are_refused(year):
    with pytest.raises(ValueError, match=f"from 1957 to 2056, .*; got {year}"):
        passes(
            satellite_from_elements(DEMO_ORBIT),
            BEIJING,
            start_utc=datetime(year, 12, 31, tzinfo=UTC),
            duration_s=2 * 86400.0,
            elevation_mask_rad=0.2,
        )
