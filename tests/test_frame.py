import numpy as np
import pytest

from core.frame import Frame
from core.geometry.projection import Projection


def frame(**change):
    fields = {
        "amplitude": np.ones((4, 4)),
        "projection": Projection(matrix=[[1.0, 0, 0, 0], [0, 1, 0, 0]]),
        "time_s": 0.0,
        "sensor": "optical",
        "line_of_sight": [0.0, 0, 1],
    }
    return Frame(**{**fields, **change})


def test_a_frame_need_not_know_the_sun():
    assert frame().sun_direction is None
    assert frame(sun_direction=[0.6, 0, -0.8]).sun_direction == pytest.approx([0.6, 0, -0.8])


@pytest.mark.parametrize(
    ("name", "title"),
    [("line_of_sight", "line of sight"), ("sun_direction", "sun's direction")],
)
def test_directions_must_be_unit_vectors(name, title):
    with pytest.raises(ValueError, match=f"The {title} must be a unit vector"):
        frame(**{name: [0.0, 0, 2]})
