import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from core.measurement.picking import first_hit_m, nearest_point_m, points_within_m
from tests.measurement.bodies import box, surface_of

SEEDS = st.integers(0, 2**31)
SOUP = surface_of(trimesh.creation.icosphere(subdivisions=2))


def soup(random, count=40):
    """Return triangles at random, which no picking may rely on being a closed body."""
    return surface_of(
        trimesh.Trimesh(
            random.normal(size=(3 * count, 3)),
            np.arange(3 * count).reshape(-1, 3),
            process=False,
        )
    )


def nearest_by_edges_and_planes(surface, point):
    """Return the distance to the nearest point: of each plane's foot inside, and of each edge."""
    best = np.inf
    for a, b, c in surface.vertices_m[surface.faces]:
        weights, *_ = np.linalg.lstsq(np.array([b - a, c - a]).T, point - a, rcond=None)
        if weights.min() >= 0 and weights.sum() <= 1:
            foot = a + weights @ np.array([b - a, c - a])
            best = min(best, np.linalg.norm(foot - point))
        for start, end in ((a, b), (b, c), (c, a)):
            share = np.clip((point - start) @ (end - start) / ((end - start) @ (end - start)), 0, 1)
            best = min(best, np.linalg.norm(start + share * (end - start) - point))
    return best


@given(SEEDS)
@settings(max_examples=30)
def test_the_nearest_point_is_that_of_every_triangle_tried(seed):
    random = np.random.default_rng(seed)
    surface, point = soup(random), random.normal(size=3)
    place, face = nearest_point_m(surface, point)
    assert np.linalg.norm(place - point) == pytest.approx(
        nearest_by_edges_and_planes(surface, point), abs=1e-9
    )
    a, b, c = surface.vertices_m[surface.faces[face]]
    assert abs((place - a) @ np.cross(b - a, c - a)) < 1e-9


@given(SEEDS)
@settings(max_examples=50)
def test_the_first_hit_is_the_nearest_solution_of_every_triangle(seed):
    random = np.random.default_rng(seed)
    surface, origin, direction = soup(random), 2 * random.normal(size=3), random.normal(size=3)
    hits = []
    for a, b, c in surface.vertices_m[surface.faces]:
        u, v, distance = np.linalg.solve(np.array([b - a, c - a, -direction]).T, origin - a)
        if u >= 0 and v >= 0 and u + v <= 1 and distance >= 0:
            hits.append(distance)
    found = first_hit_m(surface, origin, direction)
    if not hits:
        assert found is None
    else:
        np.testing.assert_allclose(found, origin + min(hits) * direction, atol=1e-9)


def test_a_ray_through_an_edge_or_a_corner_does_not_slip_between_faces():
    body = box((2.0, 2.0, 2.0))
    for aim in ([0, 0, 0], [1, 1, 1], [0.3, -0.3, 0.3]):
        for origin in ([5.0, 5, 5], [5, 0, 0], [0, 7, 0]):
            direction = np.array(aim) - np.array(origin)
            assert first_hit_m(body, np.array(origin, dtype=float), direction) is not None


def test_what_lies_behind_a_ray_is_not_hit():
    assert first_hit_m(box(), np.array([9.0, 0, 0]), np.array([1.0, 0, 0])) is None


@given(SEEDS)
@settings(max_examples=20)
def test_points_in_a_ball_lie_in_it_and_on_the_edges(seed):
    random = np.random.default_rng(seed)
    centre, radius = random.normal(size=3), random.uniform(0.2, 2)
    points = points_within_m(SOUP, centre, radius)
    assert np.all(np.linalg.norm(points - centre, axis=1) <= radius + 1e-9)
    for point in points[:10]:
        place, _ = nearest_point_m(SOUP, point)
        assert np.linalg.norm(place - point) < 1e-9
    held = np.linalg.norm(SOUP.vertices_m - centre, axis=1) <= radius
    assert len(points) >= held.sum()
