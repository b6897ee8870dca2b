from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.ndimage import gaussian_filter

from core.silhouettes.editing.snapping import normals, snapped
from tests.silhouettes.editing.shapes import (
    area_px,
    assert_well_turned,
    body,
    box,
    coverage,
    disc,
    frame_of,
    hausdorff_px,
)


@cache
def blurred_disc(sensor):
    return blurred(disc(24.3, 29.6, 15, vertices=400), sensor)


def blurred(rings, sensor="optical", sigma=0.8):
    level = gaussian_filter(coverage(rings), sigma)
    return frame_of(np.sqrt(level) if sensor == "radar" else level, sensor=sensor)


@settings(max_examples=15)
@given(seed=st.integers(0, 1000), sensor=st.sampled_from(["radar", "optical"]))
def test_vertices_off_the_edge_return_to_it_to_a_tenth_of_a_pixel_rms(seed, sensor):
    true = disc(24.3, 29.6, 15, vertices=40)[0]
    off_px = np.random.default_rng(seed).uniform(-1.5, 1.5, len(true))
    rough = true + off_px[:, None] * normals(true)
    (ring,) = snapped((rough,), blurred_disc(sensor), 2.5, smoothing_px=0.5)
    error_px = np.hypot(*(ring - (24.3, 29.6)).T) - 15
    assert np.abs(error_px).max() < 0.25
    assert np.sqrt(np.mean(error_px**2)) < 0.1


def test_a_hole_snaps_as_well_as_a_ring():
    outer, hole = disc(24, 30, 18)[0], disc(24, 30, 9)[0][::-1]
    frame = blurred((outer, hole))
    after = snapped((outer, hole + np.array([0.0, 1.0])), frame, 2.0, smoothing_px=0.5)
    assert hausdorff_px(after, (outer, hole)) < 0.6
    assert_well_turned(after)
    assert area_px(after) == pytest.approx(area_px((outer, hole)), rel=0.01)


def test_vertices_move_along_their_normal_and_no_further_than_the_reach():
    rings = disc(24, 30, 12, vertices=30)
    (ring,) = snapped(rings, blurred(disc(24, 30, 15)), 1.0)
    assert np.abs(ring - rings[0]).max() == 0  # the edge is out of reach
    (ring,) = snapped(rings, blurred(disc(24, 30, 12.7)), 1.0)
    moved = ring - rings[0]
    assert np.abs(np.linalg.norm(moved, axis=1) - 0.7).max() < 0.15
    assert np.all(np.sum(moved * normals(rings[0]), axis=1) > 0)


def test_normals_point_out_of_rings_and_into_holes():
    plate, window, _ = body()
    out = normals(box(0, 0, 4, 6)[0])
    assert np.allclose(np.abs(out), np.sqrt(0.5))
    assert np.all(np.sum(out * (box(0, 0, 4, 6)[0] - (2, 3)), axis=1) > 0)
    assert np.all(np.sum(normals(window) * (window - window.mean(axis=0)), axis=1) < 0)
    assert np.all(np.sum(normals(plate) * (plate - plate.mean(axis=0)), axis=1) > 0)


@pytest.mark.parametrize("reach_px", [0.0, -1.0, np.nan, 61.0])
def test_a_reach_without_meaning_is_refused(reach_px):
    with pytest.raises(ValueError, match="at most the image's 60 pixels"):
        snapped(body(), blurred(body()), reach_px)
