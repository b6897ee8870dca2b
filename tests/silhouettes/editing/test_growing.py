import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis.extra.numpy import arrays
from scipy.ndimage import label

from core.silhouettes.areas import rings_of
from core.silhouettes.contours import traced_rings
from core.silhouettes.editing.growing import grown
from core.silhouettes.silhouette import Silhouette
from tests.silhouettes.editing.shapes import frame_of, hausdorff_px


def mask_of(rings, shape):
    return Silhouette(rings=rings, image_shape=shape, claim="complete").mask()


@settings(max_examples=40)
@given(levels=arrays(np.int8, (9, 11), elements={"min_value": 0, "max_value": 5}))
def test_the_region_is_the_seeds_component_above_the_tolerance(levels):
    level_db = -6.0 * levels
    frame = frame_of(10 ** (level_db / 20))
    rings = grown(frame, (4, 5), 9.0, smoothing_px=0.0, smallest_hole_px=0)
    parts, _ = label(level_db > level_db[4, 5] - 9.0, np.ones((3, 3)))
    wanted = parts == parts[4, 5]
    # Simplification may cost a pixel centre that the edge only just left inside.
    assert np.count_nonzero(mask_of(rings, frame.shape) ^ wanted) <= 2


def test_speckle_of_a_panel_grows_to_the_panel():
    random = np.random.default_rng(7)
    amplitude = random.rayleigh(0.01, (60, 80))
    amplitude[20:40, 25:60] = random.rayleigh(1.0, (20, 35))
    rings = grown(frame_of(amplitude), (30, 40), 14.0, smoothing_px=1.5)
    (panel,) = (ring for ring in rings if len(ring) == max(map(len, rings)))
    assert hausdorff_px((panel,), rings_of(shapely.box(19.5, 24.5, 39.5, 59.5))) < 3.5


def test_the_edge_lies_where_the_level_is_crossed():
    amplitude = np.full((20, 40), 10 ** (np.linspace(0, -40, 40) / 20))
    (ring,) = grown(frame_of(amplitude), (10, 0), 10.5, smoothing_px=0.0)
    assert ring[:, 1].max() == pytest.approx(10.5 * 39 / 40, abs=1e-3)


def test_a_dark_gap_grows_within_itself_only_without_brighter_ones():
    amplitude = np.ones((20, 20))
    amplitude[8:12, 8:12] = 0.01
    frame = frame_of(amplitude)
    (gap,) = grown(frame, (10, 10), 6.0, smoothing_px=0.0, brighter_too=False)
    assert Silhouette(rings=(gap,), image_shape=(20, 20), claim="complete").mask().sum() == 16
    whole = grown(frame, (10, 10), 6.0, smoothing_px=0.0)
    assert mask_of(whole, (20, 20)).all()


def test_pinholes_are_filled_and_larger_holes_stay():
    amplitude = np.ones((30, 30))
    amplitude[5, 5] = amplitude[20:25, 20:25] = 0.01
    rings = grown(frame_of(amplitude), (15, 10), 6.0, smoothing_px=0.0)
    assert len(rings) == 2


@settings(max_examples=60)
@given(mask=arrays(bool, (8, 10)))
def test_a_traced_mask_is_within_half_a_pixel_of_its_pixels(mask):
    """What every raster tool comes down to."""
    if not mask.any():
        return
    pixels = [shapely.box(r - 0.5, c - 0.5, r + 0.5, c + 0.5) for r, c in np.argwhere(mask)]
    exact = shapely.union_all(pixels).boundary
    traced = shapely.union_all(
        [shapely.LinearRing(ring) for ring in traced_rings(mask.astype(np.float32), 0.5)]
    )
    assert shapely.hausdorff_distance(exact.segmentize(0.1), traced) <= 0.5 + 1e-9
    assert shapely.hausdorff_distance(traced.segmentize(0.1), exact) <= 0.5 + 1e-9


@pytest.mark.parametrize(
    ("seed", "tolerance_db", "says"),
    [
        ((20, 3), 6.0, r"\(20, 3\) lies outside the image of 20 × 20"),
        ((-1, 3), 6.0, "outside"),
        ((np.nan, 3), 6.0, "A seed is a"),
        ((3, 3), 0.0, "positive decibels, got 0"),
        ((3, 3), np.nan, "positive decibels"),
    ],
)
def test_seeds_outside_and_tolerances_of_nothing_are_refused(seed, tolerance_db, says):
    with pytest.raises(ValueError, match=says):
        grown(frame_of(np.ones((20, 20))), seed, tolerance_db)
