import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.factorization.low_rank import first_guess, fit_complete, fit_incomplete


def rows_of(random, *, rows=24, points=40):
    motion, shape = random.normal(size=(rows, 3)), random.normal(size=(points, 3))
    return motion @ shape.T + random.normal(size=(rows, 1))


@settings(max_examples=15)
@given(seed=st.integers(0, 2**32 - 1))
def test_without_gaps_both_fits_are_the_same(seed):
    random = np.random.default_rng(seed)
    rows = rows_of(random) + 0.1 * random.normal(size=(24, 40))
    everything = np.ones_like(rows)
    start = first_guess(rows, np.where(random.random(rows.shape) < 0.8, 1.0, 0.0))
    best = fit_incomplete(rows, everything, start)
    assert best.squared_error == pytest.approx(fit_complete(rows).squared_error, rel=1e-4)


@settings(max_examples=15)
@given(seed=st.integers(0, 2**32 - 1))
def test_gaps_are_filled_as_the_truth_has_them(seed):
    random = np.random.default_rng(seed)
    rows = rows_of(random)
    weights = np.where(random.random(rows.shape) < 0.7, 1.0, 0.0)
    spoilt = np.where(weights > 0, rows, np.nan)
    fit = fit_incomplete(spoilt, weights, first_guess(spoilt, weights))
    assert np.abs(fit.residual(rows)).max() < 1e-6


def test_a_weight_of_nothing_is_a_gap():
    random = np.random.default_rng(4)
    rows = rows_of(random)
    weights = np.ones_like(rows)
    weights[3, 5] = weights[10, 7] = 0
    spoilt = rows + 1e3 * (weights == 0)
    fit = fit_incomplete(spoilt, weights, first_guess(spoilt, weights))
    assert np.abs(fit.residual(rows)).max() < 1e-6
