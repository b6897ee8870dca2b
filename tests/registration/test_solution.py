import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from core.experiments.physics.bad_silhouettes import cut_in_half
from core.registration.extents import extent_equations
from core.registration.solution import solved
from tests.registration.shifting import (
    body_views,
    left_px,
    random_offsets,
    rms,
    shifted,
    translated,
)


@given(seed=st.integers(0, 1000))
@settings(max_examples=5)
def test_offsets_of_complete_outlines_are_found_exactly(seed):
    views = body_views(10, seed=seed)
    offsets = random_offsets(views, seed=seed)
    solution = solved(len(views), extent_equations(shifted(views, offsets)))
    assert np.abs(left_px(solution.offsets_px, offsets, views)).max() < 1e-6
    assert not solution.is_bad.any()


@given(translation=st.tuples(*[st.floats(-5, 5)] * 3))
@settings(max_examples=5)
def test_a_translation_of_the_whole_target_changes_no_offset(translation):
    views = shifted(body_views(8), random_offsets(body_views(8)))
    still = solved(len(views), extent_equations(views))
    gone = solved(len(views), extent_equations(translated(views, np.array(translation))))
    assert np.abs(still.offsets_px - gone.offsets_px).max() < 1e-5


@given(order=st.permutations(range(8)))
@settings(max_examples=5)
def test_the_order_of_views_is_irrelevant(order):
    views = shifted(body_views(8), random_offsets(body_views(8)))
    plain = solved(8, extent_equations(views)).offsets_px
    mixed = solved(8, extent_equations([views[number] for number in order])).offsets_px
    assert np.abs(plain[list(order)] - mixed).max() < 1e-5


def test_offsets_are_the_smallest_of_their_kind():
    views = body_views(8)
    offsets = solved(8, extent_equations(shifted(views, random_offsets(views)))).offsets_px
    matrix = np.concatenate([view.projection.matrix[:, :3] for view in views])
    assert np.abs(matrix.T @ offsets.ravel()).max() < 1e-3 * np.abs(matrix).max()


def test_half_silhouettes_are_found_out_and_move_no_other():
    views = body_views(20)
    offsets = random_offsets(views)
    seen = shifted(views, offsets)
    bad = [4, 13]
    for number in bad:
        seen[number] = cut_in_half(seen[number])
    solution = solved(20, extent_equations(seen))
    assert np.flatnonzero(solution.is_bad).tolist() == bad
    good = np.setdiff1d(np.arange(20), bad)
    left = left_px(solution.offsets_px[good], offsets[good], [views[number] for number in good])
    assert rms(left) < 0.05
