import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from core.geometry.grid import VoxelGrid
from core.geometry.projection import Projection, range_doppler_projection
from core.hull.hull_only import carved_surface
from core.hull.shadow import carving_view
from core.hull.view import View
from core.measurement.observability import observability, unobserved_direction
from core.silhouettes.silhouette import Silhouette

SQUARE = np.array([[20.0, 20.0], [20.0, 44.0], [44.0, 44.0], [44.0, 20.0]])
TURN = 2 * np.pi * np.arange(64) / 64
ALL = np.random.default_rng(0).normal(size=(400, 3))


def square_view(normal, turn_rad=0.0, claim="complete"):
    """Return a view of the plane across a normal; a turn moves the radar within the plane."""
    first = np.cross(normal, [0.3, 0.5, 0.8])
    first /= np.linalg.norm(first)
    second = np.cross(normal, first) / np.linalg.norm(normal)
    return radar_view(np.cos(turn_rad) * first + np.sin(turn_rad) * second, normal, claim)


def radar_view(sight, normal, claim):
    projection = range_doppler_projection(
        line_of_sight=np.asarray(sight, float),
        line_of_sight_rate_per_s=np.cross(normal, sight),
        row_spacing_m=0.1,
        column_spacing_m=0.15,
        shape=(64, 64),
    )
    outline = Silhouette(rings=(SQUARE,), image_shape=(64, 64), claim=claim)
    return carving_view(View(silhouette=outline, projection=projection), "shadow")


def test_planes_that_nearly_coincide_leave_their_normal_unobserved():
    views = [square_view(normal) for normal in ([0, 0, 1], [0, 0.1, 1], [0.1, 0, 1])]
    direction = unobserved_direction(views)
    assert abs(direction[2]) > 0.98
    seen = observability(views)
    assert [seen.grade(axis) for axis in np.eye(3)] == ["good", "good", "unobserved"]


def test_one_plane_alone_is_blind_along_its_normal_to_the_last_digits():
    normal = np.array([0.36, 0.48, 0.8])
    views = [square_view(normal, turn_rad) for turn_rad in (0.0, 0.4, 1.2)]
    assert abs(unobserved_direction(views) @ normal) == pytest.approx(1)
    lit = square_view(normal, claim="lit side")
    assert abs(unobserved_direction([lit]) @ normal) == pytest.approx(1)
    assert observability(views).dilution(normal) == np.inf
    assert observability(views).dilution(np.cross(normal, [1, 0, 0])) == pytest.approx(1, abs=0.01)


def test_two_planes_at_an_angle_observe_everything_but_not_all_of_it_well():
    views = [square_view([0, 0, 1]), square_view([0, 1, 0])]
    assert unobserved_direction(views) is None
    seen = observability(views)
    assert seen.grade(np.array([1.0, 0, 0])) == "good"
    # Two unit cylinders across each other: Steinmetz's solid reaches √2 between them.
    assert seen.dilution(np.array([0.0, 1, 1])) == pytest.approx(np.sqrt(2), rel=0.01)
    assert seen.grade(np.array([0.0, 1, 1])) == "weak"
    assert abs(seen.worst_direction()) == pytest.approx([0, np.sqrt(0.5), np.sqrt(0.5)], abs=0.05)


def test_one_view_across_observes_what_the_others_do_not():
    many = [square_view([0, 0, 1])] * 30
    assert unobserved_direction(many) is not None
    assert unobserved_direction([*many, square_view([0, 1, 0])]) is None


def test_sixty_views_from_all_around_see_every_direction_well():
    turns = Rotation.random(60, rng=np.random.default_rng(1)).as_matrix()
    views = [radar_view(turn[0], turn[2], "lit side") for turn in turns]
    seen = observability(views)
    assert {seen.grade(direction) for direction in ALL} == {"good"}
    assert unobserved_direction(views) is None


def test_what_only_one_side_lights_is_bounded_towards_the_radar_alone():
    """Radars along +x in two planes: nothing bounds the far side, until one looks from it."""
    near = [radar_view([1, 0, 0], normal, "lit side") for normal in ([0, 0, 1], [0, 1, 0])]
    seen = observability(near)
    assert [seen.grade(axis) for axis in np.eye(3)] == ["unobserved", "good", "good"]
    assert abs(unobserved_direction(near)[0]) == pytest.approx(1)
    both = observability([*near, radar_view([-1, 0, 0], [0, 0, 1], "lit side")])
    assert [both.grade(axis) for axis in np.eye(3)] == ["good"] * 3
    across = observability([*near, radar_view([0, 1, 0], [0, 0, 1], "lit side")])
    assert across.grade(np.array([1.0, 0, 0])) == "good"


def test_no_view_observes_nothing_and_a_perspective_one_all_but_its_axis():
    assert observability([]).grade(np.array([1.0, 0, 0])) == "unobserved"
    camera = np.array([[50.0, 0, 32, 640], [0, 50.0, 32, 640], [0, 0, 1, 20]])
    outline = Silhouette(rings=(SQUARE,), image_shape=(64, 64), claim="complete")
    seen = observability([View(silhouette=outline, projection=Projection(matrix=camera))])
    assert [seen.grade(axis) for axis in np.eye(3)] == ["good", "good", "unobserved"]


def ball_view(view):
    """Return a view with the outline of a unit ball in place of its own."""
    points = np.column_stack([np.cos(TURN), np.sin(TURN)]) / np.cos(np.pi / 64)
    rows = view.projection.matrix[:, :3]
    ring = points * np.linalg.norm(rows, axis=1) + 32
    ring = ring if np.linalg.det(ring[:2] - 32) < 0 else ring[::-1]
    claim = "complete" if view.silhouette.provenance == "" else "lit side"
    outline = Silhouette(rings=(ring,), image_shape=(64, 64), claim=claim)
    return carving_view(View(silhouette=outline, projection=view.projection), "shadow")


@settings(max_examples=6)
@given(seed=st.integers(0, 10**6), claim=st.sampled_from(["complete", "lit side"]))
def test_dilution_is_the_extent_of_a_carved_unit_ball(seed, claim):
    turns = Rotation.random(5, rng=np.random.default_rng(seed)).as_matrix()
    views = [radar_view(turn[0], turn[2], claim) for turn in turns]
    grid = VoxelGrid.cube(side_m=9.6, spacing_m=0.2)
    ball = carved_surface([ball_view(view) for view in views], grid)
    seen = observability(views)
    for direction in (*np.eye(3), *ALL[:5]):
        along = ball.vertices_m @ (direction / np.linalg.norm(direction))
        reach = max(along.max(), -along.min())
        if reach < 4:  # the grid does not cut it
            assert seen.dilution(direction) == pytest.approx(reach, rel=0.1)


@given(seed=st.integers(0, 10**6))
@settings(max_examples=15)
def test_one_more_view_never_observes_less(seed):
    turns = Rotation.random(5, rng=np.random.default_rng(seed)).as_matrix()
    views = [radar_view(turn[0], turn[2], "lit side") for turn in turns]
    fewer, more = observability(views[:4]), observability(views)
    for direction in ALL[:20]:
        assert 0.999 <= more.dilution(direction) <= fewer.dilution(direction) * (1 + 1e-9)
