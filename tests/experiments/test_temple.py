import numpy as np
import pytest

from core.experiments.pictures import write_pictures
from core.experiments.temple import TRUE_LOWER_M, TRUE_UPPER_M, run_temple, side_errors_percent


def test_the_true_box_has_no_error():
    assert side_errors_percent(np.array([TRUE_LOWER_M, TRUE_UPPER_M])) == pytest.approx([0, 0, 0])


def test_a_folder_without_the_data_says_what_was_wanted(tmp_path):
    with pytest.raises(ValueError, match="Wanted one list of cameras"):
        run_temple(tmp_path)


def test_the_hull_has_the_temples_sides(shared_data, tmp_path):
    told = []
    study = run_temple(
        shared_data("temple"), spacing_m=1e-3, progress=lambda *step: told.append(step)
    )
    results = study.results
    figures = {figure.name: figure for figure in results.figures}
    assert figures["mean error of the three sides"].met is True
    # Below the base, which no camera sees from below, the hull is too long; x and z are not.
    assert abs(figures["error of side x"].value) < 2.5
    assert abs(figures["error of side z"].value) < 2.5
    assert figures["mean error, naive's largest part"].value > 6
    assert told[15] == ("silhouettes", 16, 16)
    assert [row[0] for row in results.tables[0].rows][:2] == ["true", "ours"]
    mean = figures["mean error of the three sides"].value
    assert f"box to {mean:.1f} % on average" in results.finding
    sides_m = np.ptp(study.hull.vertices_m, axis=0)
    assert sides_m == pytest.approx(np.subtract(TRUE_UPPER_M, TRUE_LOWER_M), rel=0.06)
    names = [path.stem for path in write_pictures(study.pictures, tmp_path)]
    assert names == ["temple-photographs", "temple-hull"]
