import numpy as np
import pytest

from core.experiments.interval_coverage import QUANTITIES, interval_coverage, small_satellite


def test_most_of_a_few_draws_hold_the_truth():
    told = []
    results = interval_coverage(
        draws=4,
        views=20,
        view_sets=2,
        progress=lambda _stage, done, total: told.append((done, total)),
    )
    assert told[-1] == (4, 4)
    values = {figure.name: figure for figure in results.figures}
    for name, unit in QUANTITIES:
        held = values[f"{name}: intervals that hold it"]
        assert held.value >= 50
        assert held.wanted == ">= 90 %"
        assert values[f"{name}: median half-width"].unit == unit
        assert abs(values[f"{name}: mean error"].value) < values[f"{name}: median half-width"].value
    assert values["span: intervals that hold it"].value in 25 * np.arange(5)


def test_the_body_s_own_numbers_are_those_it_was_made_with():
    bounds = [part.bounding_box_oriented.primitive.extents for part in small_satellite().parts]
    assert sorted(bounds[0]) == pytest.approx([1.8, 1.8, 4.0])
    assert sorted(bounds[1]) == pytest.approx([0.3, 1.2, 7.0])


def test_no_draws_are_refused():
    with pytest.raises(ValueError, match="got 0 draws of 4 sets"):
        interval_coverage(draws=0)
