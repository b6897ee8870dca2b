import numpy as np
import pytest
import trimesh

from core.analysis.measured_body import DEFAULT_SPECS, Body, body_of_views, measured
from core.geometry.projection import Projection
from core.hull.closed_mesh import Surface
from core.hull.view import View
from core.measurement.results import Lost
from core.measurement.specs import PrincipalAxes, Volume
from core.reconstruction import ReconstructionSettings
from core.silhouettes.silhouette import Silhouette

SETTINGS = ReconstructionSettings(spacing_m=0.25, side_m=5.0)


def square(axis, half_m=1.0):
    """Return a cube's outline along an axis, 10 pixels per metre."""
    matrix = np.zeros((2, 4))
    matrix[[0, 1], [other for other in range(3) if other != axis]] = 10
    matrix[:, 3] = 32
    ring = 32 + 10 * half_m * np.array([[-1.0, -1], [-1, 1], [1, 1], [1, -1]])
    outline = Silhouette(rings=(ring,), image_shape=(64, 64), claim="complete")
    return View(silhouette=outline, projection=Projection(matrix=matrix))


CUBE = [square(axis) for axis in range(3)]


def by_name(rows):
    return {row.spec.name: row for row in rows}


def test_a_cubes_numbers_lie_in_their_intervals():
    rows = by_name(measured(body_of_views(CUBE * 2, SETTINGS), with_intervals=True))
    for row, value in ((rows["extents"], 2.0), (rows["volume"], 8.0)):
        assert row.result.value == pytest.approx(value, rel=0.05)  # corners are cut
        assert row.interval.low < value < row.interval.high
        assert row.entry().reading.low == row.interval.low
    # All edges outward by half a pixel of 0.1 m, and no frame says anything else.
    for size in rows["extents"].size_intervals:
        assert (size.low, size.high) == pytest.approx((1.9, 2.1), abs=0.01)


def test_an_extent_that_views_bound_is_one_also_beside_others_that_they_leave_open():
    rows = by_name(measured(body_of_views([CUBE[0], CUBE[0]], SETTINGS)))
    assert rows["extents"].size_grades == ("unobserved", "good", "good")
    assert rows["volume"].observability == "unobserved"
    assert rows["volume"].entry().reading is None


def test_a_mesh_has_neither_intervals_nor_grades():
    box = trimesh.creation.box()
    body = Body(surface=Surface(vertices_m=box.vertices, faces=box.faces))
    assert all(row.is_plain and row.observability is None for row in measured(body))
    with pytest.raises(ValueError, match="has no views"):
        measured(body, with_intervals=True)


def test_what_is_lost_has_no_reading_and_stops_no_other():
    empty = Body(surface=Surface(vertices_m=np.empty((0, 3)), faces=np.empty((0, 3))))
    rows = measured(empty, (Volume(name="v"), PrincipalAxes(name="p")))
    assert all(isinstance(row.result, Lost) and row.entry().reading is None for row in rows)


def test_no_view_is_no_hull():
    with pytest.raises(ValueError, match="no hull"):
        body_of_views([], SETTINGS)
    assert len({spec.name for spec in DEFAULT_SPECS}) == len(DEFAULT_SPECS)
