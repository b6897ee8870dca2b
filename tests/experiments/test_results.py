import json

import numpy as np
import pytest

from core.experiments.results import Figure, Results, Table


@pytest.mark.parametrize(
    ("value", "unit", "wanted", "met"),
    [
        (0.69, "%", "<= 0.7 %", True),
        (0.71, "%", "<= 0.7 %", False),
        (0.75, "", ">= 0.75", True),
        (0.75, "", "> 0.75", False),
        (-3.0, "dB", "< -2.5e0 dB", True),
        (49.0, "dB", "≥ 45 dB", True),
        (1.0, "m", None, None),
        (1.0, "m", "", None),
        (None, "%", "<= 4 %", False),
        (None, "%", None, None),
    ],
)
def test_whether_a_target_is_met_is_computed(value, unit, wanted, met):
    assert Figure(name="x", value=value, unit=unit, wanted=wanted).met is met


@pytest.mark.parametrize("wanted", ["0.7 %", "about 3 %", "<= %", "<= 0.7 m", "<= 0.7"])
def test_a_target_that_cannot_be_read_is_refused(wanted):
    with pytest.raises(ValueError, match='Figure "side"'):
        Figure(name="side", value=0.5, unit="%", wanted=wanted)


def test_a_value_that_is_not_finite_is_refused():
    with pytest.raises(ValueError, match="finite"):
        Figure(name="side", value=float("nan"))


def _results():
    figures = (
        Figure(name="error", value=np.float32(1.5), unit="%", wanted="<= 4 %"),
        Figure(name="overlap", value=None, wanted=">= 0.75"),
    )
    return Results(name="trial", settings={"spacing_m": 0.15}, figures=figures)


def test_json_has_the_agreed_form():
    assert json.loads(json.dumps(_results().to_json(), allow_nan=False)) == {
        "name": "trial",
        "settings": {"spacing_m": 0.15},
        "figures": [
            {"name": "error", "value": 1.5, "unit": "%", "wanted": "<= 4 %", "met": True},
            {"name": "overlap", "value": None, "unit": "", "wanted": ">= 0.75", "met": False},
        ],
    }


def test_figures_become_rows():
    results = _results()
    assert results.figures_table().rows == (
        ("error", "1.5 %", "<= 4 %", "met"),
        ("overlap", "none", ">= 0.75", "missed"),
    )
    assert not results.met


def test_a_ragged_table_is_refused():
    with pytest.raises(ValueError, match="1 cells for 2 columns"):
        Table(title="sides", columns=("axis", "m"), rows=(("x",),))
