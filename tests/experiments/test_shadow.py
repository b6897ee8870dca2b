import numpy as np
import pytest

from core.experiments.pictures import write_pictures
from core.experiments.scopes import SCOPES, winged_box
from core.experiments.shadow import run_shadow
from core.experiments.voting_rules import METHODS


@pytest.fixture(scope="module")
def study():
    return run_shadow(frames=8, spacing_m=0.5, scatterers=4_000, targets=["laboratory"])


def value(study, scope, method, what):
    name = f"laboratory, {scope}, {method}: {what}"
    return next(figure.value for figure in study.results.figures if figure.name == name)


def test_the_shadow_rule_keeps_the_target_in_every_scope_and_the_strict_rule_in_none(study):
    for scope in SCOPES:
        assert value(study, scope, "shadow rule", "coverage") > 0.98
        assert value(study, scope, "strict", "coverage") < 0.5


def test_fewer_votes_keep_more_of_the_target(study):
    for scope in SCOPES:
        kept = [value(study, scope, method, "coverage") for method in METHODS[:4]]
        assert kept == sorted(kept)


def test_the_best_level_is_no_worse_than_otsus(study):
    for scope in SCOPES:
        best = value(study, scope, "energy, best level", "IoU")
        # It is the best of a hundred levels, and Otsu's is none of them.
        assert best > value(study, scope, "energy, Otsu", "IoU") - 0.01


def test_the_finding_names_what_was_found(study):
    shadow = value(study, "all around", "shadow rule", "IoU")
    assert f"the shadow rule reaches a mean IoU of {shadow:.3f}" in study.results.finding


def test_pictures_and_hull_come_out(study, tmp_path):
    assert study.hull.volume_m3() > 76
    names = [path.stem for path in write_pictures(study.pictures, tmp_path)]
    shown = ["shadow-frames", "shadow-rules", "shadow-hull", "strict-hull", "shadow-errors"]
    assert names == shown


def test_the_winged_box_reaches_as_far_as_its_line_says():
    target = winged_box()
    (span,) = target.features
    reach_m = np.ptp(target.mesh().vertices @ span.direction)
    assert reach_m == pytest.approx(span.length_m, abs=0.01)


def test_too_few_frames_and_unknown_targets_are_refused():
    with pytest.raises(ValueError, match="at least 4 frames, got 3"):
        run_shadow(frames=3)
    with pytest.raises(ValueError, match='got "mirror"'):
        run_shadow(frames=4, targets=["mirror"])
