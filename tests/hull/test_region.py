import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.geometry.projection import Projection
from core.hull.region import reach_on_planes, regions_of_interest
from core.hull.volume import VoteVolume
from core.hull.votes import Voter
from core.silhouettes.silhouette import Silhouette
from tests.hull.test_mesher import GRID as BOX_GRID
from tests.hull.test_mesher import HALF_M, box_view
from tests.hull.test_votes import GRID, random_view
from tests.laws.cameras import camera_like


def regions(views, grid, threshold, step=5):
    voters = [Voter.of(view, grid) for view in views]
    planes = np.array([*range(0, grid.shape[0] - 1, step), grid.shape[0] - 1])
    return regions_of_interest(voters, grid, threshold, planes)


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 2**31), below=st.integers(0, 3), perspective=st.booleans())
def test_the_hull_lies_inside_its_windows_rim(seed, below, perspective):
    views = [random_view(seed + number) for number in range(5)]
    if perspective:
        views = [camera_like(view, 25.0) for view in views]
    volume = VoteVolume(GRID)
    volume.add_many(views)
    hull = volume.hull(5 - below)
    for number, window in enumerate(regions(views, GRID, 5 - below)):
        first, last = 5 * number, min(5 * number + 5, GRID.shape[0] - 1)
        planes = hull[first : last + 1].copy()
        if window is not None:
            assert window.low[0] == first
            assert window.shape[0] == last - first + 1
            inside = [
                slice(low + (low > 0), low + count - (low + count < side))
                for low, count, side in zip(
                    window.low[1:], window.shape[1:], GRID.shape[1:], strict=True
                )
            ]
            planes[:, inside[0], inside[1]] = False
        assert not planes.any()


def test_windows_fit_a_box_tightly():
    spans = [window for window in regions([box_view(a) for a in range(3)], BOX_GRID, 3) if window]
    voxels = np.floor(HALF_M / BOX_GRID.spacing_m + 0.5)
    assert {window.shape[1:] for window in spans} == {(2 * voxels[1] + 2, 2 * voxels[2] + 2)}


def test_a_plane_seen_edge_on_bounds_nothing_and_an_empty_outline_everything():
    view = box_view(2)
    reach = reach_on_planes(Voter.of(view, BOX_GRID), np.array([3]))[0]
    assert np.array_equal(reach, [[-np.inf, -np.inf], [np.inf, np.inf]])
    empty = Silhouette(rings=(), image_shape=(80, 80), claim="complete")
    nothing = Voter.of(type(view)(silhouette=empty, projection=view.projection), BOX_GRID)
    reach = reach_on_planes(nothing, np.array([3]))[0]
    assert np.array_equal(reach, [[np.inf, np.inf], [-np.inf, -np.inf]])


def test_reach_is_that_of_the_outlines_rays():
    view = box_view(0)
    skewed = view.projection.matrix.copy()
    skewed[0, 0] = 2.0
    projection = Projection(matrix=skewed)
    voter = Voter.of(type(view)(silhouette=view.silhouette, projection=projection), BOX_GRID)
    for plane in (0, 17):
        x_m = BOX_GRID.origin_m[0] + BOX_GRID.spacing_m * plane
        least, greatest = reach_on_planes(voter, np.array([plane]))[0]
        reach_m = BOX_GRID.origin_m[1:] + BOX_GRID.spacing_m * np.array([least, greatest])
        assert reach_m[:, 0] == pytest.approx([-HALF_M[1] - x_m / 5, HALF_M[1] - x_m / 5], abs=1e-6)
        assert reach_m[:, 1] == pytest.approx([-HALF_M[2], HALF_M[2]], abs=1e-6)
