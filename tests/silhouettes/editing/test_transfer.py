from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from core.geometry.projection import Projection
from core.silhouettes.areas import area_of
from core.silhouettes.editing.transfer import copied, interpolated, signed_distance_px
from tests.silhouettes.editing.shapes import (
    SHAPE,
    area_px,
    assert_well_turned,
    body,
    box,
    disc,
    frame_of,
    hausdorff_px,
    outlines,
)

BLACK = np.ones(SHAPE)


def at(time_s, origin_px=(24.0, 30.0), spacing_m=0.1, sensor="radar"):
    return frame_of(BLACK, time_s=time_s, origin_px=origin_px, spacing_m=spacing_m, sensor=sensor)


@given(rings=outlines(), row=st.floats(-2, 2), column=st.floats(-2, 2), scale=st.floats(0.5, 1))
def test_copying_there_and_back_is_the_identity(rings, row, column, scale):
    here, there = at(0.0), at(1.0, (24.0 + row, 30.0 + column), 0.1 / scale)
    back = copied(copied(rings, here, there), there, here)
    for old, new in zip(rings, back, strict=True):
        assert new == pytest.approx(old, abs=1e-9)


def test_a_copy_covers_the_same_metres_from_the_origin():
    here, there = at(0.0), at(1.0, (20.0, 33.0), 0.2)
    (ring,) = copied(box(20, 25, 30, 40), here, there)
    metres = (box(20, 25, 30, 40)[0] - (24, 30)) * 0.1
    assert (ring - (20, 33)) * 0.2 == pytest.approx(metres)


def test_what_falls_outside_the_image_is_cut_off():
    (ring,) = copied(box(20, 25, 30, 40), at(0.0), at(1.0, (-1.0, 30.0)))
    assert ring[:, 0].min() == -0.5
    assert copied(box(20, 25, 30, 40), at(0.0), at(1.0, (-40.0, 30.0))) == ()
    assert copied((), at(0.0), at(1.0)) == ()


def test_frames_in_perspective_are_copied_by_their_pixels_size():
    def camera(range_m, time_s):
        focal_px = 300.0
        matrix = np.array(
            [[focal_px, 0, 24, 24 * range_m], [0, focal_px, 30, 30 * range_m], [0, 0, 1, range_m]]
        )
        frame = at(time_s, sensor="optical")
        return replace(
            frame, projection=Projection(matrix=matrix), row_spacing_m=None, column_spacing_m=None
        )

    (ring,) = copied(box(20, 25, 30, 40), camera(100.0, 0.0), camera(200.0, 1.0))
    assert ring == pytest.approx((box(20, 25, 30, 40)[0] - (24, 30)) / 2 + (24, 30))


@settings(max_examples=15)
@given(rings=outlines())
def test_between_an_outline_and_itself_is_itself(rings):
    assume(rings)
    between = interpolated(rings, at(0.0), rings, at(2.0), at(0.7))
    assert_well_turned(between)
    assert hausdorff_px(between, rings) < 0.5


@settings(max_examples=10)
@given(share=st.floats(0.0, 1.0))
def test_a_growing_disc_grows_evenly(share):
    before, after = disc(24, 30, 8.0), disc(24, 30, 14.0)
    between = interpolated(before, at(0.0), after, at(4.0), at(4.0 * share))
    assert hausdorff_px(between, disc(24, 30, 8 + 6 * share)) < 0.25


def test_offsets_between_frames_are_no_motion():
    first, last, frame = at(0.0, (20.0, 28.0)), at(2.0, (27.5, 33.5)), at(1.0, (24.0, 30.0))
    before, after = disc(18.0, 27.0, 9), disc(25.5, 32.5, 9)
    between = interpolated(before, first, after, last, frame)
    assert hausdorff_px(between, disc(22.0, 29.0, 9)) < 0.15


def test_halfway_of_the_same_two_is_the_same_from_either_end():
    one, other = body(), box(14, 15, 33, 45)
    forth = interpolated(one, at(0.0), other, at(2.0), at(1.0))
    back = interpolated(other, at(0.0), one, at(2.0), at(1.0))
    assert area_px(forth) == pytest.approx(area_px(back))
    assert area_of(forth).symmetric_difference(area_of(back)).area < 1e-3


def test_signed_distances_are_those_of_a_disc():
    distance = signed_distance_px(disc(24, 30, 12, vertices=400), SHAPE)
    rows, columns = np.indices(SHAPE)
    assert distance == pytest.approx(12 - np.hypot(rows - 24, columns - 30), abs=0.06)


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda: copied(body(), at(0), at(1, sensor="optical")), "show different planes"),
        (lambda: interpolated((), at(0), body(), at(2), at(1)), '"trial" has none'),
        (lambda: interpolated(body(), at(0), body(), at(2), at(3)), "not between 0 s and 2 s"),
        (lambda: interpolated(body(), at(1), body(), at(1), at(1)), "not between 1 s and 1 s"),
    ],
)
def test_frames_that_do_not_fit_are_refused(call, says):
    with pytest.raises(ValueError, match=says):
        call()
