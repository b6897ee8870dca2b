import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from core.benchmarks.distances import distances_m
from core.hull.closed_mesh import Surface
from core.hull.simplification import simplified
from core.hull.surface import EMPTY_SURFACE, hull_surface
from tests.hull.test_mesher import HALF_M, box_volume


def ball(subdivisions=4, radius_m=2.0):
    mesh = trimesh.creation.icosphere(subdivisions=subdivisions, radius=radius_m)
    return Surface(vertices_m=mesh.vertices, faces=mesh.faces)


@settings(max_examples=10, deadline=None)
@given(most_faces=st.integers(100, 6000))
def test_the_stated_error_is_that_of_an_exhaustive_search(most_faces):
    whole = ball()
    result = simplified(whole, most_faces=most_faces)
    coarse = result.surface
    assert len(coarse.faces) <= most_faces
    assert result.whole_faces == len(whole.faces)
    vertices_m = max(
        distances_m(whole.vertices_m, coarse).max(), distances_m(coarse.vertices_m, whole).max()
    )
    assert result.error_m >= vertices_m * (1 - 1e-9)
    # Between a sphere's chords lies what no vertex sees, and no more than that again.
    assert result.error_m <= 2.5 * vertices_m
    assert result.error_m < 0.4


def test_a_box_needs_few_faces():
    surface = hull_surface(box_volume()[0], method="dual")
    result = simplified(surface, most_faces=400)
    assert len(result.surface.faces) <= 400 < len(surface.faces)
    assert result.is_closed
    assert result.error_m < 0.02
    assert result.surface.volume_m3() == pytest.approx(8 * HALF_M.prod(), rel=0.01)


def test_a_tolerance_is_kept_with_ever_fewer_faces():
    whole = ball()
    fine, coarse = (simplified(whole, tolerance_m=t) for t in (0.01, 0.1))
    assert fine.error_m <= 0.01 < coarse.error_m <= 0.1
    assert len(coarse.surface.faces) < len(fine.surface.faces) < len(whole.faces)


def test_what_is_small_enough_stays_as_it_is():
    whole = ball(subdivisions=1)
    for result in (simplified(whole, most_faces=80), simplified(whole, tolerance_m=1e-9)):
        assert result.surface is whole
        assert result.error_m == 0
        assert result.is_closed


def test_an_empty_surface_stays_empty():
    for result in (
        simplified(EMPTY_SURFACE, most_faces=10),
        simplified(EMPTY_SURFACE, tolerance_m=0.1),
    ):
        assert result.surface.is_empty
        assert result.error_m == 0


def test_a_shape_that_bears_no_simplification_keeps_its_faces():
    whole = ball(subdivisions=2)
    result = simplified(whole, most_faces=4)
    assert result.surface is whole
    assert result.error_m == 0


def test_a_mesh_that_is_not_closed_is_said_to_be_open():
    whole = ball()
    half = Surface(vertices_m=whole.vertices_m, faces=whole.faces[: len(whole.faces) // 2])
    assert not simplified(half, most_faces=500).is_closed


@pytest.mark.parametrize(
    ("limits", "message"),
    [
        ({}, "either the most faces"),
        ({"most_faces": 10, "tolerance_m": 0.1}, "either the most faces"),
        ({"most_faces": 3}, "at least 4 faces; asked for 3"),
        ({"tolerance_m": 0.0}, "positive length in metres, got 0.0"),
        ({"tolerance_m": np.nan}, "positive length in metres, got nan"),
    ],
)
def test_limits_that_mean_nothing_are_refused(limits, message):
    with pytest.raises(ValueError, match=message):
        simplified(ball(subdivisions=1), **limits)
