import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.picking import (
    EXTREME_SHARE,
    KINDS,
    SNAPS,
    Picking,
    Ray,
    hull_size_m,
    pick_on,
    spec_of,
)
from core.measurement.anchors import PickRay, SurfacePoint, resolve
from core.measurement.measuring import measure
from core.measurement.picking import nearest_point_m, points_within_m
from core.measurement.results import Lost
from tests.measurement.bodies import SHIFTS, TURNS, box, cylinder, joined, moved

DOWN = (0.0, 0.0, -1.0)


def ray(origin, direction=DOWN):
    return Ray(origin_m=np.array(origin, dtype=float), direction=np.array(direction, dtype=float))


def test_a_click_on_the_surface_is_the_first_point_that_the_ray_meets():
    pick = pick_on(box((4.0, 2.0, 1.0)), ray([1.2, 0.3, 9.0]), "surface")
    np.testing.assert_allclose(pick.place_m, [1.2, 0.3, 0.5], atol=1e-12)
    assert isinstance(pick.anchor, SurfacePoint)
    assert pick.anchor.reach_m == pytest.approx(0.4)


def test_a_surface_point_survives_a_thinner_hull_where_the_ray_that_picked_it_does_not():
    before, after = box((4.0, 2.0, 1.0)), box((3.98, 1.98, 0.98))
    grazing = ray([1.995, 0.3, 9.0])
    pick = pick_on(before, grazing, "surface")
    found = resolve(pick.anchor, after)
    assert np.linalg.norm(found - pick.place_m) < 0.02
    by_ray = PickRay(origin_m=grazing.origin_m, direction=grazing.direction)
    np.testing.assert_allclose(resolve(by_ray, before), pick.place_m)
    assert "does not meet the hull" in resolve(by_ray, after).reason


@given(st.floats(-2, 2), st.floats(-1, 1), TURNS, SHIFTS)
@settings(max_examples=20)
def test_an_extreme_is_the_farthest_of_all_points_near_the_click(x, y, turn, shift):
    body = box((4.4, 2.2, 1.0), fineness=3)
    click = ray(turn.apply([x, y, 9.0]) + shift, turn.apply(DOWN))
    pick = pick_on(moved(body, turn, shift), click, "extreme")
    near, outward = np.array([x, y, 0.5]), np.array([x, y, 0.5])
    points = points_within_m(body, near, EXTREME_SHARE * hull_size_m(moved(body, turn, shift)))
    place = turn.inv().apply(pick.place_m - shift)
    assert place @ outward == pytest.approx((points @ outward).max(), abs=1e-6)
    assert np.linalg.norm(nearest_point_m(body, place)[0] - place) < 1e-9


@pytest.mark.parametrize(
    ("at", "end"), [((1.9, 0.1), (2, 0, 0)), ((-1.9, 0.3), (-2, 0, 0)), ((0.3, -0.9), (0, -1, 0))]
)
def test_a_parts_end_is_the_one_that_the_click_is_nearest_to(at, end):
    far = box((1.0, 1.0, 1.0), centre=(9, 0, 0))
    pick = pick_on(joined(box((4.0, 2.0, 0.6)), far), ray([*at, 9.0]), "part end")
    np.testing.assert_allclose(pick.place_m, end, atol=1e-9)


@pytest.mark.parametrize("snap", SNAPS)
@given(x=st.floats(-1.9, 1.9), y=st.floats(-0.9, 0.9), turn=TURNS, shift=SHIFTS)
@settings(max_examples=20)
def test_a_picks_place_is_where_its_anchor_is_found(snap, x, y, turn, shift):
    body = moved(joined(box((4.0, 2.0, 1.0), fineness=3), box(centre=(9, 0, 0))), turn, shift)
    pick = pick_on(body, ray(turn.apply([x, y, 9.0]) + shift, turn.apply(DOWN)), snap)
    np.testing.assert_allclose(resolve(pick.anchor, body), pick.place_m, atol=1e-9)


@pytest.mark.parametrize("snap", SNAPS)
def test_a_click_on_nothing_says_so(snap):
    with pytest.raises(ValueError, match="no hull under the pointer"):
        pick_on(box(), ray([5.0, 0.0, 9.0]), snap)
    with pytest.raises(ValueError, match="There is no hull yet"):
        pick_on(None, ray([0.0, 0.0, 9.0]), snap)


def picked(kind, *clicks, body, snap="surface"):
    picking = Picking(kind=kind, snap=snap)
    for click in clicks:
        picking = picking.with_pick(pick_on(body, click, snap))
    return picking


def test_the_same_point_twice_is_refused_and_the_first_stays():
    picking = picked("length", ray([1.0, 0, 9]), ray([1.0, 0, 9]), body=box())
    assert len(picking.picks) == 1
    assert "the same point again, (1.00, 0.00, 0.50) m" in picking.complaint
    again = picking.with_pick(pick_on(box(), ray([0.5, 0, 9]), "surface"))
    assert again.is_complete
    assert again.complaint == ""


@pytest.mark.parametrize("kind", KINDS)
def test_complete_picks_make_a_measurement_that_the_hull_allows(kind):
    body = cylinder(radius=1.0, length=6.0)
    clicks = [ray([x, 0.05, 9.0]) for x in (-2.0, 1.5)]
    count = 2 if kind in ("length", "line feature", "polyline") else 1
    picking = picked(kind, *clicks[:count], body=body)
    assert picking.is_complete is (kind != "polyline")
    found = measure(spec_of(picking, "it", body), body)
    assert not isinstance(found, Lost), found
    wanted = {
        "length": 3.5,
        "polyline": 3.5,
        "line feature": 3.5,
        "cylinder axis": 2.0,
        "principal axes": 6.0,
        "section": np.pi,
    }
    if kind in wanted:
        assert found.value == pytest.approx(wanted[kind], rel=0.01)


def test_a_plane_is_fitted_to_the_face_that_was_clicked():
    body = box((4.0, 2.0, 1.0), fineness=4)
    found = measure(spec_of(picked("plane normal", ray([1, 0, 9]), body=body), "it", body), body)
    np.testing.assert_allclose(found.direction, [0, 0, 1], atol=0.02)


def test_a_polyline_of_one_point_cannot_be_ended():
    body = box()
    with pytest.raises(ValueError, match="at least two points"):
        spec_of(picked("polyline", ray([1, 0, 9]), body=body), "it", body)
