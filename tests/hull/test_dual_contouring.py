import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from core.geometry.grid import VoxelGrid
from core.geometry.projection import Projection
from core.hull import dual_contouring
from core.hull.cube_cases import EDGES, edge_tables, loops, triangle_table
from core.hull.dual_cases import parted_loops, twice_passed_table
from core.hull.dual_contouring import (
    REGULARISATION,
    Crossings,
    contoured,
    dual_surface,
    hull_crossings,
)
from core.hull.slab_mesh import mesh_slab
from core.hull.surface import hull_surface
from core.hull.view import View
from core.hull.volume import VoteVolume
from tests.hull.test_mesher import GRID, HALF_M, box_volume
from tests.hull.test_votes import random_view
from tests.laws.outlines import LATTICE, lattice_views

CORNERS = [(corner >> 1 & 1, corner & 1, corner >> 2) for corner in range(8)]


def random_crossings(votes, seed):
    """The crossed edges of any votes, crossed anywhere under any normals."""
    random = np.random.default_rng(seed)
    layers = (-1, votes.shape[0])
    crossed, _ = mesh_slab(votes, 1, *layers, triangle_table(), edge_tables())
    places = crossed[:, :3].astype(float)
    places[np.arange(len(crossed)), crossed[:, 3] & 3] += random.uniform(0, 1, len(crossed))
    normals = random.normal(size=places.shape)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return Crossings(crossed=crossed, places=places, normals=normals)


