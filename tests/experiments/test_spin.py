import pytest

from core.experiments.pictures import write_pictures
from core.experiments.spin import run_spin


@pytest.fixture(scope="module")
def study():
    return run_spin(
        frames=6,
        spacing_m=0.6,
        scatterers=4_000,
        rates_deg_per_s=(3.0,),
        starts=1,
        landscape_points=3,
    )


def value(study, name):
    return next(figure.value for figure in study.results.figures if figure.name == name)


def test_several_stations_find_the_spin_and_one_does_so_less(study):
    for stations in ("2 stations", "3 stations"):
        assert value(study, f"{stations}: axis error, worst") < 0.8
        assert value(study, f"{stations}: rate error, worst") < 0.3
    assert value(study, "1 station: axis error, worst") > value(
        study, "3 stations: axis error, worst"
    )


def test_outlines_agree_under_the_estimate_as_under_the_truth_and_not_at_the_start(study):
    rough, found, true = (
        value(study, f"agreement of outlines with the others' hull, {motion}")
        for motion in ("rough motion", "estimated motion", "true motion")
    )
    assert rough < true - 0.1
    assert found > true - 0.03


def test_the_estimated_motion_keeps_the_target_that_the_rough_one_cuts(study):
    rough, found = (
        value(study, f"3 stations, {motion}: coverage")
        for motion in ("rough motion", "estimated motion")
    )
    assert found > 0.97
    assert rough < found - 0.03


def test_another_station_never_adds_volume_under_the_true_motion(study):
    _, hulls = study.results.tables
    volumes = [float(row[3]) for row in hulls.rows if row[0].endswith("true motion")]
    assert volumes == sorted(volumes, reverse=True)


def test_pictures_and_hull_come_out(study, tmp_path):
    assert study.hull.volume_m3() > 0
    names = [path.stem for path in write_pictures(study.pictures[:1], tmp_path)]
    assert names == ["spin-landscape"]
    assert [picture.name for picture in study.pictures[1:]] == [
        f"spin-{what}" for what in ("frames", "hull-rough", "hull-estimated", "hull-true", "errors")
    ]
    assert "three stations find the spin within" in study.results.finding


def test_no_rate_is_refused():
    with pytest.raises(ValueError, match="needs a rate"):
        run_spin(rates_deg_per_s=())
