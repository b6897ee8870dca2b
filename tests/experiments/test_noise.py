import numpy as np
import pytest

from core.experiments.accuracy_conditions import Accuracy, Condition, hull_accuracy, sights
from core.experiments.accuracy_curves import Curve
from core.experiments.noise import run_noise
from core.experiments.pictures import write_pictures
from core.geometry.grid import VoxelGrid
from core.targets import tiangong_like

SMALL = {
    "views": 16,
    "spacing_m": 0.6,
    "scatterers": 4_000,
    "resolution_m": 0.4,
    "levels_db": (-20.0, -5.0),
    "resolutions_m": (1.2,),
    "frames": (4, 8),
    "seeds": 1,
}


@pytest.fixture(scope="module")
def study():
    return run_noise(**SMALL)


def value(study, name):
    return next(figure.value for figure in study.results.figures if figure.name == name)


def test_noise_loses_the_target(study):
    drowned, faint, clear = (value(study, f"{level} dB: IoU") for level in ("−20", "−5", "20"))
    assert drowned == 0
    assert faint < clear - 0.1
    assert value(study, "−20 dB: mean length error") is None
    assert clear > 0.4
    assert value(study, "20 dB: coverage") > 0.8


def test_more_of_the_same_frames_only_carve_and_do_so_where_nothing_is(study):
    counts = ("4", "8", "16")
    coverage = [value(study, f"{count} frames: coverage") for count in counts]
    agreement = [value(study, f"{count} frames: IoU") for count in counts]
    assert coverage == sorted(coverage, reverse=True)
    assert agreement == sorted(agreement)


def test_a_finer_image_gives_a_better_hull(study):
    assert value(study, "0.4 m: IoU") > value(study, "1.2 m: IoU") + 0.05


def test_every_curve_passes_through_the_centre(study):
    through = {value(study, f"{name}: IoU") for name in ("centre", "20 dB", "0.4 m", "16 frames")}
    assert len(through) == 1
    assert f"IoU is {through.pop():.3f}" in study.results.finding
    assert "resolution: nowhere lengths within 2 %" in study.results.finding
    assert [table.rows[-1][1] for table in study.results.tables[::2]] == [
        study.results.tables[1].rows[0][1]
    ] * 2


def test_pictures_and_hull_come_out(study, tmp_path):
    assert study.hull.volume_m3() > 50
    assert [picture.name for picture in study.pictures] == [
        f"noise-{what}" for what in ("curves", "frames", "resolutions", "hull", "errors")
    ]
    (curves,) = write_pictures(study.pictures[:1], tmp_path)
    assert curves.stat().st_size > 10_000


def test_a_seed_looks_along_the_same_lines_at_every_resolution():
    target = tiangong_like()
    rows = []
    for resolution_m in (0.4, 0.8):
        condition = Condition(signal_to_noise_db=20, resolution_m=resolution_m, frames=2)
        seen = list(sights(target, condition, [20.0], scatterers=2_000, seed=5))
        rows.append([each.views[20.0].projection.matrix[0, :3] for each in seen])
        assert [len(each.shown) for each in seen] == [1, 0]
    fine, coarse = (np.array(each) for each in rows)
    # But for half a pulse of a turn of 2.6°: the middle of an even number of pulses.
    assert fine / np.linalg.norm(fine, axis=1)[:, None] == pytest.approx(
        coarse / np.linalg.norm(coarse, axis=1)[:, None], abs=2e-3
    )
    assert np.linalg.norm(fine, axis=1) == pytest.approx(2 * np.linalg.norm(coarse, axis=1))


def test_no_views_are_worth_nothing():
    target, grid = tiangong_like(), VoxelGrid.cube(side_m=21.0, spacing_m=1.5)
    accuracy, hull = hull_accuracy([], grid, target.voxels(grid), target)
    assert (accuracy.intersection_over_union, accuracy.length_error_percent) == (0, None)
    assert hull.is_empty


def test_a_curve_tells_the_range_over_seeds_and_what_is_lost():
    def accuracy(iou, length):
        return Accuracy(
            intersection_over_union=iou,
            coverage=1.0,
            length_error_percent=length,
            attitude_error_deg=length,
        )

    found = {-5.0: [accuracy(0.1, 3.0), accuracy(0.3, None)], 5.0: [accuracy(0.8, 1.0)]}
    curve = Curve(factor="noise", unit="dB", centre=5.0, found=found)
    first, second = curve.table().rows
    assert first == ("−5 dB", "0.200 (0.100 … 0.300)", "1.000", "lost", "lost")
    assert second == ("5 dB", "0.800", "1.000", "1.00", "1.00")
    assert curve.mean(-5.0, "mean length error") is None


@pytest.mark.parametrize(("name", "count"), [("views", 1), ("seeds", 0)])
def test_too_little_is_refused(name, count):
    with pytest.raises(ValueError, match="at least 2 views and a seed"):
        run_noise(**SMALL | {name: count})
