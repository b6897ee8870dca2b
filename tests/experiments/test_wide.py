import pytest

from core.experiments.wide import run_wide


@pytest.fixture(scope="module")
def results():
    """The experiment with half the views and coarser voxels."""
    return run_wide(views=40, spacing_m=0.25, scatterers=30_000)


def value(results, name):
    return next(figure.value for figure in results.figures if figure.name == name)


def test_the_shadow_rule_finds_the_body(results):
    assert value(results, "IoU, shadow rule") > 0.7
    assert value(results, "coverage, shadow rule") > 0.95
    for name, percent in (("span", 4), ("length", 5), ("diameter", 12)):
        assert value(results, f"{name} error, shadow rule") < percent
        assert value(results, f"{name} attitude error, shadow rule") < 8


def test_the_strict_rule_carves_the_shaded_body_away(results):
    assert value(results, "IoU, strict rule") < 0.1


def test_the_same_seed_gives_the_same_figures():
    first, second = (run_wide(views=3, spacing_m=0.5, scatterers=2000, seed=4) for _ in range(2))
    assert first.to_json() == second.to_json()


def test_a_single_view_is_refused():
    with pytest.raises(ValueError, match="at least 2 views, got 1"):
        run_wide(views=1)
