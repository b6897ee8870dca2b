import numpy as np
import pytest

from core.geometry.track import LineOfSightTrack
from core.radar.backprojection import backproject
from core.radar.imaging import ImagingSettings, interval_frame, whole_interval
from core.radar.phase_history import PhaseHistory
from core.radar.waveform import SPEED_OF_LIGHT_M_PER_S
from core.radar.window import HAMMING

FREQUENCY_HZ = np.linspace(9.3e9, 9.9e9, 128)


def _track(*, range_m=None, pulses=96, turn_rad=0.06):
    angle = np.linspace(-0.5, 0.5, pulses) * turn_rad
    elevation = 0.5
    line_of_sight = np.stack(
        [
            -np.cos(elevation) * np.cos(angle),
            -np.cos(elevation) * np.sin(angle),
            np.full(pulses, -np.sin(elevation)),
        ],
        axis=1,
    )
    rate = np.gradient(line_of_sight, axis=0, edge_order=2)
    rate -= line_of_sight * np.sum(line_of_sight * rate, axis=1, keepdims=True)
    return LineOfSightTrack(
        time_s=np.arange(pulses),
        line_of_sight=line_of_sight,
        line_of_sight_rate_per_s=rate,
        range_m=None if range_m is None else np.linspace(range_m, 1.001 * range_m, pulses),
    )


def _range_beyond_origin_m(track, points_m):
    """R(p) − R(0), (pulses, points), straight from its meaning."""
    if track.range_m is None:
        return track.line_of_sight @ points_m.T
    radar_m = -track.range_m[:, None] * track.line_of_sight
    distance_m = np.linalg.norm(points_m[None] - radar_m[:, None], axis=-1)
    return distance_m - track.range_m[:, None]


def _history(track, points_m, amplitudes):
    beyond_m = _range_beyond_origin_m(track, points_m)
    wavenumber = 4 * np.pi / SPEED_OF_LIGHT_M_PER_S * FREQUENCY_HZ
    samples = np.exp(-1j * beyond_m[:, :, None] * wavenumber).transpose(0, 2, 1) @ amplitudes
    return PhaseHistory(samples=samples, frequency_hz=FREQUENCY_HZ, track=track)


@pytest.mark.parametrize("range_m", [None, 900.0])
def test_it_is_the_matched_sum_over_all_samples(range_m):
    random = np.random.default_rng(3)
    track = _track(range_m=range_m)
    history = _history(track, random.uniform(-5, 5, (4, 3)), random.normal(size=4))
    points_m = random.uniform(-6, 6, (40, 3))
    # The line of sight turns evenly.
    weights = np.multiply.outer(
        *(HAMMING.weights((np.arange(count) + 0.5) / count) for count in history.samples.shape)
    )
    wavenumber = 4 * np.pi / SPEED_OF_LIGHT_M_PER_S * FREQUENCY_HZ
    matched = np.exp(1j * _range_beyond_origin_m(track, points_m).T[..., None] * wavenumber)
    wanted = (matched * (weights * history.samples)).sum(axis=(1, 2)) / weights.sum()
    image = backproject(history, points_m.reshape(8, 5, 3))
    assert image.shape == (8, 5)
    np.testing.assert_allclose(image.ravel(), wanted, atol=3e-4)


@pytest.mark.parametrize("range_m", [None, 900.0])
def test_a_point_lands_at_its_range_and_cross_range_with_its_amplitude(range_m):
    track = _track(range_m=range_m)
    across = track.line_of_sight_rate_per_s[48] / np.linalg.norm(track.line_of_sight_rate_per_s[48])
    point_m = 3.0 * track.line_of_sight[48] - 1.6 * across
    frame = focused(_history(track, point_m[None], np.array([2.0])), (120, 100), 0.1, 0.08)
    row, column = np.unravel_index(np.argmax(frame.amplitude), frame.shape)
    assert (row, column) == (60 + 30, 50 - 20)
    assert frame.projection.image_points(point_m) == pytest.approx([90, 30])
    assert frame.amplitude.max() == pytest.approx(2.0, rel=2e-3)


def test_the_stated_resolution_is_the_points_width():
    track = _track(range_m=900.0)
    frame = focused(_history(track, np.zeros((1, 3)), np.ones(1)), (200, 200), 0.02, 0.02)
    row_width_m = 0.02 * np.count_nonzero(frame.amplitude[:, 100] > np.sqrt(0.5))
    column_width_m = 0.02 * np.count_nonzero(frame.amplitude[100] > np.sqrt(0.5))
    assert row_width_m == pytest.approx(frame.row_resolution_m, rel=0.08)
    assert column_width_m == pytest.approx(frame.column_resolution_m, rel=0.08)


def focused(history, shape, row_spacing_m, column_spacing_m):
    settings = ImagingSettings(
        method="backprojection",
        shape=shape,
        row_spacing_m=row_spacing_m,
        column_spacing_m=column_spacing_m,
    )
    return interval_frame(history, whole_interval(history), settings)


def test_nothing_comes_from_beyond_the_unambiguous_swath():
    history = _history(_track(), np.zeros((1, 3)), np.ones(1))
    swath_m = SPEED_OF_LIGHT_M_PER_S / (2 * history.frequency_step_hz)
    far_m = history.track.line_of_sight[48] * swath_m
    assert abs(backproject(history, far_m[None])[0]) == 0


def test_a_senseless_image_is_refused():
    history = _history(_track(), np.zeros((1, 3)), np.ones(1))
    with pytest.raises(ValueError, match="spacing must be positive"):
        focused(history, (64, 64), 0.0, 0.1)
    with pytest.raises(ValueError, match="16 to 8192 pixels"):
        focused(history, (1, 64), 0.1, 0.1)
