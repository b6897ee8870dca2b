import numpy as np
import pytest

from core.experiments.beijing_pass import beijing_pass
from core.experiments.factored_lines import (
    NOISY,
    PERFECT,
    Tracked,
    factored,
    missing_cases,
    with_known_length,
)
from core.experiments.factorization import run_factorization
from core.experiments.lines_found import LinesFound, line_found, lines_table
from core.experiments.mro_scene import (
    Motion,
    line_ends_m,
    lit_sides,
    pass_motion,
    scatterers_with_ends,
)
from core.measurement.observability import observability
from core.targets import mro_like
from tests.factorization.paths import generic_path

FEATURES = mro_like().features


def tracked(motion, *, scaled=False):
    points_m = scatterers_with_ends(120, np.random.default_rng(1))
    return Tracked(points_m=points_m, motion=motion, scaled=scaled, seed=2)


@pytest.fixture(scope="module")
def wide():
    k, rate = generic_path(30, np.random.default_rng(11))
    return tracked(Motion(line_of_sight=k, rate_per_s=rate))


@pytest.fixture(scope="module")
def seen():
    return beijing_pass()


def test_the_ends_are_those_of_the_lines():
    lines = np.diff(line_ends_m(), axis=1)[:, 0]
    lengths_m = [feature.length_m for feature in FEATURES]
    assert np.linalg.norm(lines, axis=1) == pytest.approx(lengths_m)
    directions = np.array([feature.direction for feature in FEATURES])
    assert np.abs(np.sum(lines * directions, axis=1)) == pytest.approx(lengths_m)


def test_perfect_tracks_give_the_lines_and_noise_a_little_less(wide):
    perfect = factored(wide, FEATURES, name="perfect", glint=PERFECT)
    noisy = factored(wide, FEATURES, name="noisy", glint=NOISY)
    assert perfect.mean_error_percent() < 1e-6
    assert perfect.worst_attitude_deg() < 1e-4
    assert 0 < noisy.mean_error_percent() < 2


def test_a_pass_is_unobservable_unless_cross_range_comes_in_metres(seen):
    motion = pass_motion(seen)
    unscaled = factored(tracked(motion), FEATURES, name="unscaled", glint=NOISY)
    assert (unscaled.note, unscaled.mean_error_percent()) == ("unobservable", None)
    scaled = factored(tracked(motion, scaled=True), FEATURES, name="scaled", glint=NOISY)
    assert scaled.mean_error_percent() < 5


def test_a_hull_of_that_pass_alone_bounds_one_line_only(seen):
    constrained = observability(lit_sides(seen))
    grades = [constrained.grade(feature.direction) for feature in FEATURES]
    assert grades == ["weak", "good", "unobserved"]


def test_missing_points_cost_accuracy_or_the_line(wide):
    found = missing_cases(wide, FEATURES, (0.3, 0.97))
    assert found[0.3].mean_error_percent() < 2
    assert found[0.97].mean_error_percent() is None


def test_one_known_length_scales_the_others(wide):
    perfect = factored(wide, FEATURES, name="perfect")
    known = with_known_length(perfect, 1, suffix="; l2 known")
    assert known.method == "perfect; l2 known"
    assert known.mean_error_percent() < 1e-6
    lost = LinesFound(method="nothing", lines=(None,) * 3, note="lost")
    assert with_known_length(lost, 1, suffix="").note == "lost"


def test_a_table_says_lengths_errors_attitudes_and_factors():
    half = [
        line_found(each, np.outer([0, 0.5], each.length_m * each.direction)) for each in FEATURES
    ]
    table = lines_table("T", [LinesFound(method="half", lines=tuple(half))], FEATURES)
    assert table.columns[1:4] == ("l1, 27.69 m", "l2, 58.12 m", "l3, 15.88 m")
    row = table.rows[1]
    assert row[2] == "29.060, -50.000 %, 0.000°"
    assert row[4:6] == ("50.000 %", "2.0000, 2.0000, 2.0000")
    assert row[6:] == table.rows[0][6:] == ("0.4764", "1.7437", "3.6599")


@pytest.fixture(scope="module")
def study():
    return run_factorization(
        views=16,
        spacing_m=0.6,
        scatterers=15_000,
        resolution_m=0.45,
        points=40,
        pass_frames=10,
        missing=(0.2,),
        missing_from_echoes=(),
    )


def test_the_whole_experiment_measures_from_echoes(study):
    table, on_pass, _, missing = study.results.tables
    assert [row[0] for row in table.rows[-2:]] == [
        "energy accumulation (ISEA)",
        "ours, from echoes",
    ]
    length = float(table.rows[-1][2].split(",")[0])
    assert length == pytest.approx(58.12, rel=0.02)
    assert "unobservable" in on_pass.rows[3]
    assert [row[0] for row in missing.rows] == ["0 %", "20 %"]
    assert study.hull.volume_m3() > 100
    assert len(study.pictures) == 4
