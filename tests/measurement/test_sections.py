import numpy as np
import pytest
import shapely
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from core.measurement.sections import section_of
from tests.measurement.bodies import SHIFTS, TURNS, X, Z, box, moved, surface_of


@given(TURNS, SHIFTS, st.floats(-1.9, 1.9))
@settings(max_examples=30)
def test_a_box_is_cut_in_a_rectangle_wherever_it_stands(turn, shift, along):
    body = moved(box(fineness=1), turn, shift)
    curves, area_m2 = section_of(body, turn.apply([along, 0, 0]) + shift, turn.apply(X))
    assert len(curves) == 1
    assert area_m2 == pytest.approx(2.0)
    corners = turn.inv().apply(curves[0] - shift)
    np.testing.assert_allclose(corners[:, 0], along, atol=1e-9)
    y, z = corners[:, 1], corners[:, 2]
    assert (y @ np.roll(z, -1) - z @ np.roll(y, -1)) / 2 == pytest.approx(2.0)


@given(st.floats(-0.99, 0.99), TURNS)
@settings(max_examples=20)
def test_a_ball_is_cut_in_a_circle(height, turn):
    ball = surface_of(trimesh.creation.icosphere(subdivisions=4))
    normal = turn.apply(Z)
    _, area_m2 = section_of(ball, height * normal, normal)
    assert area_m2 == pytest.approx(np.pi * (1 - height**2), rel=0.02, abs=0.02)


def test_a_hole_counts_as_one_and_runs_the_other_way():
    ring = surface_of(trimesh.creation.annulus(r_min=1, r_max=2, height=1, sections=128))
    curves, area_m2 = section_of(ring, np.zeros(3), Z)
    assert area_m2 == pytest.approx(np.pi * 3, rel=2e-3)
    assert sorted(shapely.LinearRing(c[:, :2]).is_ccw for c in curves) == [False, True]


def test_planes_through_corners_and_faces_close_their_curves():
    body = box((2.0, 2, 2), fineness=1)
    for through, normal, wanted in (
        ([0, 0, 0], X, 4.0),
        ([-1, 0, 0], X, 0.0),
        ([0, 0, 0], np.array([1, 1, 0]) / np.sqrt(2), 4 * np.sqrt(2)),
        ([1, 0, 0], X, 4.0),
    ):
        curves, area_m2 = section_of(body, np.array(through, dtype=float), normal)
        assert area_m2 == pytest.approx(wanted, abs=1e-9)
        assert all(len(curve) >= 3 for curve in curves)


def test_a_plane_beside_the_body_cuts_nothing():
    assert section_of(box(), np.array([9.0, 0, 0]), X) == ((), 0.0)
