import numpy as np
import pytest
from hypothesis import given, settings
from scipy.spatial.transform import Rotation

from core.geometry.projection import Projection
from core.hull.surface import EMPTY_SURFACE
from core.hull.view import View
from core.measurement.components import place_in_whole, views_by_component
from core.silhouettes.silhouette import Silhouette
from tests.measurement.bodies import SHIFTS, TURNS, X, Z, box, joined, moved


def view(component):
    return View(
        silhouette=Silhouette(rings=(), image_shape=(9, 9), claim="complete", component=component),
        projection=Projection(matrix=np.eye(4)[:2]),
    )


def test_views_are_grouped_by_their_label():
    views = [view(label) for label in ("target", "panel", "target", "knife")]
    groups = views_by_component(views)
    assert list(groups) == ["target", "panel", "knife"]
    assert groups["target"] == (views[0], views[2])


@given(TURNS, SHIFTS)
@settings(max_examples=20)
def test_a_component_keeps_its_place_in_the_whole(turn, shift):
    tilt = Rotation.from_rotvec(0.3 * Z)
    panel = moved(box((3.0, 1.0, 0.2)), tilt, 4 * X)
    whole = joined(box((5, 2, 1)), panel)
    found = place_in_whole(moved(panel, turn, shift), moved(box((5, 2, 1)), turn, shift))
    np.testing.assert_allclose(found.offset_m, 4 * turn.apply(X), atol=1e-9)
    assert abs(found.offset_along_axes_m[0]) == pytest.approx(4)
    assert found.turn_rad == pytest.approx(0.3)
    assert found.volume_share == pytest.approx(0.06)
    np.testing.assert_allclose(found.component.extents_m, [3, 1, 0.2])
    assert place_in_whole(whole, whole).turn_rad == pytest.approx(0, abs=1e-6)


def test_an_empty_hull_has_no_place():
    with pytest.raises(ValueError, match="component's hull is empty"):
        place_in_whole(EMPTY_SURFACE, box())
