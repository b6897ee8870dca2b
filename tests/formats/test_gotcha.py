import numpy as np
import pytest
from scipy.io import loadmat, savemat
from scipy.ndimage import maximum_filter

from core.formats.gotcha import read_gotcha
from core.radar.backprojection import backproject
from core.radar.imaging import ImagingSettings, whole_frame
from core.radar.phase_history import PhaseHistory
from core.radar.waveform import SPEED_OF_LIGHT_M_PER_S

POINT_M = np.array([3.0, -2.0, 0.5])
FREQUENCY_HZ = np.float32(9.3e9) + np.arange(64, dtype=np.float32) * np.float32(5e6)


def _data(first_deg, *, pulses=40, **change):
    azimuth = np.radians(first_deg + np.arange(pulses) / pulses)
    x, y = 7000 * np.cos(azimuth), 7000 * np.sin(azimuth)
    antenna = np.stack([x, y, np.full(pulses, 7200.0)], axis=1)
    r0 = np.linalg.norm(antenna, axis=1)
    beyond = np.linalg.norm(antenna - POINT_M, axis=1) - r0
    wavenumber = 4 * np.pi / SPEED_OF_LIGHT_M_PER_S * change.get("freq", FREQUENCY_HZ).astype(float)
    fields = {
        "fp": np.exp(-1j * np.outer(wavenumber, beyond)).astype(np.complex64),
        "freq": FREQUENCY_HZ,
        "x": x,
        "y": y,
        "z": antenna[:, 2],
        "r0": r0,
        "af": {"r_correct": np.full(pulses, 0.25), "ph_correct": np.full(pulses, 0.5)},
    }
    return fields | change


def _write(folder, *starts_deg, **change):
    paths = [folder / f"data_3dsar_{start}.mat" for start in starts_deg]
    for path, start in zip(paths, starts_deg, strict=True):
        savemat(path, {"data": _data(start, **change)})
    return paths


def test_files_of_neighbouring_degrees_become_one_history_in_order_of_azimuth(tmp_path):
    history = read_gotcha(_write(tmp_path, 1, 359, 0))
    azimuth = np.unwrap(
        np.arctan2(-history.track.line_of_sight[:, 1], -history.track.line_of_sight[:, 0])
    )
    assert len(azimuth) == 120
    assert np.degrees(np.ptp(azimuth)) == pytest.approx(3 * 119 / 120)
    assert np.all(np.diff(azimuth) > 0)
    assert history.track.range_m[0] == pytest.approx(np.hypot(7000, 7200))


def test_a_point_lands_where_it_is(tmp_path):
    history = read_gotcha(_write(tmp_path, 2, 3))
    assert abs(backproject(history, POINT_M[None])[0]) == pytest.approx(1.0, rel=1e-2)
    assert abs(backproject(history, -POINT_M[None])[0]) < 0.05


def test_autofocus_turns_the_phase_and_moves_the_range(tmp_path):
    paths = _write(tmp_path, 2)
    ratio = read_gotcha(paths, autofocus=True).samples / read_gotcha(paths).samples
    wavenumber = 4 * np.pi / SPEED_OF_LIGHT_M_PER_S * FREQUENCY_HZ.astype(float)
    np.testing.assert_allclose(ratio[7], np.exp(1j * (0.5 - 0.25 * wavenumber)), atol=5e-3)


def test_frequencies_that_are_not_even_are_resampled(tmp_path):
    bent = FREQUENCY_HZ + np.float32(1e6) * np.sin(np.linspace(0, np.pi, 64)).astype(np.float32)
    history = read_gotcha(_write(tmp_path, 2, freq=bent))
    assert np.ptp(np.diff(history.frequency_hz)) < 1
    even = _data(2, freq=np.linspace(bent[0], bent[-1], 64))["fp"].T
    np.testing.assert_allclose(history.samples, even, atol=0.02)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"r0": np.full(40, 9000.0)}, "differs from that of x, y, z by up to"),
        ({"x": np.arange(39.0)}, "not in Gotcha's form"),
        ({"fp": np.zeros((40, 64))}, "not in Gotcha's form.*fp: wanted an array of shape 40 × 64"),
        ({"fp": np.full((64, 40), np.nan)}, "2560 of 2560 values are NaN"),
        ({"freq": FREQUENCY_HZ[::-1]}, "frequencies must grow"),
    ],
)
def test_a_broken_file_says_what_is_wrong(tmp_path, change, says):
    with pytest.raises(ValueError, match=says):
        read_gotcha(_write(tmp_path, 2, **change))


