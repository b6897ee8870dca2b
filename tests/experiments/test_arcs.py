from datetime import UTC, datetime

import numpy as np
import pytest

from core.experiments.arcs import outlined_frames, pair_arc, same_pass, station_arcs
from core.experiments.demo import DEMO_ORBIT, DEMO_STATION
from core.geometry.orbit import Station, satellite_from_elements
from core.radar.scatterers import surface_scatterers
from core.radar.waveform import Waveform
from core.targets import tiangong_like

START = datetime(2016, 3, 11, 20, tzinfo=UTC)
SHANGHAI = Station(latitude_deg=31.23, longitude_deg=121.47, height_m=4.0, name="Shanghai")
WAVEFORM = Waveform()
SATELLITE = satellite_from_elements(DEMO_ORBIT)


@pytest.fixture(scope="module")
def arcs():
    (beijing,) = station_arcs(SATELLITE, DEMO_STATION, WAVEFORM, start_utc=START, count=1, frames=4)
    shanghai = same_pass(SATELLITE, SHANGHAI, beijing, WAVEFORM, frames=4)
    stations = (DEMO_STATION, SHANGHAI)
    pair = pair_arc(SATELLITE, *stations, (beijing, shanghai), WAVEFORM, frames=4)
    return beijing, shanghai, pair


def moment(arc, second):
    return datetime.fromisoformat(arc.track.epoch_utc).timestamp() + second


def test_stations_on_both_sides_of_the_orbit_see_the_same_pass_from_both_sides(arcs):
    beijing, shanghai, _ = arcs
    assert beijing.label == "1: 11 Mar 20:26"
    assert beijing.highest_elevation_deg() == pytest.approx(52, abs=1)
    middles = [arc.track.line_of_sight[len(arc.track) // 2] for arc in (beijing, shanghai)]
    assert middles[0][1] > 0.4
    assert middles[1][1] < -0.4


def test_a_pair_sees_while_both_do_and_looks_along_their_bisector(arcs):
    beijing, shanghai, pair = arcs
    for arc in (beijing, shanghai):
        assert moment(pair, 0) >= moment(arc, 0) - 1e-3
        assert moment(pair, pair.track.time_s[-1]) <= moment(arc, arc.track.time_s[-1]) + 1e-3
    second = moment(pair, 100.0)
    single = [
        arc.track.line_of_sight[round(100 * (second - moment(arc, 0)))]
        for arc in (beijing, shanghai)
    ]
    bisector = np.sum(single, axis=0) / np.linalg.norm(np.sum(single, axis=0))
    assert pair.track.line_of_sight[10_000] == pytest.approx(bisector, abs=1e-4)
    assert pair.highest_elevation_deg() is None


def test_frames_of_a_pair_have_the_resolution_that_was_asked_for(arcs):
    points = surface_scatterers(tiangong_like(), count=500, random=np.random.default_rng(0))
    found = outlined_frames(
        arcs[2], points, WAVEFORM, signal_to_noise_db=20.0, random=np.random.default_rng(1)
    )
    sizes_m = [each.frame.column_resolution_m for each in found]
    assert np.mean(sizes_m) == pytest.approx(1.3 * 0.15, rel=0.05)
    assert {each.silhouette.claim for each in found} == {"lit side"}


def test_a_station_that_sees_nothing_of_the_pass_is_refused(arcs):
    quito = Station(latitude_deg=-0.2, longitude_deg=-78.5, height_m=2850.0, name="Quito")
    with pytest.raises(ValueError, match="Quito does not see the satellite"):
        same_pass(SATELLITE, quito, arcs[0], WAVEFORM, frames=4)
