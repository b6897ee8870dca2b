import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from core.hull.surface import EMPTY_SURFACE
from core.measurement.anchors import Extreme, KeyPoint, PartEnd, PickRay, Point, SurfacePoint
from core.measurement.measures import scale_factors
from core.measurement.measuring import measure, measure_all
from core.measurement.measuring_job import MeasuringContext
from core.measurement.regions import Ball, ConnectedPart, Patch
from core.measurement.results import Lost, Measurement
from core.measurement.specs import (
    AngleBetween,
    Area,
    BoundingBox,
    CylinderAxis,
    Length,
    LineAxis,
    LineFeature,
    OrientedBox,
    PlaneNormal,
    PlaneThrough,
    Polyline,
    PrincipalAxes,
    ScaleFactor,
    Section,
    Volume,
)
from tests.measurement.bodies import SHIFTS, TURNS, X, Y, Z, box, cylinder, joined, moved

STILL = Rotation.identity()
BODY = joined(box(fineness=2), cylinder(radius=0.5, length=8.0, sections=32))


def specs(turn, shift, scale):
    """Return one spec of each kind, as it is drawn on BODY after a motion."""

    def go(point):
        return scale * turn.apply(point) + shift

    along = turn.apply
    tip = Extreme(near_m=go([2, 1, 0.5]), direction=along([1, 2, 3]), radius_m=0.6 * scale)
    low = PickRay(origin_m=go([9, -0.8, 0.13]), direction=along(-X))
    top = SurfacePoint(near_m=go([0.31, 0.7, 0.52]), reach_m=scale)
    near = go([2.01, 0.3, 0.4])
    part = ConnectedPart(near_m=go([2, 0.9, 0.1]), reach_m=scale)
    round_side = Patch(
        near_m=go([3, 0, 0.5]), angle_rad=0.5, growth="smooth", reach_m=scale, radius_m=1.1 * scale
    )
    return (
        Length(name="length", start=tip, end=low),
        LineFeature(
            name="ends",
            start=PartEnd(near_m=go([-4, 0, 0]), toward=along(-X), reach_m=scale),
            end=PartEnd(near_m=go([4, 0, 0]), toward=along(X), reach_m=scale),
        ),
        Polyline(name="chain", anchors=(tip, low, top)),
        LineAxis(name="boom", region=Ball(near_m=go([3.2, 0, 0]), radius_m=1.01 * scale)),
        CylinderAxis(name="round", region=round_side),
        PlaneNormal(name="side", region=Patch(near_m=near, angle_rad=0.4, reach_m=scale)),
        PlaneThrough(name="through", anchors=(tip, low, top)),
        PrincipalAxes(name="axes", region=part),
        OrientedBox(name="box", region=part),
        Volume(name="volume", region=part),
        Area(name="area", region=part),
        Section(name="cut", through=top, normal=along(X)),
        AngleBetween(name="angle", first="length", second="side"),
        AngleBetween(name="line angle", first="ends", second="length"),
        ScaleFactor(name="b", first="length", second="ends"),
    )


POWER = {"m": 1, "m²": 2, "m³": 3, "rad": 0, "": 0}


@given(TURNS, SHIFTS, st.floats(0.1, 10))
@settings(max_examples=15)
def test_numbers_are_those_of_the_body_wherever_it_stands_and_however_large(turn, shift, scale):
    still = measure_all(specs(STILL, np.zeros(3), 1.0), BODY)
    there = measure_all(specs(turn, shift, scale), moved(BODY, turn, shift, scale))
    for before, after in zip(still, there, strict=True):
        assert isinstance(before, Measurement), before
        assert isinstance(after, Measurement), after
        assert after.value == pytest.approx(before.value * scale ** POWER[before.unit], rel=1e-6)
        assert after.is_undirected is before.is_undirected
        np.testing.assert_allclose(after.sizes_m, before.sizes_m * scale, rtol=1e-6, atol=1e-9)
        if before.direction is not None:
            cosine = after.direction @ turn.as_matrix() @ before.direction
            assert (abs(cosine) if before.is_undirected else cosine) == pytest.approx(1, abs=1e-9)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("ends", 8.0),
        ("round", 1.0),
        ("volume", 8.0),
        ("area", 28.0),
        ("axes", 4.0),
        ("box", 4.0),
    ],
)
def test_the_numbers_are_true(name, value):
    found = {one.name: one for one in measure_all(specs(STILL, np.zeros(3), 1.0), BODY)}
    assert found[name].value == pytest.approx(value, rel=1e-6)


def length(start, end, **more):
    return Length(name="l", start=Point(point_m=start), end=Point(point_m=end), **more)


def test_a_length_has_a_direction_and_its_angles():
    found = measure(length([0, 0, 0], [3, 4, 0]), box())
    assert (found.value, found.unit, found.is_undirected) == (5.0, "m", False)
    np.testing.assert_allclose(found.direction, [0.6, 0.8, 0])
    np.testing.assert_allclose(
        found.angles_to_axes_rad(), [np.arccos(0.6), np.arccos(0.8), np.pi / 2]
    )


