import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.hull.casting import Cancelled, Watch
from core.measurement.intervals import combined, jackknife_standard_error, measured_intervals
from core.measurement.resampling import Resampled, frame_groups
from tests.measurement.test_resampling import GRID, VIEWS, widths_m


def test_progress_is_told_and_it_can_be_cancelled():
    told = []
    watch = Watch(progress=lambda done, total: told.append((done, total)))
    intervals = measured_intervals(VIEWS, GRID, widths_m, groups=3, watch=watch)
    assert told == [(done, 6) for done in range(1, 7)]
    assert all(i.low < i.value < i.high and i.is_stated and not i.note for i in intervals)
    assert intervals[0].method == (
        "95 % interval: outlines ± 0.5 cells, and jackknife leaving out 3 groups of frames in "
        "turn, added in quadrature"
    )
    told.clear()
    watch = Watch(progress=watch.progress, cancel=lambda: len(told) == 2)
    with pytest.raises(Cancelled, match="after 2 of 6 hulls"):
        measured_intervals(VIEWS, GRID, widths_m, groups=3, watch=watch)


@settings(max_examples=40)
@given(seed=st.integers(0, 10**6), groups=st.integers(3, 12), size=st.integers(1, 5))
def test_of_a_mean_the_jackknife_is_the_standard_error_of_its_groups(seed, groups, size):
    frames = np.random.default_rng(seed).normal(3, 2, (groups * size, 2))
    chosen = frame_groups(len(frames), groups)
    without = np.array([np.delete(frames, group, axis=0).mean(axis=0) for group in chosen])
    means = np.array([frames[group].mean(axis=0) for group in chosen])
    wanted = means.std(axis=0, ddof=1) / np.sqrt(groups)
    assert jackknife_standard_error(frames.mean(axis=0), without) == pytest.approx(wanted)


def numbers(**changes):
    three = np.array([5.0, 10.0, np.nan])
    kept = {
        "values": np.array([5.0, 10.0, 1.0]),
        "eroded": three - 1,
        "dilated": three + 2,
        "without_group": np.repeat([[5.0, 10.0, 1.0]], 4, axis=0),
        "cells": 0.5,
        "groups": frame_groups(8, 4),
    }
    return Resampled(**{**kept, **changes})


def test_each_side_adds_its_sensitivity_and_the_jackknife_in_quadrature():
    first, _, lost = combined(numbers())
    assert (first.low, first.high) == (4.0, 7.0)
    without = np.repeat([[5.0, 10.0, 1.0]], 4, axis=0)
    without[:, 1] = [9, 9, 11, 11]
    _, second, _ = combined(numbers(without_group=without))
    error = 3.1824 * np.sqrt(3 / 4 * 4)  # t of three degrees of freedom
    assert second.low == pytest.approx(10 - np.hypot(1, error), abs=1e-3)
    assert second.high == pytest.approx(10 + np.hypot(2, error), abs=1e-3)
    assert not lost.is_stated


def test_what_is_lost_has_no_interval_and_says_why():
    without = np.repeat([[5.0, 10.0, 1.0]], 4, axis=0)
    without[2, 0] = np.nan
    first, second, third = combined(numbers(without_group=without))
    assert first.note == "no interval: it is lost without 1 of 4 groups of frames"
    assert second.is_stated
    assert third.note == (
        "no interval: it is lost when outlines are 0.5 cells smaller and when outlines are "
        "0.5 cells larger"
    )
    gone = combined(numbers(values=np.array([np.nan, 10, 1])))[0]
    assert gone.note == "lost on the hull itself"


@pytest.mark.parametrize(
    ("views", "cells", "message"),
    [(VIEWS[:2], 0.5, "at least 3 frames"), (VIEWS, 0.0, "positive number of cells")],
)
def test_what_cannot_be_resampled_is_refused(views, cells, message):
    with pytest.raises(ValueError, match=message):
        measured_intervals(views, GRID, widths_m, cells=cells)
