import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.radar.range_alignment import aligned, range_offsets_m
from tests.radar.straying import CELL_M, body_history, points_history


def test_moving_a_target_away_and_back_changes_nothing():
    history = points_history()
    away_m = np.linspace(-3, 5, len(history.track))
    there = aligned(history, -away_m)
    assert np.abs(there.samples - history.samples).max() > 0.5
    np.testing.assert_allclose(aligned(there, away_m).samples, history.samples, atol=1e-5)


def test_a_shift_is_a_longer_way_at_every_frequency():
    history = points_history(positions_m=((0.0, 0.0, 0.0),))
    (farther,) = {round(value, 6) for value in _delay_m(aligned(history, _all(history, -0.37)))}
    assert farther == pytest.approx(0.37, abs=1e-4)


def _all(history, value):
    return np.full(len(history.track), value)


def _delay_m(history):
    phase = np.unwrap(np.angle(history.samples.astype(complex)), axis=1)
    slope = np.polyfit(history.frequency_hz - history.frequency_hz[0], phase.T, 1)[0]
    return np.round(-slope * 299_792_458.0 / (4 * np.pi), 5)


@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=15)
def test_any_translation_of_lone_points_is_found_to_a_part_of_a_cell(seed):
    random = np.random.default_rng(seed)
    history = points_history()
    pulses = len(history.track)
    way_m = 2 * np.cumsum(random.normal(size=pulses)) / pulses**0.5
    way_m = 1.5 * way_m / np.abs(way_m).max() + random.uniform(-0.5, 0.5, pulses) * CELL_M
    found_m = range_offsets_m(aligned(history, -way_m)) - range_offsets_m(history)
    apart_m = found_m - way_m
    assert apart_m.std() < 0.15 * CELL_M


def test_a_diffuse_body_is_held_still_within_a_third_of_a_cell():
    history, way_m = body_history(seed=4)
    found_m = range_offsets_m(aligned(history, -way_m))
    apart_m = found_m - way_m
    k = history.track.line_of_sight
    shift_m, *_ = np.linalg.lstsq(k, apart_m, rcond=None)
    assert (apart_m - k @ shift_m).std() < CELL_M / 3


def test_dark_echoes_have_no_offset():
    history = points_history(positions_m=((0.0, 0.0, 0.0),), amplitude=0.0)
    np.testing.assert_array_equal(range_offsets_m(history), 0.0)
