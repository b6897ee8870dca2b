import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from core.silhouettes.editing.vertices import (
    deleted_ring,
    deleted_vertex,
    inserted_vertex,
    moved_vertex,
)
from core.silhouettes.silhouette import clockwise_area_px
from tests.silhouettes.editing.shapes import body, box, outlines

PLACES = st.tuples(st.floats(-20, 70), st.floats(-20, 70))


@given(rings=outlines(), place=PLACES, draw=st.data())
def test_deleting_an_inserted_vertex_is_the_identity(rings, place, draw):
    assume(rings)
    ring = draw.draw(st.integers(0, len(rings) - 1))
    vertex = draw.draw(st.integers(0, len(rings[ring])))
    more = inserted_vertex(rings, ring, vertex, place)
    assert np.array_equal(more[ring][vertex], place)
    again = deleted_vertex(more, ring, vertex)
    for old, new in zip(rings, again, strict=True):
        assert np.array_equal(old, new)


@given(rings=outlines(), place=PLACES, draw=st.data())
def test_moving_a_vertex_back_is_the_identity_and_no_ring_changes_sides(rings, place, draw):
    assume(rings)
    ring = draw.draw(st.integers(0, len(rings) - 1))
    vertex = draw.draw(st.integers(0, len(rings[ring]) - 1))
    moved = moved_vertex(rings, ring, vertex, place)
    assert np.array_equal(moved[ring][vertex], place)
    if clockwise_area_px(moved[ring]) != 0:
        assert (clockwise_area_px(moved[ring]) > 0) == (clockwise_area_px(rings[ring]) > 0)
        back = moved_vertex(moved, ring, vertex, rings[ring][vertex])
        for old, new in zip(rings, back, strict=True):
            assert np.array_equal(old, new)


def test_a_triangle_dragged_inside_out_stays_outer():
    triangle = (np.array([[0.0, 0.0], [0.0, 4.0], [4.0, 0.0]]),)
    (ring,) = moved_vertex(triangle, 0, 2, (-4.0, 0.0))
    assert clockwise_area_px(ring) == 8
    assert ring[2].tolist() == [-4.0, 0.0]


def test_holes_go_with_their_ring():
    plate, window, boom = body()
    assert [len(deleted_ring(body(), number)) for number in range(3)] == [1, 2, 2]
    assert np.array_equal(deleted_ring((plate, window, boom), 0)[0], boom)


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda r: moved_vertex(r, 1, 0, (0, 0)), "no ring 1; the outline has 1"),
        (lambda r: moved_vertex(r, 0, 4, (0, 0)), "no vertex 4; it has 4"),
        (lambda r: moved_vertex(r, 0, -1, (0, 0)), "no vertex -1"),
        (lambda r: moved_vertex(r, 0, 0, (0, np.nan)), "1 of 2 values are NaN"),
        (lambda r: moved_vertex(r, 0, 0, (0, 1, 2)), "wanted an array of shape 2"),
        (lambda r: inserted_vertex(r, 0, 5, (0, 0)), "number 0 to 4, not 5"),
        (lambda r: deleted_vertex(r, 2, 0), "no ring 2"),
        (lambda r: deleted_vertex(deleted_vertex(r, 0, 0), 0, 0), "delete the whole ring"),
        (lambda r: deleted_ring(r, 1), "no ring 1"),
    ],
)
def test_what_is_not_there_is_refused(call, says):
    with pytest.raises(ValueError, match=says):
        call(box(0, 0, 4, 6))
