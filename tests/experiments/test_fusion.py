import pytest

from core.experiments.fusion import run_fusion


@pytest.fixture(scope="module")
def study():
    return run_fusion(frames=6, spacing_m=0.5, scatterers=6_000)


def value(study, name):
    return next(figure.value for figure in study.results.figures if figure.name == name)


def test_each_sensor_adds_to_the_other(study):
    both, *single = (
        value(study, f"{name}: volume") for name in ("both", "radar alone", "telescope alone")
    )
    assert both < 0.4 * min(single)
    assert value(study, "both: coverage") > 0.93


def test_more_optical_frames_never_add_volume(study):
    rows = study.results.tables[1].rows
    assert [row[0] for row in rows] == ["0", "1", "2 (all)"]
    volumes = [float(row[3]) for row in rows]
    assert volumes == sorted(volumes, reverse=True)
    assert volumes[0] == pytest.approx(value(study, "radar alone: volume"), abs=0.06)
    assert volumes[-1] == pytest.approx(value(study, "both: volume"), abs=0.06)


def test_both_sensors_together_leave_no_direction_unobserved(study):
    assert value(study, "radar alone: directions unobserved") > 50
    assert value(study, "both: directions unobserved") < 10


def test_whole_outlines_at_every_moment_are_better_than_the_sunlit_sides(study):
    whole = value(study, "true outlines, both, every moment: IoU")
    assert whole > value(study, "both: IoU")
    assert "of 6 moments" in study.results.finding
