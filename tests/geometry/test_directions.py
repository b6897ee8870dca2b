from datetime import UTC, datetime

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from skyfield.api import load
from skyfield.sgp4lib import TEME

from core.geometry.directions import direction_in_frames, teme_to_lvlh
from core.geometry.orbit import MeanElements, satellite_from_elements

EPOCH = datetime(2026, 3, 1, 12, 0, 0, tzinfo=UTC)
SATELLITE = satellite_from_elements(
    MeanElements(
        epoch_utc=EPOCH,
        inclination_deg=51.6,
        node_deg=100.0,
        eccentricity=0.001,
        argument_of_perigee_deg=30.0,
        mean_anomaly_deg=40.0,
        mean_motion_rev_per_day=15.5,
    )
)
VECTORS = st.tuples(*[st.floats(-1, 1)] * 3).map(np.array).filter(lambda v: np.linalg.norm(v) > 0.1)


def state(at_utc):
    """Return position and velocity in TEME by skyfield's own rotation out of GCRS."""
    time = load.timescale(builtin=True).from_datetime(at_utc)
    position, velocity = SATELLITE.at(time).frame_xyz_and_velocity(TEME)
    return position.m, velocity.m_per_s


@pytest.mark.parametrize("minutes", [0, 17, 59])
def test_radial_transverse_normal_are_those_of_the_orbit(minutes):
    at_utc = EPOCH.replace(minute=minutes)
    position, velocity = state(at_utc)
    radial = position / np.linalg.norm(position)
    normal = np.cross(position, velocity)
    normal /= np.linalg.norm(normal)
    for vector, rtn, wanted in (
        ([0, 0, -1], [1, 0, 0], radial),
        ([0, -1, 0], [0, 0, 1], normal),
        ([1, 0, 0], [0, 1, 0], np.cross(normal, radial)),
    ):
        found = direction_in_frames(np.array(vector), satellite=SATELLITE, at_utc=at_utc)
        np.testing.assert_allclose(found.rtn, rtn, atol=1e-15)
        # Skyfield's way through GCRS agrees to a thousandth of an arcsecond.
        np.testing.assert_allclose(found.teme, wanted, atol=1e-8)
        assert found.epoch_utc == at_utc.isoformat().replace("+00:00", "Z")


@given(VECTORS, VECTORS)
@settings(max_examples=30)
def test_angles_are_the_same_in_every_frame(first, second):
    one, other = (
        direction_in_frames(vector, satellite=SATELLITE, at_utc=EPOCH) for vector in (first, second)
    )
    for name in ("target", "RTN", "TEME"):
        assert np.linalg.norm(one.in_frame(name)) == pytest.approx(1)
        assert one.in_frame(name) @ other.in_frame(name) == pytest.approx(
            one.target @ other.target, abs=1e-12
        )


def test_rotations_keep_right_hands_right():
    assert np.linalg.det(teme_to_lvlh(SATELLITE, EPOCH)) == pytest.approx(1)


def test_without_an_orbit_only_the_target_frame_is_known():
    found = direction_in_frames(np.array([0, 0, 2.0]), is_undirected=True)
    np.testing.assert_array_equal(found.in_frame("target"), [0, 0, 1])
    assert found.is_undirected
    assert found.epoch_utc == ""
    with pytest.raises(ValueError, match="needs the satellite's orbit"):
        found.in_frame("TEME")
    with pytest.raises(ValueError, match='no frame "ECI"; directions are given in target, RTN'):
        found.in_frame("ECI")


def test_nonsense_is_refused():
    with pytest.raises(ValueError, match="length above zero"):
        direction_in_frames(np.zeros(3))
    with pytest.raises(ValueError, match="needs its zone"):
        direction_in_frames(np.ones(3), satellite=SATELLITE, at_utc=EPOCH.replace(tzinfo=None))
