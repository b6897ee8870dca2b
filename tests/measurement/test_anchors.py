import numpy as np
import pytest
from hypothesis import given, settings

from core.hull.surface import EMPTY_SURFACE
from core.measurement.anchors import (
    AnchorLost,
    Extreme,
    KeyPoint,
    PartEnd,
    PickRay,
    Point,
    SurfacePoint,
    resolve,
)
from tests.measurement.bodies import SHIFTS, TURNS, X, Y, Z, box, joined, moved


def lost(anchor, surface, words, **more):
    found = resolve(anchor, surface, **more)
    assert isinstance(found, AnchorLost)
    assert words in found.reason
    assert found.reason.endswith(".")


def test_a_ray_finds_the_side_that_faces_it():
    place = resolve(PickRay(origin_m=[9, 0.3, 0.2], direction=-X), box())
    np.testing.assert_allclose(place, [2, 0.3, 0.2])


def test_a_pick_on_nothing_is_lost_in_clear_words():
    lost(PickRay(origin_m=[9, 5, 0], direction=-X), box(), "does not meet the hull")
    for anchor in (
        PickRay(origin_m=[9, 0, 0], direction=-X),
        SurfacePoint(near_m=[0, 0, 0]),
        Extreme(near_m=[0, 0, 0], direction=X, radius_m=2),
        PartEnd(near_m=[0, 0, 0], toward=X),
    ):
        lost(anchor, EMPTY_SURFACE, "The hull is empty")


def test_a_surface_point_follows_the_surface_and_is_lost_when_it_is_gone():
    anchor = SurfacePoint(near_m=[2.1, 0.1, 0.2], reach_m=0.5)
    np.testing.assert_allclose(resolve(anchor, box()), [2, 0.1, 0.2])
    np.testing.assert_allclose(resolve(anchor, box((4.6, 2, 1))), [2.3, 0.1, 0.2])
    lost(anchor, box((2, 2, 1)), "gone")


def test_an_extreme_is_a_corner_and_a_flat_end_has_its_middle():
    corner = Extreme(near_m=[2, 1, 0.5], direction=[1, 1, 1], radius_m=1)
    np.testing.assert_allclose(resolve(corner, box()), [2, 1, 0.5])
    end = Extreme(near_m=[1.8, 0.2, 0.1], direction=X, radius_m=3, cap_m=0.05)
    np.testing.assert_allclose(resolve(end, box(fineness=3)), [2, 0, 0], atol=1e-12)
    lost(Extreme(near_m=[9, 0, 0], direction=X, radius_m=1), box(), "no surface within 1 m")


def test_an_extreme_sees_only_its_ball():
    both = joined(box(), box((1, 1, 1), centre=(10, 0, 0)))
    near = Extreme(near_m=[2, 1, 0.5], direction=X, radius_m=1)
    assert resolve(near, both)[0] == pytest.approx(2)
    far = Extreme(near_m=[2, 1, 0.5], direction=X, radius_m=20)
    assert resolve(far, both)[0] == pytest.approx(10.5)


def test_the_end_of_a_part_is_that_of_the_part_under_the_pointer():
    both = joined(box(), box((1, 6, 2), centre=(10, 0, 0)))
    np.testing.assert_allclose(
        resolve(PartEnd(near_m=[2, 0, 0], toward=-X), both), [-2, 0, 0], atol=1e-9
    )
    np.testing.assert_allclose(
        resolve(PartEnd(near_m=[9.5, 0, 0], toward=[0.2, 1, 0.1]), both), [10, 3, 0], atol=1e-9
    )
    lost(PartEnd(near_m=[10, 0, 0], toward=X), box(), "gone")


def test_a_key_point_is_known_by_name():
    place = resolve(KeyPoint(name="tip"), EMPTY_SURFACE, {"tip": np.array([1.0, 2, 3])})
    np.testing.assert_array_equal(place, [1, 2, 3])
    lost(KeyPoint(name="tip"), box(), 'no key point "tip"')


def test_a_fixed_point_needs_no_hull():
    np.testing.assert_array_equal(resolve(Point(point_m=[1, 2, 3]), EMPTY_SURFACE), [1, 2, 3])


@given(TURNS, SHIFTS)
@settings(max_examples=25)
def test_anchors_move_with_the_body(turn, shift):
    body = joined(box(fineness=2), box((1, 1, 3), centre=(5, 0, 0)))
    go, along = (lambda p: turn.apply(p) + shift), turn.apply
    pairs = [
        (
            PickRay(origin_m=[9, 0.13, 0.21], direction=-X),
            PickRay(origin_m=go([9, 0.13, 0.21]), direction=along(-X)),
        ),
        (
            SurfacePoint(near_m=[0.31, 0.2, 0.8]),
            SurfacePoint(near_m=go([0.31, 0.2, 0.8])),
        ),
        (
            Extreme(near_m=[2, 1, 0.5], direction=[1, 2, 3], radius_m=1.1, cap_m=0.1),
            Extreme(near_m=go([2, 1, 0.5]), direction=along([1, 2, 3]), radius_m=1.1, cap_m=0.1),
        ),
        (
            PartEnd(near_m=[5.5, 0, 0], toward=Y + 2 * Z),
            PartEnd(near_m=go([5.5, 0, 0]), toward=along(Y + 2 * Z)),
        ),
    ]
    there = moved(body, turn, shift)
    for before, after in pairs:
        np.testing.assert_allclose(resolve(after, there), go(resolve(before, body)), atol=1e-6)


def test_nonsense_is_refused_in_clear_words():
    with pytest.raises(ValueError, match="PickRay's direction must have a length above zero"):
        PickRay(origin_m=[0, 0, 0], direction=[0, 0, 0])
    with pytest.raises(ValueError, match="Extreme's radius_m must be a length above zero, got -1"):
        Extreme(near_m=[0, 0, 0], direction=X, radius_m=-1)
    with pytest.raises(ValueError, match="NaN"):
        Point(point_m=[0, np.nan, 0])
    with pytest.raises(ValueError, match="cap_m must be a length of at least 0 m"):
        Extreme(near_m=[0, 0, 0], direction=X, radius_m=1, cap_m=-0.1)
