import numpy as np
import pytest
from scipy.spatial import KDTree

from core.factorization.tracks import Glint, glinting, tracks_of
from core.geometry.projection import range_doppler_projection
from tests.factorization.paths import generic_path

RANDOM = np.random.default_rng(3)
POINTS_M = RANDOM.normal(size=(300, 3)) * [8, 4, 3]
K, RATE = generic_path(20, RANDOM)
SPEED = np.linalg.norm(RATE, axis=1)
TRACKS = tracks_of(POINTS_M, K, RATE)


def spoilt(**changes):
    random = np.random.default_rng(5)
    return glinting(TRACKS, Glint(**changes), rotation_rate_rad_per_s=SPEED, random=random)


def test_perfect_tracks_are_what_the_images_show():
    for k, rate, speed, track in zip(K, RATE, SPEED, TRACKS, strict=True):
        projection = range_doppler_projection(
            line_of_sight=k,
            line_of_sight_rate_per_s=rate,
            row_spacing_m=0.5,
            column_spacing_m=0.25,
            shape=(64, 32),
        )
        pixels = track / [0.5, 0.25 * speed] + [32, 16]
        assert projection.image_points(POINTS_M) == pytest.approx(pixels)


def test_without_glint_tracks_stay():
    assert spoilt() == pytest.approx(TRACKS, rel=1e-12)


def test_the_share_of_points_seen_is_as_asked():
    seen = np.isfinite(spoilt(visible=0.3)[..., 0])
    assert seen.mean() == pytest.approx(0.3, abs=4 * np.sqrt(0.21 / seen.size))


def test_noise_is_measured_in_cells():
    cells = (spoilt(noise_cells=0.5) - TRACKS) / np.stack([0.15 + 0 * SPEED, 0.15 * SPEED], 1)[
        :, None
    ]
    assert cells.std(axis=(0, 1)) == pytest.approx([0.5, 0.5], rel=0.05)


def test_jumps_go_to_the_nearest_neighbours_in_the_image():
    jumped = spoilt(jump=0.2)
    moved = np.any(~np.isclose(jumped, TRACKS, rtol=1e-9), axis=2)
    assert moved.mean() == pytest.approx(0.2, abs=0.03)
    for speed, before, after, which in zip(SPEED, TRACKS, jumped, moved, strict=True):
        _, nearest = KDTree(before / [1, speed]).query(before[which] / [1, speed], k=5)
        distance = np.linalg.norm((before[nearest] - after[which, None]) / [1, speed], axis=2)
        assert np.all(distance.min(axis=1) < 1e-9)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [({"visible": 1.5}, "probability"), ({"neighbours": 0}, "neighbour"),
     ({"range_resolution_m": 0.0}, "cell")],
)  # fmt: skip
def test_impossible_glint_is_refused(wrong, message):
    with pytest.raises(ValueError, match=message):
        Glint(**wrong)
