import numpy as np
import pytest

from core.geometry.track import random_views_track
from core.radar.echoes import point_echoes
from core.radar.imaging import frames
from core.radar.phase_history import PhaseHistory
from core.radar.tracking_error import displaced
from core.radar.waveform import Waveform


@pytest.fixture(scope="module")
def history():
    waveform = Waveform()
    track = random_views_track(
        views=1,
        turn_rad=waveform.wavelength_m / 0.3,
        pulses_per_view=256,
        pulse_repetition_frequency_hz=100.0,
        random=np.random.default_rng(2),
    )
    frequency = waveform.frequencies_hz()
    place = np.array([[1.0, -2.0, 0.5]])
    samples = point_echoes(place, np.ones(1, complex), track.line_of_sight, frequency)
    return PhaseHistory(samples=samples, frequency_hz=frequency, track=track)


def test_the_image_moves_by_the_error_and_stays_focused(history):
    # Whole pixels of 0.06 m, so that both images are sampled at the same places of the response.
    (still,) = frames(history)
    (off,) = frames(displaced(history, range_m=20 * 0.06, cross_range_m=-13 * 0.06))
    peaks = [np.argwhere(f.amplitude == f.amplitude.max())[0] for f in (still, off)]
    assert (peaks[1] - peaks[0]).tolist() == [20, -13]
    assert off.amplitude.max() == pytest.approx(still.amplitude.max(), rel=0.02)
    assert np.array_equal(off.projection.matrix, still.projection.matrix)
