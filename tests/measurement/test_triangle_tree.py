import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from core.hull.surface import EMPTY_SURFACE
from core.measurement.picking import nearest_point_m
from core.measurement.triangle_tree import tree_of
from tests.measurement.bodies import box, joined, surface_of

SEEDS = st.integers(0, 2**31)
BALL = surface_of(trimesh.creation.icosphere(subdivisions=3))


@given(SEEDS, st.integers(1, 60))
@settings(max_examples=30)
def test_the_tree_finds_what_looking_at_every_triangle_finds(seed, count):
    random = np.random.default_rng(seed)
    corners = random.normal(size=(3 * count, 3))
    faces = np.arange(3 * count).reshape(-1, 3)
    surface = surface_of(trimesh.Trimesh(corners, faces, process=False))
    points = 2 * random.normal(size=(9, 3))
    places, faces = tree_of(surface).nearest_m(points)
    for point, place, face in zip(points, places, faces, strict=True):
        wanted, number = nearest_point_m(surface, point)
        np.testing.assert_allclose(place, wanted, atol=1e-12)
        assert face == number


@given(SEEDS)
@settings(max_examples=20)
def test_windings_count_the_bodies_around_a_point(seed):
    random = np.random.default_rng(seed)
    both = joined(box((4, 2, 1)), box((1, 4, 2)), BALL)
    # Places of vertices and on edges' lines, too, where rays graze.
    points = np.concatenate([random.uniform(-3, 3, (200, 3)), random.integers(-5, 6, (50, 3)) / 4])
    wanted = sum(
        np.all(np.abs(points) < half, axis=1).astype(int) for half in ([2, 1, 0.5], [0.5, 2, 1])
    )
    away = np.ones(len(points), dtype=bool)
    for half in ([2, 1, 0.5], [0.5, 2, 1]):
        away &= ~np.any(np.abs(np.abs(points) - half) < 1e-9, axis=1)
    length = np.linalg.norm(points, axis=1)
    away &= np.abs(length - 1) > 0.02
    found = tree_of(both).windings(points)
    np.testing.assert_array_equal(found[away], (wanted + (length < 1))[away])


def test_an_empty_surface_has_no_distance():
    with pytest.raises(ValueError, match="is empty"):
        tree_of(EMPTY_SURFACE)
