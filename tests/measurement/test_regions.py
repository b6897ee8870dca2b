import numpy as np
import pytest
from hypothesis import given, settings

from core.measurement.anchors import AnchorLost
from core.measurement.regions import Ball, ConnectedPart, Patch, WholeSurface, faces_of
from tests.measurement.bodies import SHIFTS, TURNS, X, box, cylinder, joined, moved


def test_a_flat_patch_is_the_side_that_was_picked():
    body = box(fineness=3)
    faces = faces_of(Patch(near_m=[2.1, 0.2, 0.1], angle_rad=0.3), body)
    middle = body.vertices_m[body.faces[faces]].mean(axis=1)
    np.testing.assert_allclose(middle[:, 0], 2)
    # The rim, whose normals the edges bend, stays out.
    assert len(faces) >= 40


def test_a_smooth_patch_goes_around_a_cylinder_but_not_over_its_end():
    body = cylinder()
    faces = faces_of(Patch(near_m=[0, 0, 1], angle_rad=0.2, growth="smooth"), body)
    middle = body.vertices_m[body.faces[faces]].mean(axis=1)
    assert np.abs(middle[:, 0]).max() < 3
    assert np.ptp(np.arctan2(middle[:, 1], middle[:, 2])) > 6
    near = faces_of(Patch(near_m=[0, 0, 1], angle_rad=0.2, growth="smooth", radius_m=1), body)
    assert set(near) < set(faces)


def test_a_part_is_all_that_is_connected_and_nothing_else():
    both = joined(box(), box((1, 1, 1), centre=(10, 0, 0)))
    assert faces_of(ConnectedPart(near_m=[2, 0, 0]), both).tolist() == list(range(12))
    assert faces_of(ConnectedPart(near_m=[10, 0, 0]), both).tolist() == list(range(12, 24))
    assert len(faces_of(WholeSurface(), both)) == 24
    assert set(faces_of(Ball(near_m=[10, 0, 0], radius_m=2), both)) == set(range(12, 24))


def test_a_region_that_is_gone_is_lost():
    for region in (
        Patch(near_m=[9, 0, 0], angle_rad=0.3),
        Ball(near_m=[9, 0, 0], radius_m=1),
        ConnectedPart(near_m=[9, 0, 0]),
    ):
        assert isinstance(faces_of(region, box()), AnchorLost)


@given(TURNS, SHIFTS)
@settings(max_examples=20)
def test_regions_move_with_the_body(turn, shift):
    body = joined(box(fineness=2), cylinder(sections=16))
    there = moved(body, turn, shift)
    for place, options in (([2.0, 0.31, 0.12], {}), ([2.7, 0, 0.97], {"growth": "smooth"})):
        before = faces_of(Patch(near_m=place, angle_rad=0.5, radius_m=1.3, **options), body)
        region = Patch(near_m=turn.apply(place) + shift, angle_rad=0.5, radius_m=1.3, **options)
        assert faces_of(region, there).tolist() == before.tolist()


def test_nonsense_is_refused():
    with pytest.raises(ValueError, match="angle lies above 0"):
        Patch(near_m=X, angle_rad=0)
    with pytest.raises(ValueError, match='"flat" or "smooth", not "round"'):
        Patch(near_m=X, angle_rad=1, growth="round")
