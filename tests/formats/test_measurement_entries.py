import numpy as np
import pytest

from core.formats.measurement_entries import reading_of
from core.geometry.directions import Direction
from core.measurement.results import Measurement


def test_a_reading_gives_its_direction_in_the_frame_of_choice():
    found = Measurement(name="l", value=2.0, unit="m", direction=np.array([1.0, 0, 0]))
    assert reading_of(found).frame == "target"
    both = Direction(
        target=found.direction, rtn=[0, 1, 0], teme=[0, 0, 1], epoch_utc="2026-03-01T12:00:00Z"
    )
    inertial = reading_of(found, direction=both, frame="TEME", low=1.9, high=2.1)
    assert (inertial.frame, inertial.epoch_utc) == ("TEME", "2026-03-01T12:00:00Z")
    np.testing.assert_array_equal(inertial.direction, [0, 0, 1])
    np.testing.assert_array_equal(
        reading_of(found, direction=both, frame="RTN").direction, [0, 1, 0]
    )
    with pytest.raises(ValueError, match="needs the satellite's orbit"):
        reading_of(found, frame="RTN")
