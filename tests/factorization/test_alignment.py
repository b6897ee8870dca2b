import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import ortho_group

from core.factorization.alignment import align, compare_lines, oriented_by_lines_of_sight
from core.factorization.factorization import factorize
from core.factorization.tracks import tracks_of
from core.targets import LineFeature
from tests.factorization.paths import generic_path

LINES = ((27.69, (-0.97, 0.26, 0.0)), (58.12, (1.0, 0.0, 0.0)), (15.88, (0.0, 0.0, 1.0)))
FEATURES = tuple(
    LineFeature(name=f"line {number}", length_m=length_m, direction=np.array(direction))
    for number, (length_m, direction) in enumerate(LINES)
)
ENDS = np.arange(6).reshape(3, 2)


def points_with_lines(random):
    """Six end points of the three lines, then others."""
    middles = random.normal(size=(3, 3))
    halves = np.array([feature.direction * feature.length_m / 2 for feature in FEATURES])
    ends = np.stack([middles - halves, middles + halves], axis=1).reshape(6, 3)
    return np.concatenate([ends, random.normal(size=(30, 3)) * 5])


@settings(max_examples=20)
@given(seed=st.integers(0, 2**32 - 1), scale=st.floats(0.1, 10))
def test_a_similarity_is_found_again(seed, scale):
    random = np.random.default_rng(seed)
    points = random.normal(size=(12, 3))
    turn = ortho_group.rvs(3, random_state=random)
    found = align(points, scale * points @ turn.T + [1, 2, 3], with_scale=True)
    assert found.scale == pytest.approx(scale)
    assert found.orthogonal == pytest.approx(turn, abs=1e-9)
    assert found.rms_m < 1e-9 * max(scale, 1)


def test_without_scale_a_blown_up_shape_stays_so():
    points = np.random.default_rng(1).normal(size=(30, 3))
    found = align(1.1 * points, points)
    assert found.scale == 1
    assert found.rms_m == pytest.approx(0.1 * np.sqrt(np.sum(points.var(axis=0))), rel=1e-9)


def test_exact_tracks_give_lengths_and_attitude_by_the_known_lines_of_sight():
    random = np.random.default_rng(11)
    points = points_with_lines(random)
    k, rate = generic_path(30, random)
    result = factorize(tracks_of(points, k, rate))
    shape = oriented_by_lines_of_sight(result, k)
    for line in compare_lines(shape, ENDS, FEATURES):
        assert line.length_error == pytest.approx(0, abs=1e-9)
        assert line.scale_factor == pytest.approx(1)
        assert line.attitude_error_rad < 1e-7


def test_one_known_length_scales_the_others():
    points = points_with_lines(np.random.default_rng(12)) * 0.5
    unscaled = compare_lines(points, ENDS, FEATURES)
    assert [line.length_error for line in unscaled] == pytest.approx([-0.5] * 3)
    assert [line.scale_factor for line in unscaled] == pytest.approx([2.0] * 3)
    scaled = compare_lines(points, ENDS, FEATURES, known=1)
    assert [line.length_m for line in scaled] == pytest.approx([27.69, 58.12, 15.88])


def test_lines_without_ends_are_refused():
    points = np.zeros((6, 3))
    with pytest.raises(ValueError, match="coincide"):
        compare_lines(points, ENDS, FEATURES)
    with pytest.raises(ValueError, match="two end points"):
        compare_lines(points, ENDS[:2], FEATURES)
