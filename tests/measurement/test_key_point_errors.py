import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.formats.measurement_fields import encoded
from core.measurement.anchors import Extreme, KeyPoint, Point
from core.measurement.intervals import Interval
from core.measurement.key_point_errors import (
    is_between_key_points,
    key_points_of,
    marks_errors,
    with_key_point_renamed,
    with_marks_error,
)
from core.measurement.key_points import length_between, located
from core.measurement.measuring import measure_all
from core.measurement.measuring_job import MeasuringContext
from core.measurement.specs import AngleBetween, Length, LineFeature, Polyline, ScaleFactor, Volume
from tests.measurement.bodies import box
from tests.measurement.test_key_points import around, marks

BODY = box()
TIP_M, ROOT_M = np.array([3.0, -2.0, 0.5]), np.array([-2.0, 1.0, 0.0])
FAR = Extreme(near_m=np.zeros(3), direction=np.array([1.0, 0.0, 0.0]), radius_m=10.0)
SPECS = (
    Length(name="between", start=KeyPoint(name="tip"), end=KeyPoint(name="root")),
    LineFeature(name="to the hull", start=KeyPoint(name="tip"), end=FAR),
    Length(name="of the hull", start=FAR, end=Point(point_m=np.zeros(3))),
    AngleBetween(name="angle", first="between", second="of the hull"),
    ScaleFactor(name="factor", first="between", second="of the hull"),
    Volume(name="volume"),
)


def context_of(points):
    return MeasuringContext(key_points={point.name: point.position_m for point in points})


def errors_of(points, covariances=None):
    context = context_of(points)
    results = dict(zip([s.name for s in SPECS], measure_all(SPECS, BODY, context), strict=True))
    given_m2 = {p.name: p.covariance_m2 for p in points} if covariances is None else covariances
    return results, marks_errors(SPECS, BODY, context, results, given_m2)


def points_of(seed, sigma_px=0.5):
    projections, random = around(4, seed), np.random.default_rng(seed)
    return [
        located(
            name,
            projections,
            marks(projections, place) + random.normal(0.0, sigma_px, (4, 2)),
            sigma_px=sigma_px,
        )
        for name, place in (("tip", TIP_M), ("root", ROOT_M))
    ]


@settings(max_examples=20)
@given(seed=st.integers(0, 10**6))
def test_a_length_between_key_points_has_the_interval_of_the_points_themselves(seed):
    points = points_of(seed)
    results, errors = errors_of(points)
    alone = length_between(*points)
    assert errors["between"] == pytest.approx(alone.standard_error_m, rel=1e-2)
    interval = with_marks_error(results["between"].value, errors["between"], None)
    assert interval.low == pytest.approx(alone.low_m, abs=0.02 * alone.standard_error_m)
    assert interval.high == pytest.approx(alone.high_m, abs=0.02 * alone.standard_error_m)
    assert interval.method == "95 % interval: from the marks of its key points"


def test_errors_are_the_scatter_of_what_marks_give_also_by_way_of_others():
    _, errors = errors_of(points_of(3))
    drawn = {name: [] for name in errors}
    for seed in range(300):
        random, projections = np.random.default_rng(seed), around(4, 3)
        points = [
            located(n, projections, marks(projections, p) + random.normal(0, 0.5, (4, 2)))
            for n, p in (("tip", TIP_M), ("root", ROOT_M))
        ]
        for name, result in zip(
            [spec.name for spec in SPECS],
            measure_all(SPECS, BODY, context_of(points)),
            strict=True,
        ):
            if name in drawn:
                drawn[name].append(result.value)
    assert set(errors) == {"between", "to the hull", "angle", "factor"}
    for name, values in drawn.items():
        assert errors[name] == pytest.approx(np.std(values), rel=0.15)


def test_a_hulls_own_interval_is_added_in_quadrature():
    hull = Interval(
        value=5.0,
        low=4.4,
        high=5.3,
        eroded=4.9,
        dilated=5.1,
        standard_error=0.1,
        cells=0.5,
        groups=8,
    )
    both = with_marks_error(5.0, 0.2, hull)
    half = 0.2 * 1.959964
    assert both.low == pytest.approx(5.0 - np.hypot(0.6, half), abs=1e-6)
    assert both.high == pytest.approx(5.0 + np.hypot(0.3, half), abs=1e-6)
    assert (both.eroded, both.dilated, both.groups) == (4.9, 5.1, 8)
    assert "key points, outlines ± 0.5 cells, and jackknife leaving out 8" in both.method
    exact = with_marks_error(5.0, 0.0, hull)
    assert (exact.low, exact.high) == pytest.approx((4.4, 5.3))
    assert with_marks_error(5.0, float("nan"), hull) is None


def test_what_is_lost_when_a_key_point_moves_has_no_error():
    points = points_of(3)
    _, errors = errors_of(points, {})
    assert errors == {"between": 0.0, "to the hull": 0.0, "angle": 0.0, "factor": 0.0}
    without = MeasuringContext(key_points={"tip": TIP_M})
    results = dict(zip([s.name for s in SPECS], measure_all(SPECS, BODY, without), strict=True))
    errors = marks_errors(SPECS, BODY, without, results, {"tip": np.eye(3)})
    assert np.isnan(errors["between"])
    assert np.isnan(errors["angle"])
    assert errors["to the hull"] > 0


def test_a_renamed_key_point_is_found_by_its_new_name_and_nothing_else_changes():
    between, to_hull, of_hull, *_ = (with_key_point_renamed(s, "tip", "edge") for s in SPECS)
    assert (between.start.name, between.end.name) == ("edge", "root")
    assert to_hull.start.name == "edge"
    assert encoded(to_hull.end) == encoded(FAR)
    assert encoded(of_hull) == encoded(SPECS[2])


def test_specs_know_their_key_points_and_whether_the_hull_enters():
    between, to_hull, of_hull, angle, *_ = SPECS
    fixed = Length(name="f", start=Point(point_m=TIP_M), end=Point(point_m=ROOT_M))
    assert not is_between_key_points(fixed)
    chain = Polyline(name="c", anchors=(KeyPoint(name="a"), Point(point_m=TIP_M)))
    assert [key_points_of(s) for s in (between, to_hull, of_hull, angle, chain)] == [
        {"tip", "root"},
        {"tip"},
        set(),
        set(),
        {"a"},
    ]
    assert [is_between_key_points(s) for s in (between, to_hull, of_hull, angle, chain)] == [
        True,
        False,
        False,
        False,
        True,
    ]
