import numpy as np
import pytest

from core.experiments.pictures import write_pictures
from core.experiments.threshold.run import run_threshold


@pytest.fixture(scope="module")
def study():
    return run_threshold(views=20, spacing_m=0.7, scatterers=4_000, wrong=(0, 4), draws=1)


def value(study, name):
    return next(figure.value for figure in study.results.figures if figure.name == name)


def test_wrong_frames_take_the_target_away_and_tolerance_gives_it_back(study):
    head = "shadow rule, 4 wrong"
    hurt = value(study, f"{head}, all: coverage")
    assert hurt < value(study, "shadow rule, 0 wrong, all: coverage") - 0.1
    assert value(study, f"{head}, all − 2: coverage") > hurt + 0.1


def test_blame_finds_another_body_but_no_outline_that_is_too_large(study):
    assert value(study, "3 foreign: found by blame") >= 2
    hurt = value(study, "3 foreign, all: coverage")
    assert value(study, "3 foreign, blame, then all: coverage") > hurt + 0.1
    assert value(study, "3 too large: found by blame") == 0


def test_tolerating_more_misses_never_loses_more_of_the_target(study):
    for rule in ("shadow", "strict"):
        covered = [
            value(study, f"{rule} rule, 4 wrong, {method}: coverage")
            for method in ("all", "all − 2", "all − 5", "all − 10")
        ]
        assert np.all(np.diff(covered) >= 0)


def test_pictures_and_tables_come_out(study, tmp_path):
    assert [table.rows[0][0] for table in study.results.tables] == ["0", "0", "too small"]
    names = [path.stem for path in write_pictures(study.pictures, tmp_path)]
    assert names == [f"threshold-{what}" for what in ("curves", "frames", "hulls", "errors")]


def test_more_wrong_frames_than_views_are_refused():
    with pytest.raises(ValueError, match="10 wrong frames need at least two right ones"):
        run_threshold(views=11)
