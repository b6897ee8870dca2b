from dataclasses import replace

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from core.geometry.projection import range_doppler_projection
from core.hull.shadow import carving_view, filled_away_from_radar, shadow_region
from core.hull.view import View
from core.silhouettes.contours import traced_rings
from core.silhouettes.silhouette import Silhouette


def radar_projection(seed):
    random = np.random.default_rng(seed)
    direction = random.normal(size=3)
    return range_doppler_projection(
        line_of_sight=direction / np.linalg.norm(direction),
        line_of_sight_rate_per_s=random.normal(size=3),
        row_spacing_m=0.1,
        column_spacing_m=0.1,
        shape=(12, 12),
    )


def silhouette_of(mask):
    return Silhouette(
        rings=traced_rings(mask.astype(np.float32), 0.5), image_shape=mask.shape, claim="lit side"
    )


@settings(max_examples=60, deadline=None)
@given(mask=arrays(bool, (8, 10)))
def test_filling_is_the_running_or_along_range(mask):
    filled = filled_away_from_radar(silhouette_of(mask))
    assert np.array_equal(filled.mask(), np.logical_or.accumulate(mask, axis=0))


@given(seed=st.integers(0, 1000))
@settings(max_examples=10, deadline=None)
def test_only_lit_sides_are_filled_and_only_by_the_shadow_rule(seed):
    mask = np.zeros((12, 12), bool)
    mask[4:6, 4:6] = True
    projection = radar_projection(seed)
    lit = View(silhouette=silhouette_of(mask), projection=projection)
    complete = View(
        silhouette=Silhouette(rings=lit.silhouette.rings, image_shape=(12, 12), claim="complete"),
        projection=projection,
    )
    assert carving_view(lit, "strict") is lit
    assert carving_view(complete, "shadow") is complete
    assert carving_view(lit, "shadow").silhouette.area_px() > lit.silhouette.area_px()
    assert carving_view(lit, "shadow").silhouette.claim == "complete"


@settings(max_examples=40, deadline=None)
@given(mask=arrays(bool, (8, 10)))
def test_the_shadow_to_be_hatched_is_what_filling_adds_within_the_image(mask):
    silhouette = silhouette_of(mask)
    hatched = silhouette_of(mask * False)
    hatched = replace(hatched, rings=shadow_region(silhouette))
    filled = filled_away_from_radar(silhouette)
    assert np.array_equal(hatched.mask(), filled.mask() & ~mask)
    assert all(ring[:, 0].max() <= 7.5 for ring in hatched.rings)
    assert shadow_region(filled) == ()
