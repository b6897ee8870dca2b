import numpy as np
import pytest

from core.arrays import frozen


def test_what_is_frozen_already_is_not_copied():
    array = np.zeros((4, 3))
    assert frozen(array, np.float64, (None, 3), "Points") is not array
    array.flags.writeable = False
    assert frozen(array, np.float64, (None, 3), "Points") is array


def test_a_read_only_view_of_someone_elses_data_is_copied():
    array = np.zeros((4, 3))
    view = array[:]
    view.flags.writeable = False
    kept = frozen(view, np.float64, (None, 3), "Points")
    array[:] = 1.0
    assert not kept.any()


def test_what_is_not_finite_is_refused():
    with pytest.raises(ValueError, match="Points: 1 of 3 values are NaN or infinite"):
        frozen([[0.0, np.nan, 1.0]], np.float64, (None, 3), "Points")
