import numpy as np
import pytest

from core.geometry.grid import VoxelGrid
from core.geometry.projection import range_doppler_projection
from core.hull.surface import hull_surface, mask_surface
from core.hull.view import View
from core.hull.volume import VoteVolume
from core.measurement.extents import axis_extents
from core.silhouettes.silhouette import Silhouette, clockwise_area_px
from tests.measurement.test_observability import square_view

GRID = VoxelGrid.cube(side_m=8.0, spacing_m=0.25)


def box(lower_m, upper_m):
    centres = GRID.centres_m()
    return mask_surface(np.all((centres > lower_m) & (centres < upper_m), axis=-1), GRID)


def test_extents_are_the_boxes_sides():
    views = [square_view([0, 0, 1]), square_view([0, 1, 0])]
    extents = axis_extents(box([-3, -2, -1], [3, 2, 1.5]), GRID, views)
    assert [extent.value_m for extent in extents] == pytest.approx([6, 4, 2.5])
    assert all(extent.is_bounded and extent.observability == "good" for extent in extents)


def test_an_unobserved_extent_is_not_bounded_even_within_the_grid():
    extents = axis_extents(box([-3, -2, -1], [3, 2, 1.5]), GRID, [square_view([0, 0, 1])] * 2)
    assert [extent.is_bounded for extent in extents] == [True, True, False]
    assert [extent.observability for extent in extents] == ["good", "good", "unobserved"]


def test_an_empty_hull_has_no_extents():
    with pytest.raises(ValueError, match="empty"):
        axis_extents(box([9, 9, 9], [10, 10, 10]), GRID, [])


def slanted_prism(side_m):
    """The hull of views of one plane, blind along (0, 0.5, 0.87), on a grid of a given side."""
    grid = VoxelGrid.cube(side_m=side_m, spacing_m=0.25)
    turn = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    ring = 32 + 15 * np.column_stack([np.sin(turn), np.cos(turn)])
    ring = ring if clockwise_area_px(ring) > 0 else ring[::-1]
    outline = Silhouette(rings=(ring,), image_shape=(64, 64), claim="complete")
    blind = np.array([0, 0.5, np.sqrt(0.75)])
    volume, views = VoteVolume(grid), []
    for angle in np.linspace(0, np.pi, 12, endpoint=False):
        across = np.array([1.0, 0, 0])
        up = np.cross(blind, across)
        views.append(
            View(
                silhouette=outline,
                projection=range_doppler_projection(
                    line_of_sight=np.cos(angle) * across + np.sin(angle) * up,
                    line_of_sight_rate_per_s=np.cos(angle) * up - np.sin(angle) * across,
                    row_spacing_m=0.1,
                    column_spacing_m=0.1,
                    shape=(64, 64),
                ),
            )
        )
        volume.add(views[-1])
    return axis_extents(hull_surface(volume), grid, views)


def test_an_open_hull_is_measured_only_where_no_grid_can_change_it():
    small, large = slanted_prism(12.0), slanted_prism(16.0)
    assert [extent.is_bounded for extent in small] == [True, False, False]
    assert [extent.is_bounded for extent in large] == [True, False, False]
    assert small[0].value_m == pytest.approx(large[0].value_m)
    assert small[0].value_m == pytest.approx(3.0, abs=0.25)
    assert small[1].value_m < large[1].value_m - 1
