import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from core.factorization.alignment import align
from core.factorization.factorization import UnobservableShape, factorize
from core.factorization.tracks import Glint, glinting, tracks_of
from tests.factorization.paths import cone_path, generic_path

SEEDS = st.integers(0, 2**32 - 1)


def scene(seed, *, points=40, frames=24):
    random = np.random.default_rng(seed)
    k, rate = generic_path(frames, random)
    return random.normal(size=(points, 3)) * [6, 3, 2], k, rate, random


def distance_m(result, points_m):
    return align(result.shape_m, points_m[result.points]).rms_m


@settings(max_examples=25)
@given(seed=SEEDS, points=st.integers(6, 60), frames=st.integers(8, 40))
def test_exact_tracks_give_the_shape_up_to_a_rigid_motion(seed, points, frames):
    points_m, k, rate, _ = scene(seed, points=points, frames=frames)
    result = factorize(tracks_of(points_m, k, rate))
    assume(result.metric_ratio > 1e-4 and result.rank_ratio > 1e-3)
    assert distance_m(result, points_m) < 1e-6
    assert result.cross_range_scale == pytest.approx(np.linalg.norm(rate, axis=1), rel=1e-6)
    cosine = np.sum(result.line_of_sight * result.cross_range_direction, axis=1)
    assert np.abs(cosine).max() < 1e-6


@settings(max_examples=10)
@given(seed=SEEDS)
def test_translation_and_unit_of_each_frame_drop_out(seed):
    points_m, k, rate, random = scene(seed)
    tracks = tracks_of(points_m, k, rate)
    plain = factorize(tracks)
    assume(plain.metric_ratio > 1e-4)
    moved = tracks * np.array([1, 0])
    moved += tracks * np.array([0, 1]) * random.uniform(0.1, 10, (len(k), 1, 1))
    moved += 0.1 * random.normal(size=(len(k), 1, 2))
    assert align(factorize(moved).shape_m, plain.shape_m).rms_m < 1e-6


@settings(max_examples=8)
@given(seed=SEEDS)
def test_half_the_points_missing_change_nothing_if_the_rest_is_exact(seed):
    points_m, k, rate, random = scene(seed, points=60)
    glint = Glint(visible=0.5)
    speed = np.linalg.norm(rate, axis=1)
    tracks = glinting(
        tracks_of(points_m, k, rate), glint, rotation_rate_rad_per_s=speed, random=random
    )
    result = factorize(tracks)
    assume(result.metric_ratio > 1e-3)
    assert distance_m(result, points_m) < 1e-6


def test_nine_tenths_of_755_scatterers_missing():
    points_m, k, rate, random = scene(1, points=755, frames=60)
    speed = np.linalg.norm(rate, axis=1)
    glint = Glint(visible=0.1, noise_cells=0.3)
    tracks = glinting(
        tracks_of(points_m, k, rate), glint, rotation_rate_rad_per_s=speed, random=random
    )
    result = factorize(tracks)
    seen_twice = np.isfinite(tracks[..., 0]).sum(axis=0) >= 2
    assert np.array_equal(result.points, np.flatnonzero(seen_twice))
    assert distance_m(result, points_m) < 0.15


@pytest.mark.parametrize("seed", [4, 8, 9])
def test_scatterers_seen_for_a_quarter_of_the_frames_without_a_break(seed):
    """Three of many scenes whose first start leads into a false minimum, metres off."""
    random = np.random.default_rng(seed)
    k, rate = generic_path(40, random)
    points_m = random.normal(size=(100, 3)) * [18, 3, 4]
    tracks = tracks_of(points_m, k, rate)
    since_rise = (np.arange(40)[:, None] - random.integers(0, 40, 100)) % 40
    tracks[since_rise >= 10] = np.nan
    assert distance_m(factorize(tracks), points_m) < 1e-6


