import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from core.geometry.grid import VoxelGrid
from core.hull.surface import mask_surface
from core.measurement.anchors import Point
from core.measurement.axis_order import like, order_along
from core.measurement.measuring import measure_all
from core.measurement.measuring_job import MeasuringContext
from core.measurement.results import Lost
from core.measurement.specs import OrientedBox, Polyline, PrincipalAxes

BODY = PrincipalAxes(name="body")


def block(sides_m: tuple[float, float, float]):
    grid = VoxelGrid.cube(side_m=8.0, spacing_m=0.1)
    inside = np.abs(grid.centres_m().reshape(*grid.shape, 3)) < np.array(sides_m) / 2
    return mask_surface(inside.all(axis=-1), grid)


def measured(spec, surface):
    return measure_all([spec], surface, MeasuringContext(key_points={}))[0]


@given(
    st.permutations(range(3)),
    st.lists(st.sampled_from([-1, 1]), min_size=3, max_size=3),
    st.lists(st.floats(-0.3, 0.3), min_size=3, max_size=3),
)
def test_permuted_and_slightly_turned_axes_are_found_again(order, signs, turn):
    reference = Rotation.from_rotvec([0.4, -1.0, 0.2]).as_matrix()
    turned = reference @ Rotation.from_rotvec(turn).as_matrix().T
    axes = (turned * np.array(signs)[:, None])[order]
    assert np.argsort(order).tolist() == order_along(axes, reference).tolist()


@pytest.mark.parametrize("spec", [BODY, OrientedBox(name="box")])
def test_the_value_stays_with_its_axis_where_another_becomes_longer(spec):
    reference, other = (
        measured(spec, block((6.0, 5.6, 1.0))),
        measured(spec, block((5.2, 5.6, 1.0))),
    )
    assert abs(reference.direction[0]) == pytest.approx(1, abs=1e-3)
    assert other.value == pytest.approx(5.6, abs=0.15)
    alike = like(other, reference)
    assert alike.value == pytest.approx(5.2, abs=0.15)
    assert abs(alike.direction[0]) == pytest.approx(1, abs=1e-3)
    assert sorted(alike.sizes_m) == sorted(other.sizes_m)


def test_what_is_no_body_stays():
    surface = block((6.0, 4.0, 2.0))
    corner = [(0.0, 0.0, 0.0), (2.0, 0.0, 0.0), (2.0, 1.0, 0.0), (2.0, 1.0, 3.0)]
    line = Polyline(name="line", anchors=tuple(Point(point_m=np.array(each)) for each in corner))
    one = measured(line, surface)
    assert one.value == pytest.approx(6.0)
    assert like(one, one) is one
    lost = Lost(name="body", reason="gone")
    assert like(lost, one) is lost
    assert like(one, lost) is one
