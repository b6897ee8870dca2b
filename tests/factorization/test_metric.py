import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from core.factorization.metric import solve_metric
from tests.factorization.paths import cone_path, generic_path


@settings(max_examples=25)
@given(seed=st.integers(0, 2**32 - 1))
def test_any_affine_frame_is_made_metric(seed):
    random = np.random.default_rng(seed)
    k, rate = generic_path(15, random)
    affine = random.normal(size=(3, 3)) + 2 * np.eye(3)
    assume(np.linalg.cond(affine) < 30)
    metric = solve_metric(k @ affine, rate @ affine)
    assume(metric.singular_ratio > 1e-4)
    turn = affine @ metric.upgrade
    assert turn @ turn.T == pytest.approx(np.eye(3), abs=1e-6)
    assert metric.rms < 1e-8


def test_a_turn_at_a_constant_angle_leaves_the_metric_open():
    k, rate = cone_path(20, 0.4)
    assert solve_metric(k, rate).singular_ratio < 1e-12


def test_noise_that_makes_the_linear_solution_indefinite_still_gives_a_metric():
    random = np.random.default_rng(8)
    k, rate = generic_path(6, random)
    noisy = k + 0.5 * random.normal(size=k.shape)
    assert np.all(np.isfinite(solve_metric(noisy, rate).upgrade))
