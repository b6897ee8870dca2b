import numpy as np
import pytest

from app.dimension_lines import is_hidden, step_aside_m
from app.layers import LENGTH_COLOUR, STALE_COLOUR
from app.measured_items import Item
from app.measurement_shapes import Arrows, End, Label, Lines, ShownHull, Tint, shapes_of
from core.measurement.anchors import SurfacePoint
from core.measurement.measuring import measure
from core.measurement.measuring_job import MeasuringContext
from core.measurement.regions import Patch
from core.measurement.results import Lost
from core.measurement.specs import (
    BoundingBox,
    CylinderAxis,
    Length,
    LineFeature,
    PlaneNormal,
    Polyline,
    PrincipalAxes,
    Section,
    Volume,
)
from tests.measurement.bodies import box, cylinder, joined

BODY = box((4.0, 2.0, 1.0), fineness=4)
HULL = ShownHull(surface=BODY, revision=3)


def at(*place):
    return SurfacePoint(near_m=np.array(place, dtype=float))


SPAN = Length(name="span", start=at(-2, 0, 0), end=at(2, 0, 0))


def item_of(spec, surface=BODY, **options):
    result = measure(spec, surface, MeasuringContext(revision=3))
    return Item(
        **(
            {"spec": spec, "is_hidden": False, "result": result, "interval": None, "change": None}
            | options
        )
    )


def test_a_length_inside_the_hull_is_drawn_beside_it_with_its_ends_on_it():
    shapes = shapes_of(item_of(SPAN), HULL)
    assert set(shapes) == {"lines", "end-0", "end-1", "label"}
    np.testing.assert_allclose(shapes["end-0"].place_m, [-2, 0, 0], atol=1e-9)
    line, *links = shapes["lines"].points_m
    assert np.linalg.norm(line[1] - line[0]) == pytest.approx(4.0)
    middle = line.mean(axis=0)
    assert abs(middle[2]) == pytest.approx(0.5 + 0.16, abs=0.01)
    assert not is_hidden(BODY, *line)
    np.testing.assert_allclose([link[0] for link in links], [[-2, 0, 0], [2, 0, 0]], atol=1e-9)
    assert shapes["label"].text == "span 4.00 m"
    np.testing.assert_allclose(shapes["label"].place_m, middle)


def test_a_length_in_the_open_stays_where_it_is():
    pair = joined(*(box(centre=(x, 0, 0), fineness=4) for x in (-5, 5)))
    start, end = np.array([-3.0, 0.2, 0]), np.array([3.0, -0.2, 0])
    np.testing.assert_array_equal(step_aside_m(pair, start, end), 0)
    through = step_aside_m(pair, start, np.array([7.0, 0, 0]))
    assert not is_hidden(pair, start + through, np.array([7.0, 0, 0]) + through)


def test_what_belongs_to_another_revision_or_a_preview_is_grey_and_says_so():
    for hull in (
        ShownHull(surface=BODY, revision=4),
        ShownHull(surface=BODY, revision=3, is_preview=True),
    ):
        shapes = shapes_of(item_of(SPAN), hull)
        assert shapes["lines"].colour == STALE_COLOUR
        assert shapes["label"].text == "span 4.00 m (revision 3)"
    assert shapes_of(item_of(SPAN), HULL)["lines"].colour == LENGTH_COLOUR


def test_a_length_that_no_view_constrains_is_no_plain_number():
    assert shapes_of(item_of(SPAN, observability="unobserved"), HULL)["label"].text == (
        "span unobserved"
    )


def test_nothing_is_drawn_of_what_is_hidden_lost_or_not_measured_yet():
    lost = Lost(name="span", reason="It is gone.")
    for change in ({"is_hidden": True}, {"result": lost}, {"result": None}):
        assert shapes_of(item_of(SPAN, **change), HULL) == {}
    assert shapes_of(item_of(Volume(name="all")), HULL) == {}


def test_a_polyline_has_an_end_to_drag_at_each_anchor():
    spec = Polyline(name="way", anchors=(at(-2, 0, 0), at(0, 1, 0), at(2, 0, 0)))
    shapes = shapes_of(item_of(spec), HULL)
    ends = [shape for shape in shapes.values() if isinstance(shape, End)]
    assert [end.number for end in ends] == [0, 1, 2]
    assert shapes["lines"].points_m.shape == (2, 2, 3)


def test_a_plane_has_its_support_tinted_and_an_arrow_along_its_normal():
    spec = PlaneNormal(name="top", region=Patch(near_m=np.array([0, 0, 0.5]), angle_rad=0.3))
    shapes = shapes_of(item_of(spec), HULL)
    tint, arrows = shapes["support"], shapes["arrows"]
    assert isinstance(tint, Tint)
    assert np.all(tint.surface.vertices_m[:, 2] >= 0.5)
    assert np.all(tint.surface.vertices_m[:, 2] < 0.52)
    ((tail, tip),) = arrows.points_m
    np.testing.assert_allclose(tip - tail, [0, 0, 0.6], atol=0.02)
    assert "support" not in shapes_of(item_of(spec), ShownHull(surface=BODY, revision=4))


def test_axes_stick_out_of_the_hull_on_both_sides():
    body = cylinder(radius=1.0, length=6.0)
    hull = ShownHull(surface=body, revision=3)
    side = Patch(near_m=np.array([0, 0, 1.0]), angle_rad=0.2, growth="smooth")
    for spec in (CylinderAxis(name="tube", region=side), PrincipalAxes(name="axes")):
        arrows = shapes_of(item_of(spec, body), hull)["arrows"]
        assert isinstance(arrows, Arrows)
        along = arrows.points_m[:, 1, 0]
        assert along.max() > 3.2
        assert along.min() < -3.2


def test_a_section_is_drawn_as_closed_curves():
    shapes = shapes_of(item_of(Section(name="cut", normal=np.array([1.0, 0, 0]))), HULL)
    lines = shapes["lines"]
    assert isinstance(lines, Lines)
    np.testing.assert_array_equal(lines.points_m[0, 0], lines.points_m[-1, 1])
    assert np.linalg.norm(np.diff(lines.points_m, axis=1), axis=2).sum() == pytest.approx(6.0)
    assert shapes["label"].text == "cut 2.00 m²"
    assert shapes["label"].place_m[2] == pytest.approx(-0.5)


def test_a_box_has_twelve_edges():
    lines = shapes_of(item_of(BoundingBox(name="box")), HULL)["lines"]
    lengths = np.linalg.norm(lines.points_m[:, 1] - lines.points_m[:, 0], axis=1)
    np.testing.assert_allclose(np.sort(lengths), [1] * 4 + [2] * 4 + [4] * 4)


def test_a_line_feature_is_drawn_as_a_length():
    spec = LineFeature(name="l₁", start=at(-2, 0, 0), end=at(2, 0, 0))
    label = shapes_of(item_of(spec), HULL)["label"]
    assert isinstance(label, Label)
    assert label.text == "l₁ 4.00 m"
