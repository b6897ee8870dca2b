import numpy as np
import pytest

from core.geometry.grid import VoxelGrid
from core.geometry.projection import range_doppler_projection
from core.hull.surface import mask_surface
from core.measurement.extents import axis_extents, unobserved_direction

GRID = VoxelGrid.cube(side_m=8.0, spacing_m=0.25)


def box(lower_m, upper_m):
    centres = GRID.centres_m()
    return mask_surface(np.all((centres > lower_m) & (centres < upper_m), axis=-1), GRID)


def test_extents_are_the_boxes_sides():
    extents = axis_extents(box([-3, -2, -1], [3, 2, 1.5]), GRID)
    assert [extent.value_m for extent in extents] == pytest.approx([6, 4, 2.5])
    assert all(extent.is_bounded for extent in extents)


def test_a_hull_that_touches_the_grid_is_not_bounded_there():
    extents = axis_extents(box([-3, -9, -1], [3, 9, 1.5]), GRID)
    assert [extent.is_bounded for extent in extents] == [True, False, True]


def projections(normals):
    return [
        range_doppler_projection(
            line_of_sight=np.cross(normal, [0.3, 0.5, 0.8])
            / np.linalg.norm(np.cross(normal, [0.3, 0.5, 0.8])),
            line_of_sight_rate_per_s=np.cross(normal, np.cross(normal, [0.3, 0.5, 0.8])),
            row_spacing_m=0.1,
            column_spacing_m=0.1,
            shape=(64, 64),
        )
        for normal in np.asarray(normals, float)
    ]


def test_planes_that_nearly_coincide_leave_their_normal_unobserved():
    direction = unobserved_direction(projections([[0, 0, 1], [0, 0.1, 1], [0.1, 0, 1]]))
    assert abs(direction[2]) > 0.99


def test_two_planes_at_an_angle_observe_everything():
    assert unobserved_direction(projections([[0, 0, 1], [0, 1, 0]])) is None


def test_an_empty_hull_has_no_extents():
    with pytest.raises(ValueError, match="empty"):
        axis_extents(box([9, 9, 9], [10, 10, 10]), GRID)
