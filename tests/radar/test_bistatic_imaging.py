"""A bistatic pair through the whole chain: nothing after the track needs to know of it."""

import numpy as np
import pytest

from core.geometry.bistatic import bistatic_track
from core.geometry.track import track_from_angles
from core.radar.backprojection import backproject
from core.radar.echoes import simulate_echoes
from core.radar.imaging import ImagingSettings, frames
from core.radar.phase_history import PhaseHistory
from core.radar.reflectors import square_plate
from core.radar.scatterers import Scatterers
from core.radar.waveform import SPEED_OF_LIGHT_M_PER_S, Waveform
from tests.radar.test_imaging import half_power_width_px, peak

WAVEFORM = Waveform()
POINTS_M = np.array([[4.0, -2.0, 1.0], [-3.0, 3.5, -2.0], [0.0, 0.0, 0.0], [1.0, 5.0, 4.0]])


def pair():
    """Two stations 50° apart, the angle between them shrinking by a tenth during the pass."""
    time_s = np.arange(600) / 100
    sender = track_from_angles(time_s, 0.2 + 0 * time_s, 0.03 * time_s)
    receiver = track_from_angles(time_s, 0.9 - 0.004 * time_s, 0.6 + 0.015 * time_s)
    return sender, receiver


def echoes(point_m, sender, receiver):
    """The sum of both ways, written out: the reference that `phase_direction` must equal."""
    way = sender.line_of_sight @ point_m + receiver.line_of_sight @ point_m
    frequency = WAVEFORM.frequencies_hz()
    samples = np.exp(-2j * np.pi / SPEED_OF_LIGHT_M_PER_S * np.outer(way, frequency))
    track = bistatic_track(sender, receiver)
    return PhaseHistory(samples=samples, frequency_hz=frequency, track=track)


@pytest.mark.parametrize("point_m", POINTS_M)
def test_a_point_lands_where_its_projection_says(point_m):
    history = echoes(point_m, *pair())
    for frame in frames(history, ImagingSettings(shape=(256, 256))):
        expected = frame.projection.image_points(point_m)
        assert np.abs(peak(frame.amplitude) - expected).max() < 0.125
        assert 0.88 < frame.amplitude.max() < 1.001


def test_resolution_is_that_of_the_longer_wavelength():
    history = echoes(np.zeros(3), *pair())
    scale = history.track.bisector_scale.mean()
    assert scale < 0.95
    assert history.wavelength_m == pytest.approx(WAVEFORM.wavelength_m / scale)
    assert history.bandwidth_hz == pytest.approx(WAVEFORM.bandwidth_hz * scale)
    (frame, *_) = frames(history, ImagingSettings(shape=(128, 128), pixel_spacing_m=0.02))
    row, column = np.unravel_index(np.argmax(frame.amplitude), frame.shape)
    for line, at, resolution_m in (
        (frame.amplitude[:, column], row, frame.row_resolution_m),
        (frame.amplitude[row], column, frame.column_resolution_m),
    ):
        level = 20 * np.log10(np.maximum(line, 1e-9) / line.max())
        assert half_power_width_px(level, at) * 0.02 == pytest.approx(resolution_m, rel=0.03)


def test_back_projection_focuses_the_pair_too():
    image = backproject(echoes(POINTS_M[0], *pair()), POINTS_M[0] + [[0, 0, 0], [0.5, 0.5, 0.5]])
    assert abs(image[0]) == pytest.approx(1, abs=0.01)
    assert abs(image[1]) < 0.1


def test_simulated_echoes_are_those_of_both_ways():
    sender, receiver = pair()
    point = Scatterers(
        position_m=POINTS_M[:1],
        normal=-sender.line_of_sight[300:301],
        reflectivity=np.ones(1),
        mesh=square_plate(0.01),
    )
    simulated = simulate_echoes(
        point,
        bistatic_track(sender, receiver),
        WAVEFORM,
        signal_to_noise_db=200.0,
        random=np.random.default_rng(0),
    ).samples
    wanted = echoes(POINTS_M[0], sender, receiver).samples
    assert np.abs(simulated / np.abs(simulated) - wanted).max() < 2e-3
