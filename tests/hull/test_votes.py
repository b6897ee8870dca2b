import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from core.geometry.grid import VoxelGrid
from core.geometry.projection import Projection, range_doppler_projection
from core.hull.view import View
from core.hull.volume import VoteVolume
from core.silhouettes.silhouette import Silhouette, clockwise_area_px

GRID = VoxelGrid.cube(side_m=12.0, spacing_m=0.5)


def clockwise(ring):
    return ring if clockwise_area_px(ring) > 0 else ring[::-1]


def random_view(seed):
    """A star-shaped outline with a hole, seen from a random direction."""
    random = np.random.default_rng(seed)
    # No gap so wide that an edge could cut into the hole.
    angle = 2 * np.pi * (np.arange(17) + random.uniform(0, 1, 17)) / 17
    radius = random.uniform(30, 90, 17)
    centre = random.uniform(230, 280, 2)
    ring = centre + np.column_stack([radius * np.sin(angle), radius * np.cos(angle)])
    turn = np.linspace(0, 2 * np.pi, 9, endpoint=False)
    hole = centre + 12 * np.column_stack([np.sin(turn), np.cos(turn)])
    return View(
        silhouette=Silhouette(
            rings=(clockwise(ring), clockwise(hole)[::-1]),
            image_shape=(512, 512),
            claim="lit side",
        ),
        projection=random_projection(random),
    )


def random_projection(random):
    direction = random.normal(size=3)
    direction /= np.linalg.norm(direction)
    return range_doppler_projection(
        line_of_sight=direction,
        line_of_sight_rate_per_s=random.normal(size=3),
        row_spacing_m=0.06,
        column_spacing_m=0.06,
        shape=(512, 512),
    )


def reference_votes(view, grid):
    """The obvious way: project every voxel and ask a geometry library."""
    outer, hole = view.silhouette.rings
    polygon = shapely.Polygon(outer, [hole])
    image = view.projection.image_points(grid.centres_m())
    return shapely.intersects_xy(polygon, image[..., 0], image[..., 1])


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 2**32 - 1))
def test_votes_equal_the_obvious_reference(seed):
    view = random_view(seed)
    volume = VoteVolume(GRID)
    volume.add(view)
    assert np.array_equal(volume.votes, reference_votes(view, GRID))


@settings(max_examples=20, deadline=None)
@given(seed=st.integers(0, 2**32 - 1))
def test_a_perspective_view_votes_like_its_projection(seed):
    view = random_view(seed)
    towards = view.projection.viewing_direction()
    depth = np.append(towards, 40.0)
    centre = np.array([256.0, 256.0])
    affine = view.projection.matrix.copy()
    affine[:, 3] -= centre
    matrix = np.vstack([40 * affine + centre[:, None] * depth, depth])
    camera = View(silhouette=view.silhouette, projection=Projection(matrix=matrix))
    volume = VoteVolume(GRID)
    volume.add(camera)
    assert np.array_equal(volume.votes, reference_votes(camera, GRID))


@settings(max_examples=15, deadline=None)
@given(seed=st.integers(0, 2**32 - 1))
def test_order_is_irrelevant_and_removal_undoes(seed):
    views = [random_view(seed + number) for number in range(4)]
    forward, backward = VoteVolume(GRID), VoteVolume(GRID)
    for view in views:
        forward.add(view)
    for view in reversed(views):
        backward.add(view)
    assert np.array_equal(forward.votes, backward.votes)
    extra = forward.add(random_view(seed + 99))
    forward.remove(extra)
    assert np.array_equal(forward.votes, backward.votes)
    assert forward.view_count == 4


@settings(max_examples=15, deadline=None)
@given(seed=st.integers(0, 2**32 - 1))
def test_another_view_never_adds_volume(seed):
    volume = VoteVolume(GRID)
    volume.add(random_view(seed))
    before = volume.hull()
    volume.add(random_view(seed + 1))
    assert not np.any(volume.hull() & ~before)


def test_an_empty_silhouette_votes_for_nothing():
    volume = VoteVolume(GRID)
    empty = Silhouette(rings=(), image_shape=(512, 512), claim="complete")
    volume.add(View(silhouette=empty, projection=random_view(0).projection))
    assert not volume.votes.any()
    assert not volume.hull().any()


def test_thresholds_outside_the_views_are_refused():
    volume = VoteVolume(GRID)
    with pytest.raises(ValueError, match="No views have voted"):
        volume.hull()
    volume.add(random_view(1))
    with pytest.raises(ValueError, match="between 1 and the number of views, 1; got 2"):
        volume.hull(2)
    with pytest.raises(ValueError, match="got 0"):
        volume.hull(0)


def test_a_camera_inside_the_grid_is_refused():
    view = random_view(1)
    depth = np.append(view.projection.viewing_direction(), 1.0)
    inside = Projection(matrix=np.vstack([view.projection.matrix, depth]))
    with pytest.raises(ValueError, match="whole grid in front"):
        VoteVolume(GRID).add(View(silhouette=view.silhouette, projection=inside))


def test_votes_are_read_only():
    with pytest.raises(ValueError, match="read-only"):
        VoteVolume(GRID).votes[0, 0, 0] = 1
