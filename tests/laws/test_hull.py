"""What every visual hull obeys, whoever the target and wherever the views."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from core.geometry.grid import VoxelGrid
from core.geometry.projection import Projection
from core.hull.surface import hull_surface
from core.hull.view import View
from core.hull.volume import VoteVolume
from core.silhouettes.areas import rings_of
from core.silhouettes.silhouette import Silhouette
from tests.laws.outlines import LATTICE, lattice_projections, lattice_views

SEEDS = st.integers(0, 2**31)
GRID = VoxelGrid.cube(side_m=6.0, spacing_m=0.3)


def area_of(silhouette):
    """Return the area of valid rings, holes taken out."""
    area = shapely.Polygon()
    for ring in silhouette.rings:
        area = area.symmetric_difference(shapely.Polygon(ring))
    return area


def with_area(view, area):
    silhouette = Silhouette(
        rings=rings_of(area), image_shape=view.silhouette.image_shape, claim="complete"
    )
    return View(silhouette=silhouette, projection=view.projection)


def votes_of(grid, views):
    volume = VoteVolume(grid)
    volume.add_many(views)
    return volume.votes


def random_target(random):
    """Return two boxes askew, each (8, 3) corners, in metres."""
    boxes = []
    for _ in range(2):
        half = random.uniform(0.4, 1.2, 3)
        corners = np.array(np.meshgrid(*([-1, 1],) * 3)).reshape(3, 8).T * half
        turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
        boxes.append(corners @ turn.T + random.uniform(-0.6, 0.6, 3))
    return boxes


def random_projection(random, *, perspective):
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    matrix = np.column_stack([turn[:2] * 20, random.uniform(-40, 40, 2)])
    if not perspective:
        return Projection(matrix=matrix)
    depth = np.append(turn[2], 30.0)
    return Projection(matrix=np.vstack([30 * matrix, depth]))


def true_view(boxes, projection):
    """Return the view whose silhouette is the target's own shadow."""
    shadows = [shapely.convex_hull(shapely.multipoints(projection.image_points(b))) for b in boxes]
    outline = shapely.union_all(shadows)
    silhouette = Silhouette(rings=rings_of(outline), image_shape=(100, 100), claim="complete")
    return View(silhouette=silhouette, projection=projection)


def inside(box, points):
    """Return which points a box of 8 corners holds, from its three edges at corner 0."""
    edges = np.stack([box[1] - box[0], box[2] - box[0], box[4] - box[0]])
    part = (points - box[0]) @ edges.T / np.sum(edges**2, axis=1)
    return np.all((part >= 0) & (part <= 1), axis=-1)


@settings(max_examples=25, deadline=None)
@given(seed=SEEDS, perspective=st.booleans(), count=st.integers(1, 6))
def test_the_target_is_inside_its_hull(seed, perspective, count):
    random = np.random.default_rng(seed)
    boxes = random_target(random)
    projections = [random_projection(random, perspective=perspective) for _ in range(count)]
    volume = VoteVolume(GRID)
    volume.add_many([true_view(boxes, projection) for projection in projections])
    centres = GRID.centres_m()
    target = np.any([inside(box, centres) for box in boxes], axis=0)
    assert target.any()
    assert np.all(volume.hull()[target])


@settings(max_examples=60, deadline=None)
@given(one=lattice_views(), other=lattice_views())
def test_votes_are_monotone_in_silhouettes(one, other):
    """A larger silhouette never takes a vote away, a smaller one never adds one."""
    own, foreign = area_of(one.silhouette), area_of(other.silhouette)
    larger = with_area(one, shapely.union_all([own, foreign]))
    votes = votes_of(LATTICE, [one])
    assert np.all(votes_of(LATTICE, [larger]) >= votes)


@settings(max_examples=30, deadline=None)
@given(views=st.lists(lattice_views(), min_size=2, max_size=5), random=st.randoms())
def test_order_is_irrelevant_together_and_one_by_one(views, random):
    shuffled = list(views)
    random.shuffle(shuffled)
    volume = VoteVolume(LATTICE)
    for view in shuffled:
        volume.add(view)
    assert np.array_equal(volume.votes, votes_of(LATTICE, views))


