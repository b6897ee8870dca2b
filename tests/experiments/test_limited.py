import numpy as np
import pytest

from core.experiments.beijing_pass import PAPER_SPANS_DEG, beijing_pass
from core.experiments.limited import run_limited
from core.experiments.pictures import write_pictures


@pytest.fixture(scope="module")
def study():
    return run_limited(frames=7, spacing_m=0.6, scatterers=8_000)


def value(study, name):
    return next(figure.value for figure in study.results.figures if figure.name == name)


def test_the_pass_spans_about_what_the_papers_does():
    seen = beijing_pass(frames=2)
    assert np.abs(np.subtract(seen.station_spans_deg(), PAPER_SPANS_DEG)).max() < 3
    assert np.rad2deg(seen.track.elevation_rad.min()) == pytest.approx(10, abs=0.1)
    assert seen.track.range_m.min() > 400e3


def test_the_shadow_rule_keeps_the_target_and_the_strict_one_does_not(study):
    assert value(study, "echoes, shadow rule: coverage") > 0.95
    assert value(study, "echoes, strict rule: coverage") < 0.7


def test_one_pass_leaves_the_hull_open_across_its_plane(study):
    table, directions = study.results.tables
    for row in table.rows[:3]:
        assert "not bounded" not in row[4]
        assert row[5:] == ("not bounded", "not bounded")
    assert value(study, "echoes, shadow rule: volume") > 5 * 76
    assert 50 < value(study, "echoes, shadow rule: directions unobserved") < 90
    assert directions.rows[0][1].startswith("good")
    assert "x along-track is bounded" in study.results.finding


def test_a_lit_side_bounds_fewer_directions_than_a_whole_outline(study):
    lit, whole = (
        value(study, f"{name}: directions unobserved")
        for name in ("echoes, shadow rule", "true outlines")
    )
    assert whole < lit - 10


def test_pictures_and_hull_come_out(study, tmp_path):
    assert study.hull.volume_m3() > 0
    names = [path.stem for path in write_pictures(study.pictures, tmp_path)]
    assert names == [f"limited-{what}" for what in ("frames", "hull", "errors", "directions")]


def test_a_pass_of_one_frame_is_refused():
    with pytest.raises(ValueError, match="at least 2 frames, got 1"):
        beijing_pass(frames=1)
