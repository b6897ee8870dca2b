from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.experiments.physics.point_spread import respond
from core.geometry.track import random_views_track, track_from_angles
from core.radar.echoes import point_echoes
from core.radar.imaging import ImagingSettings, frame_count, frames, whole_interval
from core.radar.phase_history import PhaseHistory
from core.radar.waveform import SPEED_OF_LIGHT_M_PER_S, Waveform
from core.radar.window import HAMMING, taylor

WAVEFORM = Waveform()
SETTINGS = ImagingSettings()


def one_view(seed, points, amplitudes=None, pulses=256):
    track = random_views_track(
        views=1,
        turn_rad=WAVEFORM.wavelength_m / 0.3,
        pulses_per_view=pulses,
        pulse_repetition_frequency_hz=100.0,
        random=np.random.default_rng(seed),
    )
    amplitudes = np.ones(len(points)) if amplitudes is None else amplitudes
    samples = point_echoes(
        np.asarray(points, dtype=float),
        np.asarray(amplitudes, dtype=complex),
        track.line_of_sight,
        WAVEFORM.frequencies_hz(),
    )
    return PhaseHistory(samples=samples, frequency_hz=WAVEFORM.frequencies_hz(), track=track)


def peak(amplitude):
    """Return the sub-pixel (row, column) of an image's peak by parabolas in dB."""
    row, column = np.unravel_index(np.argmax(amplitude), amplitude.shape)
    place = []
    for line, at in ((amplitude[:, column], row), (amplitude[row], column)):
        left, middle, right = 20 * np.log10(line[at - 1 : at + 2])
        place.append(at + 0.5 * (left - right) / (left - 2 * middle + right))
    return np.array(place)


@settings(max_examples=15, deadline=None)
@given(
    seed=st.integers(0, 10_000),
    point=st.lists(st.floats(-6, 6), min_size=3, max_size=3).map(np.array),
)
def test_a_point_lands_where_its_projection_says_even_far_off_axis(seed, point):
    (frame,) = frames(one_view(seed, [point]), SETTINGS)
    expected = frame.projection.image_points(point)
    # 0.06 m pixels, 0.15 m cells: 0.05 of a cell is 0.125 pixel.
    assert np.abs(peak(frame.amplitude) - expected).max() < 0.125
    # Half a pixel off on both axes, the sampled peak is 1 dB lower.
    assert 0.88 < frame.amplitude.max() < 1.001


def test_widths_and_sidelobes_are_the_windows_ten_metres_off_axis():
    history = one_view(4, [[0, 0, 0]])
    (probe,) = frames(history, SETTINGS)
    off_axis = 10.0 * probe.projection.matrix[1, :3] * 0.06
    fine = ImagingSettings(pixel_spacing_m=0.02, shape=(256, 1100))
    (frame,) = frames(one_view(4, [off_axis]), fine)
    row, column = np.unravel_index(np.argmax(frame.amplitude), frame.shape)
    for line, at, resolution_m in (
        (frame.amplitude[:, column], row, frame.row_resolution_m),
        (frame.amplitude[row], column, frame.column_resolution_m),
    ):
        level = 20 * np.log10(np.maximum(line, 1e-9) / line.max())
        assert half_power_width_px(level, at) * 0.02 == pytest.approx(resolution_m, rel=0.05)
        outside = np.abs(np.arange(len(level)) - at) > 0.36 / 0.02
        assert level[outside].max() < -40


def half_power_width_px(level_db, at):
    def crossing(step):
        place = at
        while level_db[place] > -3.0103:
            place += step
        inside, outside = level_db[place - step], level_db[place]
        return place - step + step * (inside + 3.0103) / (inside - outside)

    return crossing(1) - crossing(-1)


