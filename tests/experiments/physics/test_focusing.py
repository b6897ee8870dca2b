import numpy as np
import pytest

from core.experiments.physics import focusing
from core.experiments.physics.focusing import focusing_part, translation_m
from core.experiments.physics.part import Part
from core.experiments.pictures import write_pictures


@pytest.fixture
def small(monkeypatch):
    monkeypatch.setattr(focusing, "VIEWS", 1)
    monkeypatch.setattr(focusing, "SCATTERERS", 3000)


def test_the_way_is_smooth_and_scattered_as_stated():
    way_m = translation_m(256, 0.15, np.random.default_rng(0))
    cubic_m = np.polyval(np.polyfit(np.arange(256), way_m, 3), np.arange(256))
    assert np.ptp(cubic_m) == pytest.approx(3.0, rel=0.1)
    assert np.abs(way_m - cubic_m).max() < 0.12


def test_focus_comes_back_and_without_a_folder_nothing_is_said_of_gotcha(small, tmp_path):
    told = []
    part = focusing_part(lambda *step: told.append(step))
    assert [figure.met for figure in part.figures] == [None, True, True]
    assert part.figures[0].value > 20
    assert told == [("simulated translation", 1, 1)]
    assert [picture.name for picture in part.pictures] == ["focus-simulated"]
    (path,) = write_pictures(part.pictures, tmp_path)
    assert path.stat().st_size > 10_000


def test_a_folder_without_the_files_is_refused(small, tmp_path):
    with pytest.raises(ValueError, match="Gotcha file"):
        focusing_part(lambda *_: None, tmp_path)


def test_measured_focus_is_as_good_as_with_the_files_own_phases(monkeypatch, shared_data, tmp_path):
    monkeypatch.setattr(focusing, "_simulated", lambda _: Part(figures=()))
    monkeypatch.setattr(focusing, "GOTCHA_PIXELS", 160)
    (path,) = shared_data("gotcha").glob("*az002*.mat")
    (tmp_path / path.name).symlink_to(path)
    part = focusing_part(lambda *_: None, tmp_path)
    figures = {figure.name: figure for figure in part.figures}
    wanted = [figure for figure in part.figures if figure.wanted]
    assert len(wanted) == 4
    assert all(figure.met for figure in wanted)
    lost = figures["Gotcha: entropy above that with its own phases, error put in"]
    assert lost.value > 5
    assert [picture.name for picture in part.pictures] == ["focus-measured"]
