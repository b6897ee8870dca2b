import threading

import numpy as np
import pytest

from core.benchmarks.measuring import peak_bytes
from core.benchmarks.workload import degenerate_task, satellite_task
from core.geometry.grid import VoxelGrid
from core.hull.casting import Cancelled, Watch
from core.hull.hull_only import carved_surface
from core.hull.surface import hull_surface
from core.hull.volume import VoteVolume
from core.silhouettes.silhouette import Silhouette
from tests.hull.test_mesher import GRID, box_view


def stored(views, grid, threshold=None):
    volume = VoteVolume(grid)
    volume.add_many(views)
    return hull_surface(volume, threshold)


def assert_same(one, other):
    assert np.array_equal(one.vertices_m, other.vertices_m)
    assert np.array_equal(one.faces, other.faces)


@pytest.mark.parametrize(("size", "views", "below"), [(70, 9, 0), (70, 9, 3), (49, 30, 12)])
def test_it_equals_the_surface_of_stored_votes(size, views, below):
    task = satellite_task(size, views)
    found = carved_surface(task.views, task.grid, views - below)
    assert len(found.faces) > 2000
    assert_same(found, stored(task.views, task.grid, views - below))


@pytest.mark.parametrize("threshold", [1, 7, 14, None])
def test_outlines_along_grid_lines_make_no_difference(threshold):
    task = degenerate_task()
    found = carved_surface(task.views, task.grid, threshold)
    assert_same(found, stored(task.views, task.grid, threshold))


def test_a_hull_that_fills_the_grid_is_closed_at_its_end():
    views = [box_view(axis, half_m=np.full(3, 40.0)) for axis in range(3)]
    found = carved_surface(views, GRID)
    assert found.volume_m3() == pytest.approx(8.0**3, rel=0.01)
    assert_same(found, stored(views, GRID))


def test_where_no_voxel_has_the_votes_there_is_no_surface():
    empty = Silhouette(rings=(), image_shape=(80, 80), claim="complete")
    view = type(box_view(0))(silhouette=empty, projection=box_view(0).projection)
    assert carved_surface([box_view(0), box_view(1), view], GRID).is_empty
    assert_same(
        carved_surface([box_view(0), box_view(1), view], GRID, 2),
        stored([box_view(0), box_view(1), view], GRID, 2),
    )


def test_more_than_255_views_vote_exactly():
    views = [box_view(axis) for axis in range(3)] * 90
    assert_same(carved_surface(views, GRID), stored(views, GRID))


def test_a_grid_beyond_memory_is_carved_in_little():
    grid = VoxelGrid.cube(side_m=8.0, spacing_m=8.0 / 2048)
    half_m = np.array([0.11, 0.07, 0.13])
    views = [box_view(axis, half_m=half_m) for axis in range(3)]
    carved_surface(views[:3], GRID)
    used, surface = peak_bytes(lambda: carved_surface(views, grid))
    assert surface.vertices_m.max(axis=0) == pytest.approx(half_m, abs=1e-6)
    assert surface.volume_m3() == pytest.approx(8 * half_m.prod(), rel=2e-3)
    assert used < 60e6
    with pytest.raises(ValueError, match=r"48 GiB.*carved_surface"):
        VoteVolume(grid)


def test_progress_counts_all_slabs():
    told = []
    carved_surface(
        [box_view(0), box_view(1)], GRID, watch=Watch(progress=lambda *done: told.append(done))
    )
    assert told == [(done, len(told)) for done in range(1, len(told) + 1)]
    assert len(told) == 2


def test_it_can_be_given_up():
    enough = threading.Event()
    told = []

    def stop(done, _total):
        told.append(done)
        enough.set()

    grid = VoxelGrid.cube(side_m=8.0, spacing_m=8.0 / 128)
    views = [box_view(0), box_view(1)]
    with pytest.raises(Cancelled, match=r"after 2 of 8 slabs"):
        carved_surface(views, grid, watch=Watch(progress=stop, cancel=enough.is_set))
    assert told == [1]
    assert not carved_surface(views, grid).is_empty


def test_impossible_wishes_are_refused():
    with pytest.raises(ValueError, match="No views have voted"):
        carved_surface([], GRID)
    with pytest.raises(ValueError, match="between 1 and the number of views, 1; got 2"):
        carved_surface([box_view(0)], GRID, 2)
