import threading
from dataclasses import replace

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

from app.reference import (
    DISTANCE_COLOURS,
    ReferenceDesk,
    compared,
    distance_colours,
    reference_of,
)
from core.measurement.comparison import compare
from tests.app.test_viewport_measurements import snapshot_of
from tests.measurement.bodies import box, joined, surface_of

HULL = box((4.4, 2.4, 1.4), fineness=3)
BODY = trimesh.creation.box((4.0, 2.0, 1.0))


def test_a_box_02_m_larger_on_all_sides_is_02_m_outside():
    found = compared(HULL, reference_of(BODY, (1, 0, 0, 0), (0, 0, 0)).surface, **AT_ONE)
    # Its flat sides are 0.2 m away, only its edges and corners farther.
    assert found.mean_m == pytest.approx(0.2, abs=0.03)
    assert found.rms_m == pytest.approx(0.2, abs=0.03)
    assert found.comparison.hausdorff_m == pytest.approx(0.2 * np.sqrt(3))
    assert found.comparison.intersection_over_union == pytest.approx(8.0 / 14.784, abs=0.03)
    assert found.revision == 1
    assert found.limit_m == 0.4


AT_ONE = {"revision": 1, "spacing_m": 0.1}


def ball(radius_m, subdivisions, x_m):
    mesh = trimesh.creation.icosphere(radius=radius_m, subdivisions=subdivisions)
    return surface_of(mesh.apply_translation([x_m, 0, 0]))


def test_the_mean_is_over_the_hulls_area_however_many_faces_it_has_where():
    """A coarse ball lies 0.1 m outside the reference, a fine one on it."""
    hull = joined(ball(1.1, 3, -3), ball(1.0, 4, 3))
    reference = joined(ball(1.0, 4, -3), ball(1.0, 4, 3))
    found = compared(hull, reference, **AT_ONE)
    assert found.mean_m == pytest.approx(0.1 * 1.21 / 2.21, abs=0.003)
    assert found.rms_m == pytest.approx(0.1 * np.sqrt(1.21 / 2.21), abs=0.003)
    assert found.comparison.signed_distances_m.mean() < 0.025


def test_a_reference_stands_in_its_own_attitude():
    turn = Rotation.from_rotvec([0.3, -0.5, 0.8])
    x, y, z, w = turn.as_quat()
    hull = box((4.0, 2.0, 1.0))
    placed = reference_of(BODY, (2 * w, 2 * x, 2 * y, 2 * z), (1.0, 2.0, 3.0))
    np.testing.assert_allclose(
        placed.surface.vertices_m, turn.apply(BODY.vertices) + np.array([1.0, 2.0, 3.0]), atol=1e-12
    )
    assert placed.is_closed
    straight = reference_of(BODY, (1, 0, 0, 0), (0, 0, 0))
    assert compare(hull, straight.surface, spacing_m=0.1).hausdorff_m < 1e-9


@pytest.mark.parametrize("attitude", [(0, 0, 0, 0), (1, 0, 0, np.nan)])
def test_a_quaternion_that_turns_nothing_is_refused(attitude):
    with pytest.raises(ValueError, match="--reference-attitude wants a quaternion w x y z"):
        reference_of(BODY, attitude, (0, 0, 0))
    with pytest.raises(ValueError, match="finite"):
        reference_of(BODY, (1, 0, 0, 0), (np.inf, 0, 0))


def test_colours_go_from_blue_inside_over_white_to_red_outside():
    ends = ["#{:02x}{:02x}{:02x}".format(*colour) for colour in distance_colours(AT_ENDS)]
    assert ends == [DISTANCE_COLOURS[0], DISTANCE_COLOURS[2], DISTANCE_COLOURS[-1]]
    np.testing.assert_array_equal(distance_colours(9 * AT_ENDS), distance_colours(AT_ENDS))


AT_ENDS = np.array([-1.0, 0.0, 1.0])


class Shown:
    """What a desk was last told to colour."""

    def __init__(self):
        self.snapshot = snapshot_of(HULL)
        self.now = None
        self.changed = threading.Event()

    def show(self, done):
        self.now = done


def desk_of(shown, body=BODY):
    reference = reference_of(body, (1, 0, 0, 0), (0, 0, 0))
    return ReferenceDesk(
        reference.surface,
        lambda: shown.snapshot,
        shown.show,
        shown.changed.set,
        is_closed=reference.is_closed,
    )


def test_a_comparison_is_made_on_request_and_its_colours_go_with_the_hull():
    shown = Shown()
    desk = desk_of(shown)
    assert desk.facts() == {
        "is_running": False,
        "is_coloured": False,
        "complaint": "",
        "comparison": None,
    }
    desk.request()
    desk.wait(20)
    facts = desk.facts()
    assert facts["is_coloured"]
    assert facts["comparison"]["revision"] == 1
    assert facts["comparison"]["outside_m"] == pytest.approx(0.2 * np.sqrt(3))
    assert facts["comparison"]["inside_m"] == 0
    assert shown.now.surface is HULL
    assert shown.changed.is_set()

    desk.note(shown.snapshot)
    assert desk.facts()["is_coloured"]
    desk.note(snapshot_of(box((4.0, 2.2, 1.4)), revision=2))
    assert shown.now is None
    assert not desk.facts()["is_coloured"]
    assert desk.facts()["comparison"]["revision"] == 1


def test_what_cannot_be_compared_says_why():
    shown = Shown()
    shown.snapshot = snapshot_of(box((4.0, 2.0, 1.0)))
    opened = trimesh.Trimesh(BODY.vertices, BODY.faces[:-1], process=False)
    desk = desk_of(shown, opened)
    assert "is not closed" in desk.facts()["complaint"]
    shown.snapshot = replace(shown.snapshot, hull=replace(shown.snapshot.hull, is_preview=True))
    desk.request()
    desk.wait(20)
    assert "not kept yet" in desk.facts()["complaint"]
    assert desk.facts()["comparison"] is None
