from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest

from core.experiments.demo import DEMO_ORBIT, DEMO_STATION
from core.formats.pass_file import RecordedPass, read_pass, write_pass
from core.geometry.orbit import line_of_sight_track, satellite_from_elements
from core.optical.camera import pixel_size_m
from core.optical.simulation import OpticalSettings, simulate_optical_frames
from core.optical.sun import track_illumination
from core.optical.telescope import Telescope
from core.targets import tiangong_like

DUSK = datetime(2016, 3, 24, 10, 58, 30, tzinfo=UTC)
NIGHT = datetime(2016, 3, 11, 17, 14, tzinfo=UTC)
MOMENTS_S = (10.0, 60.0)
SMALL = OpticalSettings(shape=(180, 180), telescope=Telescope(aperture_m=1.2), supersampling=2)


def track_from(start):
    satellite = satellite_from_elements(DEMO_ORBIT)
    track = line_of_sight_track(
        satellite,
        DEMO_STATION,
        start_utc=start,
        duration_s=90.0,
        pulse_repetition_frequency_hz=10.0,
    )
    return track, track_illumination(satellite, track, np.array(MOMENTS_S))


def simulated(settings=SMALL, start=DUSK, seed=1):
    track, light = track_from(start)
    random = np.random.default_rng(seed)
    return simulate_optical_frames(
        tiangong_like(), track, MOMENTS_S, light, settings, random=random
    )


@pytest.mark.parametrize("is_perspective", [False, True])
def test_frames_look_along_the_radars_line_of_sight_with_columns_along_cross_range(is_perspective):
    track, light = track_from(DUSK)
    frames = simulated(replace(SMALL, is_perspective=is_perspective))
    for frame, moment, sun in zip(frames, MOMENTS_S, light.sun_direction, strict=True):
        pulse = int(moment * 10)
        assert frame.time_s == pytest.approx(moment)
        assert frame.line_of_sight == pytest.approx(track.line_of_sight[pulse])
        assert frame.sun_direction == pytest.approx(sun)
        assert frame.projection.is_affine is not is_perspective
        rate = track.line_of_sight_rate_per_s[pulse]
        moved = frame.projection.image_points(np.array([0 * rate, rate / np.linalg.norm(rate)]))
        step = np.diff(moved, axis=0)[0]
        pixel_m = track.range_m[pulse] * SMALL.pixel_rad()
        assert step == pytest.approx([0, 1 / pixel_m], abs=1e-3)
        assert pixel_size_m(frame.projection) == pytest.approx(pixel_m, rel=1e-6)
        assert (frame.row_spacing_m is None) is is_perspective


def test_any_other_roll_turns_the_picture():
    level, turned = (simulated(replace(SMALL, roll_rad=roll))[0] for roll in (0.0, np.pi / 2))
    # The camera turns clockwise, the picture counter-clockwise about its centre, pixel (90, 90).
    about = np.rot90(level.amplitude[1:, 1:]).ravel()
    assert np.corrcoef(about, turned.amplitude[1:, 1:].ravel())[0, 1] > 0.99
    other_way = np.rot90(level.amplitude[1:, 1:], -1).ravel()
    assert np.corrcoef(other_way, turned.amplitude[1:, 1:].ravel())[0, 1] < 0.9


def test_the_same_seed_gives_the_same_frames():
    first, again, other = simulated(), simulated(), simulated(seed=2)
    for one, two in zip(first, again, strict=True):
        np.testing.assert_array_equal(one.amplitude, two.amplitude)
    assert np.any(first[0].amplitude != other[0].amplitude)


@pytest.mark.parametrize("is_perspective", [False, True])
def test_frames_come_back_from_a_pass_file(tmp_path, is_perspective):
    frames = simulated(replace(SMALL, is_perspective=is_perspective))
    write_pass(tmp_path / "pass.h5", RecordedPass(frames=frames))
    for before, after in zip(frames, read_pass(tmp_path / "pass.h5").frames, strict=True):
        np.testing.assert_array_equal(after.amplitude, before.amplitude)
        np.testing.assert_array_equal(after.projection.matrix, before.projection.matrix)
        np.testing.assert_array_equal(after.sun_direction, before.sun_direction)
        assert (after.sensor, after.row_spacing_m) == ("optical", before.row_spacing_m)


def test_a_pass_in_the_earths_shadow_gives_no_picture():
    with pytest.raises(ValueError, match="in the Earth's shadow at all of the moments"):
        simulated(start=NIGHT)


def test_what_cannot_be_photographed_is_refused():
    with pytest.raises(ValueError, match="would be cut off"):
        simulated(replace(SMALL, shape=(40, 40)))
    with pytest.raises(ValueError, match="at least 8 × 8 pixels"):
        OpticalSettings(shape=(4, 4))
    track, light = track_from(DUSK)
    random = np.random.default_rng(1)
    with pytest.raises(ValueError, match="no ranges"):
        simulate_optical_frames(
            tiangong_like(), replace(track, range_m=None), MOMENTS_S, light, random=random
        )
    with pytest.raises(ValueError, match="There are 1 moments"):
        simulate_optical_frames(tiangong_like(), track, MOMENTS_S[:1], light, random=random)
