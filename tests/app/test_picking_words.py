import numpy as np
import pytest

from app.picking import Pick, Picking
from app.picking_words import free_line_name, hint_of
from core.measurement.anchors import Point
from tests.measurement.bodies import box


def test_line_features_are_numbered_as_in_the_paper():
    assert free_line_name(()) == "l₁"
    assert free_line_name({"l₁", "l₃", "span"}) == "l₂"
    assert free_line_name({f"l{n}".translate(str.maketrans("123", "₁₂₃")) for n in (1, 2, 3)}) == (
        "l₄"
    )


@pytest.mark.parametrize(
    ("picking", "hint"),
    [
        (Picking(kind="length"), "Length: click the first end"),
        (
            Picking(kind="length", snap="extreme"),
            "Length: click the first end, farthest out within 0.4 m",
        ),
        (Picking(kind="plane normal", snap="extreme"), "Plane normal: click a flat face"),
        (
            Picking(
                kind="polyline",
                picks=(Pick(anchor=Point(point_m=np.zeros(3)), place_m=np.zeros(3)),),
            ),
            "Polyline: click the next point, Enter ends it",
        ),
    ],
)
def test_the_hint_says_what_to_click_next(picking, hint):
    assert hint_of(picking, box((4.0, 2.0, 1.0))) == hint
