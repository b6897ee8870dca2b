import numpy as np
import pytest

from core.benchmarks.reference import every_nth_plane, reference_stride, reference_votes
from core.benchmarks.workload import Task, degenerate_task, satellite_task
from core.hull.outline import OUTSET_PX
from core.hull.polygon_test import votes_of


@pytest.mark.parametrize(
    "task", [satellite_task(14, 4), degenerate_task(size=9)], ids=["satellite", "degenerate"]
)
def test_the_reference_is_the_papers_polygon_test(task: Task) -> None:
    centres = task.grid.centres_m().reshape(-1, 3)
    papers = sum(
        votes_of(view.projection.image_points(centres), view.silhouette.rings, OUTSET_PX).astype(
            int
        )
        for view in task.views
    )
    found = reference_votes(task, task.all_planes())
    np.testing.assert_array_equal(found.ravel(), papers)
    assert np.count_nonzero(found) > 0
    assert found.max() > 3


def test_planes_of_a_coarser_stride_are_among_the_finer_ones() -> None:
    fine, coarse = every_nth_plane(100, 8), every_nth_plane(100, 16)
    assert set(coarse) <= set(fine)
    assert list(every_nth_plane(5, 1)) == [0, 1, 2, 3, 4]
    assert reference_stride(satellite_task(32, 3)) == 1
