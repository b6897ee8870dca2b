import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.geometry.projection import Projection, range_doppler_projection

vector = st.lists(st.floats(-10, 10), min_size=3, max_size=3).map(np.array)


def radar_projection():
    return range_doppler_projection(
        line_of_sight=np.array([0.0, 0.6, 0.8]),
        line_of_sight_rate_per_s=np.array([0.01, 0.0, 0.0]),
        row_spacing_m=0.06,
        column_spacing_m=0.05,
        shape=(512, 256),
    )


@given(point=vector)
def test_rows_are_range_and_columns_cross_range(point):
    row, column = radar_projection().image_points(point)
    assert (row - 256) * 0.06 == pytest.approx(point @ [0.0, 0.6, 0.8], abs=1e-9)
    assert (column - 128) * 0.05 == pytest.approx(point[0], abs=1e-9)


@given(row=st.floats(0, 511), column=st.floats(0, 255))
def test_plane_points_project_back_and_lie_in_the_imaging_plane(row, column):
    projection = radar_projection()
    point = projection.plane_points(np.array([row, column]))
    assert projection.image_points(point) == pytest.approx([row, column], abs=1e-8)
    through_origin = point - projection.plane_points(np.array([256.0, 128.0]))
    assert through_origin @ projection.viewing_direction() == pytest.approx(0, abs=1e-9)


def test_a_line_of_sight_that_stands_still_has_no_projection():
    with pytest.raises(ValueError, match="stands still"):
        range_doppler_projection(
            line_of_sight=np.array([1.0, 0, 0]),
            line_of_sight_rate_per_s=np.array([0.5, 0, 0]),
            row_spacing_m=0.1,
            column_spacing_m=0.1,
            shape=(64, 64),
        )


def test_parallel_rows_are_refused():
    with pytest.raises(ValueError, match="onto a line"):
        Projection(matrix=[[1, 0, 0, 0], [2, 0, 0, 0]])