@given(TURNS)
@settings(max_examples=30)
def test_an_undirected_line_reads_the_same_from_either_end(turn):
    a, b = turn.apply(X), 2 * turn.apply(Y)
    one, other = (
        measure(LineFeature(name="l", start=Point(point_m=p), end=Point(point_m=q)), box())
        for p, q in ((a, b), (b, a))
    )
    assert one.value == other.value
    assert one.is_undirected
    np.testing.assert_allclose(one.angles_to_axes_rad(), other.angles_to_axes_rad(), atol=1e-12)
    assert np.all(one.angles_to_axes_rad() <= np.pi / 2 + 1e-12)
    reverse = measure(length(b, a), box())
    there = measure(length(a, b), box())
    np.testing.assert_allclose(
        reverse.angles_to_axes_rad(), np.pi - there.angles_to_axes_rad(), atol=1e-12
    )


def test_revision_and_threshold_are_those_of_the_hull():
    context = MeasuringContext(revision=7, threshold=58, key_points={"tip": Z})
    found = measure(
        Length(name="l", start=KeyPoint(name="tip"), end=Point(point_m=-Z)), box(), context
    )
    assert (found.value, found.revision, found.threshold) == (2.0, 7, 58)
    lost = measure(
        Length(name="l", start=KeyPoint(name="no"), end=Point(point_m=Z)), box(), context
    )
    assert (type(lost), lost.revision, lost.threshold) == (Lost, 7, 58)


def test_a_part_that_vanished_takes_with_it_only_what_rests_on_it():
    both = joined(box(), box((1, 6, 2), centre=(10, 0, 0)))
    wanted = (
        PrincipalAxes(name="panel", region=ConnectedPart(near_m=[9.5, 0, 0])),
        PrincipalAxes(name="body", region=ConnectedPart(near_m=[2, 0, 0])),
        AngleBetween(name="angle", first="panel", second="body"),
    )
    before = measure_all(wanted, both)
    assert [type(one) for one in before] == [Measurement] * 3
    assert before[2].value == pytest.approx(np.pi / 2)
    panel, body, angle = measure_all(wanted, box())
    assert "gone" in panel.reason
    assert body.value == pytest.approx(4)
    assert angle.reason.startswith('"panel" is lost: ')


def point(*place):
    return Point(point_m=place)


@pytest.mark.parametrize(
    ("spec", "words"),
    [
        (length([1, 1, 1], [1, 1, 1]), "lie on the same point"),
        (
            PlaneThrough(name="p", anchors=(point(0, 0, 0), point(1, 1, 1), point(3, 3, 3))),
            "lie on one straight line",
        ),
        (
            PlaneThrough(name="p", anchors=(point(1, 0, 0), point(1, 0, 0), point(3, 3, 3))),
            "lie on one straight line",
        ),
        (Section(name="s", through=point(9, 0, 0), normal=X), "does not cut the hull"),
        (LineAxis(name="l", region=Ball(near_m=[0, 0, 0], radius_m=9)), "as long as wide"),
    ],
)
def test_what_cannot_be_measured_is_lost_in_clear_words(spec, words):
    found = measure(spec, box((2, 2, 2)))
    assert isinstance(found, Lost)
    assert words in found.reason


def test_everything_of_an_empty_hull_is_lost():
    assert all(
        isinstance(one, Lost) for one in measure_all(specs(STILL, np.zeros(3), 1.0), EMPTY_SURFACE)
    )
    assert isinstance(measure(BoundingBox(name="b"), EMPTY_SURFACE), Lost)


def test_names_must_be_there_and_differ():
    with pytest.raises(ValueError, match='2 measurements are called "v"'):
        measure_all([Volume(name="v"), Area(name="v")], box())
    with pytest.raises(ValueError, match='refers to "no"'):
        measure_all([Volume(name="v"), AngleBetween(name="a", first="v", second="no")], box())
    with pytest.raises(ValueError, match="needs a name"):
        Volume(name="  ")
    with pytest.raises(ValueError, match="encloses nothing"):
        Volume(name="v", region=Ball(near_m=X, radius_m=1))
    no_direction = measure_all(
        [Volume(name="v"), Area(name="w"), AngleBetween(name="a", first="v", second="w")], box()
    )[2]
    assert no_direction.reason == '"v" has no direction, so it makes no angle.'


def test_scale_factors_are_those_of_each_pair():
    lines = [
        Measurement(name=name, value=value, unit="m")
        for name, value in (("l1", 27.69), ("l2", 58.12), ("l3", 15.88))
    ]
    assert scale_factors(lines) == {
        ("l1", "l2"): 27.69 / 58.12,
        ("l1", "l3"): 27.69 / 15.88,
        ("l2", "l3"): 58.12 / 15.88,
    }
    with pytest.raises(ValueError, match=r'"v" is 8\.0 m³'):
        scale_factors([lines[0], Measurement(name="v", value=8.0, unit="m³")])