def test_wrong_associations_spoil_least_squares_and_not_the_robust_loss():
    points_m, k, rate, random = scene(2, points=150, frames=30)
    speed = np.linalg.norm(rate, axis=1)
    glint = Glint(jump=0.15, noise_cells=0.1)
    tracks = glinting(
        tracks_of(points_m, k, rate), glint, rotation_rate_rad_per_s=speed, random=random
    )
    plain, robust = (distance_m(factorize(tracks, robust=loss), points_m) for loss in (False, True))
    assert robust < 0.03
    assert plain > 5 * robust


@pytest.mark.parametrize("noise_cells", [0.0, 0.2])
def test_a_line_of_sight_in_a_plane_is_reported(noise_cells):
    points_m, *_, random = scene(3)
    k, rate = cone_path(24, 0.0)
    speed = np.linalg.norm(rate, axis=1)
    glint = Glint(noise_cells=noise_cells)
    tracks = glinting(
        tracks_of(points_m, k, rate), glint, rotation_rate_rad_per_s=speed, random=random
    )
    with pytest.raises(UnobservableShape, match="two dimensions"):
        factorize(tracks)


@pytest.mark.parametrize("noise_cells", [0.0, 0.2])
def test_a_turn_at_a_constant_angle_is_reported(noise_cells):
    points_m, *_, random = scene(3, points=200)
    k, rate = cone_path(24, 0.5)
    speed = np.linalg.norm(rate, axis=1)
    glint = Glint(noise_cells=noise_cells)
    tracks = glinting(
        tracks_of(points_m, k, rate), glint, rotation_rate_rad_per_s=speed, random=random
    )
    with pytest.raises(UnobservableShape, match="cone"):
        factorize(tracks)


def test_cross_range_in_metres_settles_a_turn_at_a_constant_angle():
    points_m, *_ = scene(3)
    k, rate = cone_path(24, 0.5)
    tracks = tracks_of(points_m, k, rate / np.linalg.norm(rate, axis=1, keepdims=True))
    result = factorize(tracks, scaled=True)
    assert distance_m(result, points_m) < 1e-6
    assert result.cross_range_scale == pytest.approx(np.ones(24))


def test_who_asks_for_it_gets_one_of_many_shapes():
    points_m, *_, random = scene(3, points=200)
    k, rate = cone_path(24, 0.5)
    speed = np.linalg.norm(rate, axis=1)
    tracks = glinting(
        tracks_of(points_m, k, rate),
        Glint(noise_cells=0.2),
        rotation_rate_rad_per_s=speed,
        random=random,
    )
    result = factorize(tracks, even_if_ambiguous=True)
    assert result.range_rms_m < 0.05
    assert distance_m(result, points_m) > 1


@pytest.mark.parametrize("visible", [1.0, 0.4])
def test_uncertainty_is_the_size_of_the_error(visible):
    points_m, k, rate, random = scene(4, points=300, frames=40)
    speed = np.linalg.norm(rate, axis=1)
    tracks = glinting(
        tracks_of(points_m, k, rate),
        Glint(visible=visible, noise_cells=0.5),
        rotation_rate_rad_per_s=speed,
        random=random,
    )
    result = factorize(tracks)
    alignment = align(result.shape_m, points_m[result.points], with_scale=True)
    error_m = np.linalg.norm(alignment.apply(result.shape_m) - points_m[result.points], axis=1)
    assert np.sqrt(np.mean((error_m / result.uncertainty_m) ** 2)) == pytest.approx(1, abs=0.35)


def test_flat_targets_are_reported():
    points_m, k, rate, _ = scene(5)
    with pytest.raises(UnobservableShape, match="two dimensions"):
        factorize(tracks_of(points_m * [1, 1, 0], k, rate))


def test_tracks_that_hardly_overlap_are_refused():
    tracks = np.full((5, 8, 2), np.nan)
    tracks[np.arange(5), np.arange(5)] = 1.0
    with pytest.raises(ValueError, match="linked"):
        factorize(tracks)
    with pytest.raises(ValueError, match="frames, points, 2"):
        factorize(np.zeros((5, 8, 3)))