def test_the_image_equals_the_direct_sum():
    random = np.random.default_rng(7)
    history = one_view(5, random.uniform(-1, 1, (5, 3)), random.normal(size=5), pulses=40)
    settings_ = ImagingSettings(shape=(32, 32), pixel_spacing_m=0.15)
    (frame,) = frames(history, settings_)
    track = history.track
    axes = frame.projection.matrix[:, :3] * 0.15
    wavenumber = 4 * np.pi / SPEED_OF_LIGHT_M_PER_S * history.frequency_hz
    in_plane = track.line_of_sight @ axes.T
    weights = np.multiply.outer(
        *(HAMMING.weights((np.arange(count) + 0.5) / count) for count in (40, 256))
    )
    place = (np.arange(32) - 16) * 0.15
    vectors = in_plane[:, :, None] * wavenumber
    rows = np.exp(1j * np.multiply.outer(place, vectors[:, 0]))
    columns = np.exp(1j * np.multiply.outer(place, vectors[:, 1]))
    direct = np.einsum("rpf,cpf,pf->rc", rows, columns, history.samples * weights)
    assert np.abs(frame.amplitude - np.abs(direct) / weights.sum()).max() < 1e-4


def test_an_asymmetric_target_is_not_mirrored_from_any_side():
    """Three points in an L: the image's own L must turn the same way as the projection's."""
    corners = np.array([[0, 0, 0], [4.0, 0, 0], [0, 2.5, 1.0]])
    for seed in range(6):
        (frame,) = frames(one_view(seed, corners, [1.0, 1.5, 2.2]), SETTINGS)
        for corner, strength in zip(corners, (1.0, 1.5, 2.2), strict=True):
            row, column = np.round(frame.projection.image_points(corner)).astype(int)
            near = frame.amplitude[row - 1 : row + 2, column - 1 : column + 2]
            assert near.max() == pytest.approx(strength, rel=0.25)


@pytest.mark.parametrize("window", [HAMMING, taylor(sidelobe_db=-38.0, nbar=6)])
@pytest.mark.parametrize("method", ["polar", "keystone"])
@pytest.mark.parametrize("offset_m", [(0.0, 0.0), (10.0, 0.0), (0.0, -10.0), (-7.0, 7.0)])
def test_the_response_is_the_windows_on_and_off_the_axis(method, offset_m, window):
    history = one_view(11, np.zeros((1, 3)))
    seen = respond(
        history, whole_interval(history), offset_m, method=method, window=window, pixel_m=0.02
    )
    assert seen.error_cells < 0.05
    assert seen.width_error < 0.05
    assert seen.sidelobe_db == pytest.approx(window.highest_sidelobe_db, abs=1.0)
    assert seen.peak == pytest.approx(1, abs=0.02)


def test_plain_range_doppler_smears_off_the_axis_and_only_there():
    history = one_view(11, np.zeros((1, 3)))
    on, off = (
        respond(history, whole_interval(history), place, method="range-doppler", pixel_m=0.02)
        for place in ((0.0, 0.0), (0.0, 10.0))
    )
    assert on.width_error < 0.05
    assert off.width_error > 0.3
    assert off.peak < 0.8


