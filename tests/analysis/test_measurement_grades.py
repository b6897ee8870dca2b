"""What the views of one plane leave unobserved has no grade but that."""

import numpy as np

from core.analysis.measurement_grades import graded
from core.geometry.grid import VoxelGrid
from core.hull.hull_only import carved_surface
from core.measurement.anchors import Point
from core.measurement.extents import axis_extents
from core.measurement.measuring import measure_all
from core.measurement.specs import (
    AngleBetween,
    BoundingBox,
    Length,
    Polyline,
    ScaleFactor,
    Section,
    Volume,
)
from tests.measurement.test_observability import square_view

GRID = VoxelGrid.cube(side_m=8.0, spacing_m=0.25)


def grades(views, specs):
    surface = carved_surface(views, GRID)
    extents = axis_extents(surface, GRID, views)
    return graded(measure_all(specs, surface), specs, views, GRID, extents)


def line(name, *end_m):
    return Length(name=name, start=Point(point_m=np.zeros(3)), end=Point(point_m=end_m))


def test_lengths_are_graded_along_their_lines_and_what_rests_on_them_as_the_worst() -> None:
    views = [square_view([0, 0, 1], turn) for turn in (0.0, 0.5, 1.0)]
    specs = (
        line("x", 1, 0, 0),
        line("z", 0, 0, 1),
        Polyline(name="both", anchors=(*[Point(point_m=p) for p in np.eye(3)],)),
        ScaleFactor(name="good", first="x", second="x"),
        ScaleFactor(name="open", first="z", second="x"),
        AngleBetween(name="turn", first="x", second="z"),
        Section(name="across z", normal=[0, 0, 1]),
        Section(name="along z", normal=[1, 0, 0]),
        Volume(name="volume"),
        BoundingBox(name="box"),
        line("nothing", 0, 0, 0),
        ScaleFactor(name="of nothing", first="x", second="nothing"),
    )
    told = dict(zip([spec.name for spec in specs], grades(views, specs), strict=True))
    assert [told[name] for name in ("x", "good")] == ["good"] * 2
    assert [told[name] for name in ("z", "both", "open", "turn")] == ["unobserved"] * 4
    # The grid ends the body, and so do all numbers that reach as far as it does.
    assert [told[name] for name in ("across z", "along z", "volume", "box")] == ["unobserved"] * 4
    assert (told["nothing"], told["of nothing"]) == (None, None)


def test_what_ends_at_the_grid_is_unobserved_and_the_rest_is_not() -> None:
    views = [square_view([0, 0, 1], turn) for turn in (0.0, 0.5, 1.0)]
    specs = (line("inside", 1, 0, 0), line("to the side", 4, 0, 0))
    assert grades(views, specs) == ("good", "unobserved")


def test_views_from_all_around_observe_everything() -> None:
    views = [square_view(normal) for normal in np.random.default_rng(3).normal(size=(12, 3))]
    specs = (line("z", 0, 0, 1), Volume(name="v"), Section(name="s", normal=[0, 1, 1]))
    assert set(grades(views, specs)) == {"good"}
