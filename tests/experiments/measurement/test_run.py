import numpy as np
import pytest

from core.experiments.measurement.pictures import Measured, hull_picture
from core.experiments.measurement.run import PARTS, run_measurement
from core.experiments.measurement.settings import MeasurementSettings, case_named
from core.experiments.pictures import write_pictures
from core.hull.surface import EMPTY_SURFACE
from core.measurement.measuring import measure_all

SMALL = MeasurementSettings(
    targets=("Tiangong-like",),
    spacing_m=0.4,
    exact_views=8,
    exact_seeds=(1,),
    echo_views=5,
    scatterers=3000,
    draws=1,
    key_point_draws=60,
)


@pytest.mark.parametrize(
    ("part", "counted", "pictures"), [("exact", 7, 1), ("echoes", 7, 2), ("key-points", 81, 1)]
)
def test_each_part_hands_out_its_figures_and_pictures(part, counted, pictures, tmp_path):
    study = run_measurement(parts=(part,), settings=SMALL)
    results, drawn = study.results, study.pictures
    assert len(results.figures) == counted
    assert len(write_pictures(drawn, tmp_path)) == pictures
    assert results.to_json()["settings"]["parts"] == [part]
    if part == "exact":
        # Even eight outlines bound the span within a voxel.
        assert results.figures[0].value / 100 * 17 < 0.4


def test_key_points_err_as_their_covariance_says():
    results = run_measurement(parts=("key-points",), settings=SMALL).results
    ratios = [f.value for f in results.figures if "own covariance" in f.name]
    assert len(ratios) == 15
    # Each is the root of a mean of 60 χ² of three degrees: good to 0.05 or so.
    assert np.abs(np.array(ratios) - 1).max() < 0.25
    errors = {f.name: f.value for f in results.figures if f.name.endswith("median error")}
    few, many = (f"key point, {n} frames, marks ± 1 px: median error" for n in (3, 20))
    assert errors[few] > 1.5 * errors[many]


def test_a_lost_hull_is_drawn_without_lines(tmp_path):
    case = case_named("MRO-like")
    results = measure_all([feature.spec for feature in case.features], EMPTY_SURFACE)
    shown = Measured(case=case, surface=EMPTY_SURFACE, results=results)
    assert write_pictures([hull_picture("hull", "none", [shown])], tmp_path)


def test_unknown_names_are_refused():
    with pytest.raises(ValueError, match='no part "length"'):
        run_measurement(parts=("length",))
    with pytest.raises(ValueError, match="no target"):
        case_named("Hubble")
    assert PARTS[0] == "exact"
