import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.benchmarks.workload import cubic_grid, satellite_views
from core.hull.surface import hull_surface
from core.hull.volume import VoteVolume
from core.measurement.resampling import frame_groups, resampled
from core.measurement.sensitivity import displaced_views

GRID = cubic_grid(32)
VIEWS = satellite_views(8, segments=16)


def widths_m(surface):
    return np.ptp(surface.vertices_m, axis=0)


def from_scratch(views, misses=0):
    volume = VoteVolume(GRID)
    volume.add_many(views)
    return widths_m(hull_surface(volume, len(views) - misses))


@pytest.mark.parametrize("misses", [0, 1])
def test_resampled_hulls_are_those_from_scratch(misses):
    groups = frame_groups(8, 4)
    numbers = resampled(VIEWS, GRID, widths_m, cells=1.5, groups=groups, tolerated_misses=misses)
    assert np.array_equal(numbers.values, from_scratch(VIEWS, misses))
    for group, values in zip(groups, numbers.without_group, strict=True):
        rest = [view for place, view in enumerate(VIEWS) if place not in group]
        assert np.array_equal(values, from_scratch(rest, misses))
        assert np.all(values >= numbers.values)
    for cells, values in ((-1.5, numbers.eroded), (1.5, numbers.dilated)):
        assert np.array_equal(values, from_scratch(displaced_views(VIEWS, cells), misses))
    assert np.all(numbers.eroded <= numbers.values)
    assert np.all(numbers.values <= numbers.dilated)


@given(frames=st.integers(3, 200), groups=st.integers(3, 20), seed=st.integers(0, 9))
def test_groups_hold_every_frame_once_and_evenly(frames, groups, seed):
    grouping = ("interleaved", "consecutive")[seed % 2]
    found = frame_groups(frames, groups, grouping)
    assert len(found) == min(frames, groups)
    assert sorted(np.concatenate(found).tolist()) == list(range(frames))
    sizes = [len(group) for group in found]
    assert max(sizes) - min(sizes) <= 1


def test_silhouettes_that_erode_to_nothing_lose_every_number():
    numbers = resampled(VIEWS, GRID, widths_m, cells=100.0, groups=frame_groups(8, 3))
    assert np.isnan(numbers.eroded).all()