def test_missing_degrees_and_repeated_ones_are_refused(tmp_path):
    with pytest.raises(ValueError, match="neighbouring degrees"):
        read_gotcha(_write(tmp_path, 1, 3))
    with pytest.raises(ValueError, match="neighbouring degrees"):
        read_gotcha(_write(tmp_path, 1) * 2)


def test_what_is_no_such_file_is_refused(tmp_path):
    with pytest.raises(ValueError, match="got none"):
        read_gotcha([])
    with pytest.raises(ValueError, match="is no file"):
        read_gotcha([tmp_path / "absent.mat"])
    (path,) = _write(tmp_path, 2)
    path.write_bytes(path.read_bytes()[:5000])
    with pytest.raises(ValueError, match="is no MATLAB file"):
        read_gotcha([path])
    savemat(path, {"other": 1})
    with pytest.raises(ValueError, match='a structure called "data", but holds other'):
        read_gotcha([path])


@pytest.fixture(scope="module")
def measured_paths(request):
    folder = request.config.rootpath.parent / "shared" / "data" / "gotcha"
    if not folder.is_dir():
        pytest.skip("outside data set gotcha is not beside this checkout")
    return sorted(folder.glob("*.mat"))


@pytest.fixture(scope="module")
def measured(measured_paths):
    """The measured history and its picture, 102 m wide."""
    history = read_gotcha(measured_paths)
    settings = ImagingSettings(method="backprojection", shape=(512, 512), pixel_spacing_m=0.2)
    return history, whole_frame(history, settings)


def test_the_measured_scene_is_in_focus(measured):
    history, frame = measured
    assert history.samples.shape == (469, 424)
    assert 20 * np.log10(frame.amplitude.max() / np.median(frame.amplitude)) >= 45


def test_the_brightest_isolated_return_is_as_sharp_as_theory_has_it(measured):
    history, frame = measured
    row, column = _brightest_isolated(frame.amplitude)
    offset = np.arange(-60, 61) * 0.1  # pixels of 0.2 m
    rows = np.stack([row + offset, np.full_like(offset, column)], axis=-1)
    columns = np.stack([np.full_like(offset, row), column + offset], axis=-1)
    for line, theory_m in ((rows, frame.row_resolution_m), (columns, frame.column_resolution_m)):
        amplitude = np.abs(backproject(history, frame.projection.plane_points(line)))
        width_m = 0.02 * np.count_nonzero(amplitude > np.sqrt(0.5) * amplitude.max())
        assert width_m == pytest.approx(theory_m, rel=0.2)


def _brightest_isolated(amplitude):
    """The brightest pixel that nothing within 6 m but its own main lobe comes within 20 dB of."""
    padded = np.pad(amplitude, 30)
    for place in np.argsort(-amplitude, axis=None)[:1000]:
        row, column = np.unravel_index(place, amplitude.shape)
        around = padded[row : row + 61, column : column + 61].copy()
        peak = around[30, 30]
        around[25:36, 25:36] = 0
        if around.max() < 0.1 * peak and peak == maximum_filter(amplitude, 11)[row, column]:
            return row, column
    raise AssertionError("no isolated return")


def test_the_files_autofocus_fits_only_this_sign(measured, measured_paths):
    """Were the data conjugate to ours, r_correct, which adds to r0, would turn the other way."""
    history, frame = measured
    files = [
        loadmat(path, squeeze_me=True, struct_as_record=False)["data"] for path in measured_paths
    ]
    range_m = np.concatenate([data.af.r_correct for data in files]).astype(float)
    phase_rad = np.concatenate([data.af.ph_correct for data in files]).astype(float)
    wavenumber = 4 * np.pi / SPEED_OF_LIGHT_M_PER_S * history.frequency_hz
    correction = np.exp(1j * (phase_rad[:, None] + np.outer(range_m, wavenumber)))
    wrong = PhaseHistory(
        samples=np.conj(history.samples * correction),
        frequency_hz=history.frequency_hz,
        track=history.track,
    )
    place = np.array(np.unravel_index(np.argmax(frame.amplitude), frame.shape)) - 256.0
    around = np.stack(np.meshgrid(*2 * [np.arange(-4, 5, 0.5)], indexing="ij"), axis=-1)
    right = read_gotcha(measured_paths, autofocus=True)
    assert _peak(right, frame, 256 + place + around) > 0.7 * frame.amplitude.max()
    assert _peak(wrong, frame, 256 - place + around) < 0.1 * frame.amplitude.max()


def _peak(history, frame, pixels):
    return np.abs(backproject(history, frame.projection.plane_points(pixels))).max()
