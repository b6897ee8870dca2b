import numpy as np

from core.benchmarks.workload import (
    ATTITUDE,
    BODY_LENGTH_M,
    PANEL_SPAN_M,
    degenerate_task,
    satellite,
    satellite_views,
)


def test_the_workload_is_the_same_every_time_and_has_holes() -> None:
    one, other = satellite_views(6), satellite_views(6)
    for a, b in zip(one, other, strict=True):
        for ring, same in zip(a.silhouette.rings, b.silhouette.rings, strict=True):
            np.testing.assert_array_equal(ring, same)
    rings = [len(view.silhouette.rings) for view in one]
    vertices = [sum(map(len, view.silhouette.rings)) for view in one]
    assert max(rings) > 1
    assert 80 < np.mean(vertices) < 200
    assert all(0 < ring.min() < ring.max() < 511 for v in one for ring in v.silhouette.rings)


def test_the_body_is_as_long_as_it_says() -> None:
    points = ATTITUDE.inv().apply(np.concatenate(satellite()))
    assert np.isclose(np.ptp(points[:, 1]), PANEL_SPAN_M)
    assert np.isclose(np.ptp(points[:, 2]), BODY_LENGTH_M)


def test_degenerate_outlines_lie_on_voxel_centres_and_have_holes() -> None:
    task = degenerate_task(size=17)
    assert sum(len(view.silhouette.rings) > 1 for view in task.views) > 3
    for view in task.views:
        doubled = 2 * np.concatenate(view.silhouette.rings)
        np.testing.assert_array_equal(doubled, np.rint(doubled))
