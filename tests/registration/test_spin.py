from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from core.benchmarks.workload import satellite
from core.geometry.spin import Spin
from core.registration.spin import (
    SpinAgreement,
    SpinningOutline,
    estimate_spin,
    extents_miss_px,
    spin_views,
)
from core.silhouettes.areas import rings_of
from core.silhouettes.silhouette import Silhouette

TRUE = Spin(axis=np.array([0.5, 0.3, 0.81]), rate_rad_per_s=0.05)
SHAPE = (256, 256)
STATIONS = np.array([[-0.46, -0.8, 0.38], [0.32, -0.67, 0.67]])


def exact_outlines(stations, moving_rad_per_s, frames=8):
    """Exact whole outlines of the target from stations whose lines of sight move a little."""
    parts, outlines = satellite(16), []
    for station in stations:
        first = station / np.linalg.norm(station)
        across = np.cross(first, [0, 1, 0])
        across /= np.linalg.norm(across)
        for time_s in np.linspace(-50, 50, frames):
            angle = moving_rad_per_s * time_s
            bare = SpinningOutline(
                silhouette=Silhouette(rings=(), image_shape=SHAPE, claim="complete"),
                time_s=time_s,
                line_of_sight=np.cos(angle) * first + np.sin(angle) * across,
                line_of_sight_rate_per_s=moving_rad_per_s
                * (np.cos(angle) * across - np.sin(angle) * first),
                row_spacing_m=0.05,
                column_spacing_m_per_s=0.05 * 0.04,
            )
            outlines.append(filled(bare, parts))
    return outlines


def filled(bare, parts):
    (view,) = spin_views([bare], TRUE)
    images = [shapely.multipoints(view.projection.image_points(part)) for part in parts]
    outline = shapely.union_all(shapely.convex_hull(images))
    silhouette = Silhouette(rings=rings_of(outline), image_shape=SHAPE, claim="complete")
    return replace(bare, silhouette=silhouette)


@pytest.fixture(scope="module")
def outlines():
    return exact_outlines(STATIONS, 0.004)


@pytest.fixture(scope="module")
def agreement(outlines):
    return SpinAgreement(outlines, TRUE)


def off(tilt_deg, rate_percent):
    return TRUE.changed(np.deg2rad(tilt_deg), 1 + rate_percent / 100)


def test_a_projection_holds_range_and_range_rate(outlines):
    spin, point = off((3, -2), 5), np.array([1.5, -2.0, 0.7])
    for outline, view in zip(outlines, spin_views(outlines, spin), strict=True):
        row, column = view.projection.image_points(point) - 128
        step_s = 1e-3

        def range_m(at_s, outline=outline):
            (attitude,) = spin.attitude(np.array([outline.time_s + at_s]))
            moved = outline.line_of_sight + at_s * outline.line_of_sight_rate_per_s
            return moved @ attitude @ point

        assert row * 0.05 == pytest.approx(range_m(0.0))
        rate_m_per_s = (range_m(step_s) - range_m(-step_s)) / (2 * step_s)
        assert column * 0.05 * 0.04 == pytest.approx(rate_m_per_s, abs=1e-6)


def test_the_true_spin_leaves_nothing(outlines, agreement):
    assert extents_miss_px(outlines, TRUE) < 1e-6
    assert agreement(TRUE) > 0.95  # distances are of pixels


@given(
    st.floats(0, 2 * np.pi),
    st.floats(2, 8),
    st.sampled_from([-6.0, -2.0, 0.0, 3.0]),
)
@settings(max_examples=12, deadline=None)
def test_every_wrong_spin_agrees_less(outlines, agreement, direction, tilt_deg, rate_percent):
    wrong = off(tilt_deg * np.array([np.cos(direction), np.sin(direction)]), rate_percent)
    assert agreement(wrong) < agreement(TRUE) - 0.01
    assert extents_miss_px(outlines, wrong) > 0.1


@pytest.mark.parametrize("start", [((6, -4), 4), ((-5, 7), -5)])
def test_exact_outlines_of_two_stations_give_the_spin_back(outlines, start):
    found = estimate_spin(outlines, off(*start))
    assert np.rad2deg(found.spin.axis_angle_rad(TRUE)) < 0.1
    assert found.spin.rate_rad_per_s == pytest.approx(TRUE.rate_rad_per_s, rel=1e-3)
    assert found.miss_px < 0.1 < found.start_miss_px


def test_a_turn_about_a_line_of_sight_that_never_moves_changes_nothing():
    outlines = exact_outlines(STATIONS[:1], 0.0)
    sight = STATIONS[0] / np.linalg.norm(STATIONS[0])
    angle = np.deg2rad(20)
    axis = (
        np.cos(angle) * TRUE.axis
        + np.sin(angle) * np.cross(sight, TRUE.axis)
        + (1 - np.cos(angle)) * (sight @ TRUE.axis) * sight
    )
    turned = Spin(axis=axis, rate_rad_per_s=TRUE.rate_rad_per_s)
    assert extents_miss_px(outlines, turned) < 1e-6


def test_two_outlines_an_empty_one_and_a_start_at_rest_are_refused(outlines):
    with pytest.raises(ValueError, match="at least 3 outlines, none of them empty; of 2, 2"):
        estimate_spin(outlines[:2], TRUE)
    empty = replace(
        outlines[0], silhouette=Silhouette(rings=(), image_shape=SHAPE, claim="complete")
    )
    with pytest.raises(ValueError, match="of 17, 16 are not"):
        SpinAgreement([*outlines, empty], TRUE)
    with pytest.raises(ValueError, match="rate is scaled by the search"):
        estimate_spin(outlines, Spin(axis=TRUE.axis, rate_rad_per_s=0.0))
