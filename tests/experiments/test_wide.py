import pytest

from core.experiments.pictures import write_pictures
from core.experiments.wide import run_wide


@pytest.fixture(scope="module")
def study():
    """The experiment as the command line runs it."""
    return run_wide()


@pytest.fixture(scope="module")
def results(study):
    return study.results


def value(results, name):
    return next(figure.value for figure in results.figures if figure.name == name)


def test_every_target_is_met(results):
    assert [figure.name for figure in results.figures if figure.met is False] == []
    assert sum(figure.met is True for figure in results.figures) == 4


def test_the_hull_keeps_the_target_and_its_attitude(results):
    assert value(results, "coverage, shadow rule") > 0.95
    for name in ("span", "length", "diameter"):
        assert value(results, f"{name} attitude error, shadow rule") < 2


def test_the_strict_rule_carves_the_shaded_body_away(results):
    assert value(results, "IoU, strict rule") < 0.01


def test_the_finding_says_what_the_hull_keeps(results):
    kept = 100 * value(results, "coverage, shadow rule")
    assert f"the shadow rule keeps {kept:.1f} %" in results.finding
    assert "keeps 0.0 % (IoU 0.000)" in results.finding


def test_pictures_and_hull_come_out(study, tmp_path):
    assert 70 < study.hull.volume_m3() < 90
    names = [path.stem for path in write_pictures(study.pictures, tmp_path)]
    assert names == ["wide-frames", "wide-hull", "wide-errors"]


def test_the_same_seed_gives_the_same_figures():
    first, second = (run_wide(views=3, spacing_m=0.5, scatterers=2000, seed=4) for _ in range(2))
    assert first.results.to_json() == second.results.to_json()


def test_a_single_view_is_refused():
    with pytest.raises(ValueError, match="at least 2 views, got 1"):
        run_wide(views=1)
