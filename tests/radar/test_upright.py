import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.radar.circular_sar import (
    body_waveform,
    circular_track,
    near_field_echoes,
    near_field_frames,
)
from core.radar.phase_history import PhaseHistory
from core.radar.upright import near_image_points, upright_frames, upright_points

RANGE_M = 6.0
FREQUENCY_HZ = body_waveform().frequencies_hz()


def history_of(points_m, elevation_deg):
    """One sub-aperture of 25 mm before unit points."""
    span = 1.01 * 0.2223 / np.cos(np.deg2rad(elevation_deg))
    track = circular_track(
        range_m=RANGE_M,
        elevation_rad=np.deg2rad(elevation_deg),
        azimuth_span_rad=span,
        pulses=48,
    )
    samples = near_field_echoes(points_m, np.ones(len(points_m), complex), track, FREQUENCY_HZ)
    return PhaseHistory(samples=samples, frequency_hz=FREQUENCY_HZ, track=track)


@pytest.mark.parametrize("elevation_deg", [60.0, -30.0])
def test_the_head_is_sharp_where_the_tilted_plane_smears_it(elevation_deg):
    head_m = np.array([[0.0, 0.0, -0.8]])
    history = history_of(head_m, elevation_deg)
    upright, flat = next(upright_frames(history)), next(near_field_frames(history))
    assert upright.amplitude.max() > 0.95
    assert flat.amplitude.max() < 0.9 * upright.amplitude.max()
    row, column = near_image_points(upright, RANGE_M, head_m)[0]
    peak = np.unravel_index(upright.amplitude.argmax(), upright.shape)
    assert np.abs(np.subtract(peak, (row, column))).max() <= 1


@settings(max_examples=10, deadline=None)
@given(
    elevation_deg=st.floats(15, 75) | st.floats(-75, -15), part=st.tuples(*[st.floats(0, 1)] * 2)
)
def test_upright_points_appear_at_their_own_pixels(elevation_deg, part):
    frame = next(near_field_frames(history_of(np.zeros((1, 3)), elevation_deg)))
    points = upright_points(frame, RANGE_M)
    row, column = (round(p * (size - 1)) for p, size in zip(part, frame.shape, strict=True))
    point = points[row, column]
    assert point[:2] @ frame.line_of_sight[:2] == pytest.approx(0, abs=1e-9)
    if (RANGE_M * frame.line_of_sight[2]) ** 2 > 2 * RANGE_M * 0.96:
        found = near_image_points(frame, RANGE_M, point)
        np.testing.assert_allclose(found, (row, column), atol=0.02)


def test_an_antenna_on_the_level_is_refused():
    frame = next(near_field_frames(history_of(np.zeros((1, 3)), 0.5)))
    with pytest.raises(ValueError, match="from above or below"):
        upright_points(frame, RANGE_M)
