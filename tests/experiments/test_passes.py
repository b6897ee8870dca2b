import numpy as np
import pytest

from core.experiments.passes import run_passes
from core.experiments.passes_results import Candidate, gain_percent, rank_correlations
from core.experiments.pictures import write_pictures


@pytest.fixture(scope="module")
def study():
    return run_passes(passes=6, frames=2, spacing_m=0.6, scatterers=5_000)


def value(study, name):
    return next(figure.value for figure in study.results.figures if figure.name == name)


def test_more_passes_never_add_volume_and_observe_what_one_cannot(study):
    volumes = [value(study, f"{name}: volume") for name in ("1 pass", "2 passes", "4 passes")]
    assert volumes == sorted(volumes, reverse=True)
    assert volumes[1] < 0.6 * volumes[0]
    assert value(study, "1 pass: directions unobserved") > 50
    assert value(study, "2 passes: directions unobserved") < 5
    assert value(study, "1 pass: error of extent y") is None
    assert abs(value(study, "2 passes: error of extent y")) < 15


def test_true_outlines_are_the_floor_and_echoes_keep_the_target(study):
    for name in ("1 pass", "2 passes", "4 passes", "Beijing, Shanghai", "all three and the pair"):
        assert value(study, f"{name}, true outlines: volume") < value(study, f"{name}: volume")
        assert value(study, f"{name}: coverage") > 0.9


def test_another_place_helps_where_more_frames_do_not(study):
    alone, more, pair, two = (
        value(study, f"{name}: volume")
        for name in (
            "Beijing",
            "Beijing, 3 times the frames",
            "Beijing and the pair",
            "Beijing, Shanghai",
        )
    )
    assert more > 0.75 * alone
    assert two < 0.6 * alone
    assert pair < 0.6 * alone


def test_the_pass_predicted_to_carve_most_nearly_does(study):
    assert value(study, "next after 1, expected carving: rank correlation") > 0.5
    assert value(study, "next after 1, expected carving: its best carves, of the best") > 80
    tables = [each for each in study.results.tables if each.title.startswith("The next pass")]
    assert [len(table.rows) for table in tables] == [5, 4]
    assert "After 1, the pass expected to carve most" in study.results.finding


def test_pictures_and_hull_come_out(study, tmp_path):
    assert study.hull.volume_m3() > 0
    names = [picture.name.removeprefix("passes-") for picture in study.pictures]
    assert names[:4] == ["growth", "stations", "lines-of-sight", "prediction"]
    assert names[4:] == ["frames", "hull", "errors", "directions"]
    assert len(write_pictures(study.pictures[:4], tmp_path)) == 4


def test_ranks_are_those_of_what_came():
    def candidate(number, confirmed_m3):
        return Candidate(
            label=str(number),
            elevation_deg=-number,
            predicted_m3=number,
            ball_m3=1.0,
            confirmed_m3=confirmed_m3,
        )

    candidates = [candidate(number, 10.0 * number**2) for number in range(1, 5)]
    assert rank_correlations(candidates) == pytest.approx((1, 0, -1))
    assert gain_percent(candidates) == pytest.approx((100, 100 / 16, 100 / 16))
    assert np.all(np.array(gain_percent([candidate(n, 0.0) for n in range(4)])) == 100)


@pytest.mark.parametrize("wrong", [{"passes": 5}, {"frames": 1}])
def test_too_few_passes_or_frames_are_refused(wrong):
    with pytest.raises(ValueError, match="at least 6 passes of 2 frames"):
        run_passes(**wrong)