def reference_vertices(votes, crossings):
    """The obvious way: cube by cube; for each edge (its lower end and axis) its four vertices."""
    padded = np.pad(votes, 2) >= 1
    at = {
        (*map(int, row[:3]), int(row[3] & 3)): (place, normal)
        for row, place, normal in zip(
            crossings.crossed, crossings.places, crossings.normals, strict=True
        )
    }
    found = {key: [] for key in at}
    for cube in np.ndindex(*(count + 1 for count in votes.shape)):
        corner = np.array(cube) - 1
        for loop in reference_loops(padded, corner):
            keys = []
            for edge in loop:
                lower = corner + CORNERS[EDGES[edge][0]]
                keys.append((*map(int, lower), edge // 4))
            vertex = least_squares([at[key] for key in keys])
            end = np.array(votes.shape) - 0.5
            vertex = np.clip(vertex, np.maximum(corner, -0.5), np.minimum(corner + 1, end))
            for key in keys:
                found[key].append(vertex)
    return found


def reference_loops(padded, corner):
    def case_of(low):
        return sum(
            int(padded[tuple(low + step + 2)]) << number for number, step in enumerate(CORNERS)
        )

    case = case_of(corner)
    face = int(twice_passed_table()[case])
    if face < 0:
        return loops(case)
    across = case_of(corner + (2 * (face % 2) - 1) * np.eye(3, dtype=int)[face // 2])
    both = twice_passed_table()[across] == face ^ 1
    return parted_loops(case) if both else loops(case)


def least_squares(crossings):
    places, normals = (np.array(values) for values in zip(*crossings, strict=True))
    weight = np.sqrt(REGULARISATION)
    rows = np.concatenate([normals, weight * np.eye(3)])
    right = np.append(np.sum(normals * places, axis=1), weight * places.mean(axis=0))
    return np.linalg.lstsq(rows, right, rcond=None)[0]


def unit_grid(shape):
    return VoxelGrid(origin_m=np.zeros(3), spacing_m=1.0, shape=shape)


def assert_closed(surface):
    """Every edge has exactly two faces, which run along it in opposite directions."""
    steps = np.concatenate([surface.faces[:, [i, (i + 1) % 3]] for i in range(3)])
    directed, counts = np.unique(steps, axis=0, return_counts=True)
    assert counts.max(initial=1) == 1
    backward = np.unique(steps[:, ::-1], axis=0)
    assert np.array_equal(directed, backward)


random_votes = arrays(np.uint8, st.tuples(*[st.integers(2, 5)] * 3), elements=st.integers(0, 1))


@settings(max_examples=25, deadline=None)
@given(votes=random_votes, seed=st.integers(0, 2**31))
def test_vertices_equal_the_obvious_reference(votes, seed):
    crossings = random_crossings(votes, seed)
    surface = contoured(crossings, votes, 1, unit_grid(votes.shape))
    expected = reference_vertices(votes, crossings)
    for i, row in enumerate(crossings.crossed):
        used = surface.vertices_m[np.unique(surface.faces[2 * i : 2 * i + 2])]
        wanted = expected[(*map(int, row[:3]), int(row[3] & 3))]
        assert len(used) == len(wanted) == 4
        assert np.sort(used, axis=0) == pytest.approx(np.sort(wanted, axis=0), abs=1e-9)


@settings(max_examples=150, deadline=None)
@given(votes=random_votes, seed=st.integers(0, 2**31))
def test_every_edge_has_two_faces_whatever_the_votes(votes, seed):
    surface = contoured(random_crossings(votes, seed), votes, 1, unit_grid(votes.shape))
    assert_closed(surface)
    if not surface.is_empty:
        mesh = trimesh.Trimesh(surface.vertices_m, surface.faces, process=False)
        assert mesh.is_watertight
        assert np.all(np.unique(surface.faces) == np.arange(len(surface.vertices_m)))


@pytest.mark.parametrize("corners", [((0, 0, 0), (1, 1, 0)), ((0, 1, 0), (1, 0, 0))])
def test_two_cubes_that_pass_their_face_twice_are_parted(corners):
    """Outside along a diagonal of the common face, inside all around: the one such case."""
    votes = np.ones((4, 4, 3), dtype=np.uint8)
    for x, y, _ in corners:
        votes[1 + x, 1 + y, 1] = 0
    surface = contoured(random_crossings(votes, 1), votes, 1, unit_grid(votes.shape))
    assert_closed(surface)


@settings(max_examples=8, deadline=None)
@given(seed=st.integers(0, 2**31), below=st.integers(0, 3))
def test_slabs_are_joined_as_if_meshed_whole(seed, below):
    volume = VoteVolume(VoxelGrid.cube(side_m=9.0, spacing_m=0.4))
    volume.add_many([random_view(seed + i) for i in range(5)])
    assert len(dual_contouring.slab_layers(volume.grid)) > 2
    in_slabs = dual_surface(volume, 5 - below)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(dual_contouring, "slab_layers", lambda grid: [(-1, grid.shape[0])])
        whole = dual_surface(volume, 5 - below)
    assert np.array_equal(in_slabs.vertices_m, whole.vertices_m)
    assert np.array_equal(in_slabs.faces, whole.faces)
    assert_closed(in_slabs)


@settings(max_examples=60, deadline=None)
@given(views=st.lists(lattice_views(), min_size=1, max_size=4), below=st.integers(0, 2))
def test_awkward_outlines_give_closed_surfaces(views, below):
    volume = VoteVolume(LATTICE)
    volume.add_many(views)
    surface = dual_surface(volume, max(1, len(views) - below))
    assert_closed(surface)
    assert np.all(surface.vertices_m >= LATTICE.origin_m - 0.5 * LATTICE.spacing_m - 1e-9)
    assert np.all(surface.vertices_m <= LATTICE.upper_m + 0.5 * LATTICE.spacing_m + 1e-9)


def test_edges_and_corners_of_a_box_are_kept():
    volume, _ = box_volume()
    dual, snapped = dual_surface(volume), hull_surface(volume)
    truth_m3 = 8 * HALF_M.prod()
    lost = [abs(surface.volume_m3() / truth_m3 - 1) for surface in (dual, snapped)]
    assert lost[0] < 2e-3
    assert lost[1] > 5 * lost[0]
    corner = np.abs(np.abs(dual.vertices_m) - HALF_M).max(axis=1).min()
    assert corner < 0.05 * GRID.spacing_m


def test_a_perspective_view_sweeps_planes_through_its_camera():
    """One box seen by three cameras from afar is that box, but for what perspective adds."""
    depth_m = 400.0
    volume = VoteVolume(GRID)
    for axis in range(3):
        view = box_volume()[0].voters[axis].view
        away = np.append(np.eye(3)[axis], depth_m)
        affine = view.projection.matrix.copy()
        centre = np.full(2, 40.0)
        affine[:, 3] -= centre
        matrix = np.vstack([depth_m * affine + centre[:, None] * away, away])
        volume.add(View(silhouette=view.silhouette, projection=Projection(matrix=matrix)))
    surface = dual_surface(volume)
    # A plane through the camera is off the box's by half its depth over the camera's distance.
    assert np.abs(surface.vertices_m).max(axis=0) == pytest.approx(HALF_M, abs=0.02)
    crossings = hull_crossings(volume, 3)
    steepest = np.abs(crossings.normals).max(axis=1)
    assert steepest.min() > 1 - 1e-4
    assert steepest.min() < 1 - 1e-7


def test_a_hull_at_the_grids_end_is_closed_there():
    view = box_volume()[0].voters[2].view
    volume = VoteVolume(GRID)
    volume.add(view)
    surface = dual_surface(volume)
    assert_closed(surface)
    end = GRID.upper_m[2] + 0.5 * GRID.spacing_m
    assert np.ptp(surface.vertices_m[:, 2]) == pytest.approx(2 * end, rel=1e-9)


def test_an_empty_hull_has_an_empty_surface():
    volume = VoteVolume(GRID)
    view = box_volume()[0].voters[0].view
    matrix = view.projection.matrix.copy()
    matrix[:, 3] += 500.0
    outside = Projection(matrix=matrix)
    volume.add_many([view, View(silhouette=view.silhouette, projection=outside)])
    assert dual_surface(volume).is_empty


def test_a_threshold_above_the_views_is_refused():
    volume, _ = box_volume()
    with pytest.raises(ValueError, match="between 1 and the number of views, 3; got 4"):
        dual_surface(volume, 4)