@pytest.mark.parametrize("columns", [63, 64, 65])
@pytest.mark.parametrize("column_m", [0.05, 0.15, 0.4])
def test_keystone_puts_the_origin_in_the_middle_at_any_spacing(columns, column_m):
    history = one_view(2, [[0, 0, 0]])
    coarse = ImagingSettings(method="keystone", shape=(64, columns), column_spacing_m=column_m)
    (frame,) = frames(history, coarse)
    peak = np.unravel_index(np.argmax(frame.amplitude), frame.shape)
    assert peak == (32, columns // 2)
    assert frame.amplitude.max() == pytest.approx(1, abs=1e-3)
    assert frame.projection.image_points(np.zeros(3)) == pytest.approx(peak)


def test_a_turn_that_grows_faster_still_gives_the_windows_response():
    """Pulses crowd where the line of sight turns slowly; each is weighed by its turn."""
    place = np.linspace(-1, 1, 300)
    angle = WAVEFORM.wavelength_m / 0.6 * (place + 0.3 * place**2)
    track = track_from_angles(np.arange(300), np.zeros(300), angle)
    history = PhaseHistory(
        samples=np.ones((300, 256)), frequency_hz=WAVEFORM.frequencies_hz(), track=track
    )
    seen = respond(history, whole_interval(history), (0.0, 3.0), method="polar", pixel_m=0.02)
    assert seen.width_error < 0.02
    assert seen.sidelobe_db == pytest.approx(HAMMING.highest_sidelobe_db, abs=0.5)


def test_unevenly_timed_pulses_are_no_plain_range_doppler():
    history = one_view(1, [[0, 0, 0]])
    time = np.array(history.track.time_s)
    time[100] += 0.004
    uneven = replace(history, track=replace(history.track, time_s=time))
    with pytest.raises(ValueError, match=r"up to 0\.4 pulse intervals early or late; use polar"):
        list(frames(uneven, replace(SETTINGS, method="range-doppler")))


@pytest.mark.parametrize(
    ("waveform", "pulses", "axis"),
    [(Waveform(bandwidth_hz=2e9), 256, "range"), (WAVEFORM, 128, "Doppler")],
)
def test_a_target_larger_than_what_is_unambiguous_is_refused(waveform, pulses, axis):
    history = one_view(1, [[0, 0, 0]], pulses=pulses)
    history = replace(history, frequency_hz=waveform.frequencies_hz())
    asked = replace(SETTINGS, target_radius_m=10.0, shape=(32, 32))
    with pytest.raises(ValueError, match=f"spans 20 m, but the echoes are unambiguous in {axis}"):
        frame_count(history, asked)


def test_unmatched_shapes_are_refused():
    history = one_view(1, [[0, 0, 0]])
    with pytest.raises(ValueError, match=r"shape 256 × 256, got \(255, 256\)"):
        replace(history, samples=history.samples[1:])


@pytest.mark.parametrize("name", ["pixel_spacing_m", "row_spacing_m", "column_spacing_m"])
@pytest.mark.parametrize("value", [0.0, -1.0, np.nan])
def test_a_senseless_spacing_is_refused(name, value):
    with pytest.raises(ValueError, match="spacing must be positive metres"):
        ImagingSettings(**{name: value})


def test_frames_are_counted_before_they_are_made():
    history = one_view(1, [[0, 0, 0]])
    assert frame_count(history, SETTINGS) == 1 == len(list(frames(history, SETTINGS)))


def test_too_few_pulses_for_the_image_are_refused():
    time = np.linspace(0, 1, 20)
    track = track_from_angles(time, np.zeros(20), 0.06 * time)
    history = PhaseHistory(
        samples=np.ones((20, 256)), frequency_hz=WAVEFORM.frequencies_hz(), track=track
    )
    with pytest.raises(ValueError, match="denser frequencies and pulses"):
        list(frames(history, SETTINGS))


def test_echoes_with_nan_are_refused():
    history = one_view(1, [[0, 0, 0]])
    broken = np.array(history.samples)
    broken[3, 4] = np.nan
    with pytest.raises(ValueError, match="1 of 65536 values are NaN or infinite"):
        PhaseHistory(samples=broken, frequency_hz=history.frequency_hz, track=history.track)


@pytest.mark.parametrize(
    ("waveform", "pulses"), [(Waveform(bandwidth_hz=2e9), 256), (WAVEFORM, 128)]
)
def test_images_wider_than_the_unambiguous_swath_are_refused(waveform, pulses):
    track = random_views_track(
        views=1,
        turn_rad=WAVEFORM.wavelength_m / 0.3,
        pulses_per_view=pulses,
        pulse_repetition_frequency_hz=100.0,
        random=np.random.default_rng(0),
    )
    history = PhaseHistory(
        samples=np.ones((pulses, 256)), frequency_hz=waveform.frequencies_hz(), track=track
    )
    with pytest.raises(ValueError, match="would show ghosts"):
        list(frames(history, SETTINGS))