@settings(max_examples=40, deadline=None)
@given(view=lattice_views(), shape=st.tuples(st.integers(1, 30), st.integers(1, 30)))
def test_an_outline_partly_outside_its_image_votes_all_the_same(view, shape):
    """Integer outlines reach from −7 to 7, so the image from 0 on never holds all of them."""
    cut = Silhouette(rings=view.silhouette.rings, image_shape=shape, claim="complete")
    moved = View(silhouette=cut, projection=view.projection)
    assert np.array_equal(votes_of(LATTICE, [moved]), votes_of(LATTICE, [view]))


@settings(max_examples=30, deadline=None)
@given(views=st.lists(lattice_views(), min_size=1, max_size=3), factor=st.sampled_from([2, 4]))
def test_a_refined_grid_agrees_where_centres_coincide(views, factor):
    fine = VoxelGrid(
        origin_m=LATTICE.origin_m,
        spacing_m=LATTICE.spacing_m / factor,
        shape=tuple(factor * (count - 1) + 1 for count in LATTICE.shape),
    )
    coarse = votes_of(fine, views)[::factor, ::factor, ::factor]
    assert np.array_equal(coarse, votes_of(LATTICE, views))


@pytest.mark.parametrize("method", ["snapped", "dual"])
@settings(max_examples=5, deadline=None)
@given(seed=SEEDS)
def test_a_refined_grid_converges_to_the_hull(method, seed):
    """A tilted box under views along its own axes is its own hull, whose volume is known."""
    random = np.random.default_rng(seed)
    half = random.uniform(0.8, 1.4, 3)
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    box = [np.array(np.meshgrid(*([-1, 1],) * 3)).reshape(3, 8).T * half @ turn]
    views = []
    for axis in range(3):
        rows = np.delete(turn, axis, axis=0)
        projection = Projection(matrix=np.column_stack([20 * rows, np.full(2, 50.0)]))
        views.append(true_view(box, projection))
    lost = []
    for spacing_m in (0.3, 0.1):
        volume = VoteVolume(VoxelGrid.cube(side_m=6.0, spacing_m=spacing_m))
        volume.add_many(views)
        surface = hull_surface(volume, method=method)
        lost.append(abs(surface.volume_m3() / (8 * half.prod()) - 1))
    assert lost[1] < 0.5 * lost[0] + 1e-4
    assert lost[1] < (0.02 if method == "snapped" else 0.005)


@settings(max_examples=20, deadline=None)
@given(seed=SEEDS, axes=st.permutations(range(3)), mirrored=st.booleans())
def test_turned_and_mirrored_surfaces_enclose_the_same(seed, axes, mirrored):
    random = np.random.default_rng(seed)
    boxes = random_target(random)
    views = [true_view(boxes, random_projection(random, perspective=False)) for _ in range(4)]
    sign = np.array([-1.0 if mirrored else 1.0, 1.0, 1.0])
    turned = []
    for view in views:
        matrix = view.projection.matrix.copy()
        matrix[:, :3] = (matrix[:, :3] * sign)[:, axes]
        turned.append(View(silhouette=view.silhouette, projection=Projection(matrix=matrix)))
    volumes = []
    for chosen in (views, turned):
        volume = VoteVolume(GRID)
        volume.add_many(chosen)
        volumes.append(hull_surface(volume, method="dual").volume_m3())
    assert volumes[1] == pytest.approx(volumes[0], rel=2e-3)


@settings(max_examples=40, deadline=None)
@given(projection=lattice_projections(), scale=st.integers(-3, 3))
def test_edge_on_views_are_refused_in_one_sentence(projection, scale):
    matrix = projection.matrix.copy()
    matrix[1, :3] = scale * matrix[0, :3]
    with pytest.raises(ValueError, match=r"maps the target onto a line: [^.]*\. Does [^.]*\?$"):
        Projection(matrix=matrix)
