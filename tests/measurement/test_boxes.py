import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from core.measurement import boxes
from core.measurement.boxes import least_box
from tests.measurement.bodies import SHIFTS, TURNS

CLOUDS = st.tuples(st.integers(4, 60), st.integers(0, 10_000)).map(
    lambda drawn: np.random.default_rng(drawn[1]).normal(size=(drawn[0], 3)) * [3, 2, 1]
)


@settings(max_examples=8, deadline=None)
@given(points=CLOUDS)
def test_the_box_holds_all_points_and_is_no_larger_than_the_one_over_the_hulls_faces(points):
    centre, axes, sizes = least_box(points)
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(axes) > 0
    assert sizes[0] >= sizes[1] >= sizes[2]
    assert np.all(np.abs((points - centre) @ axes.T) <= sizes / 2 * (1 + 1e-9) + 1e-12)
    assert np.prod(sizes) <= np.prod(trimesh.bounds.oriented_bounds(points)[1]) * (1 + 1e-9)


@settings(max_examples=8, deadline=None)
@given(turn=TURNS, shift=SHIFTS)
def test_a_bodys_box_turns_with_it(turn, shift):
    corners = trimesh.creation.box(extents=(4.0, 2.0, 1.0)).subdivide().vertices
    centre, axes, sizes = least_box(turn.apply(corners) + shift)
    np.testing.assert_allclose(sizes, [4, 2, 1], rtol=1e-9)
    np.testing.assert_allclose(centre, shift, atol=1e-9)
    np.testing.assert_allclose(np.abs(axes @ turn.as_matrix()), np.eye(3), atol=1e-7)


def test_the_regular_tetrahedrons_box_is_the_cube_whose_faces_hold_its_edges():
    tetrahedron = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1.0]])
    turned = Rotation.from_rotvec([0.3, 0.2, 0.9]).apply(tetrahedron)
    assert np.prod(least_box(turned)[2]) == pytest.approx(8, rel=1e-4)


@settings(max_examples=4, deadline=None)
@given(turn=TURNS)
def test_few_points_that_stand_for_many_give_the_box_of_all(turn):
    ellipsoid = trimesh.creation.icosphere(subdivisions=4).vertices * [8, 2, 1]
    points = turn.apply(ellipsoid)
    assert len(points) > boxes.FEW
    centre, axes, sizes = least_box(points)
    assert np.all(np.abs((points - centre) @ axes.T) <= sizes / 2 * (1 + 1e-9))
    assert np.prod(sizes) == pytest.approx(16 * 4 * 2, rel=2e-3)


def test_points_in_one_plane_have_no_box():
    flat = np.random.default_rng(1).normal(size=(50, 3)) * [1, 1, 0]
    for points in (flat, flat[:3]):
        with pytest.raises(ValueError, match="one plane"):
            least_box(Rotation.from_rotvec([1, 2, 3]).apply(points))
