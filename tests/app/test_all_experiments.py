import json
from functools import partial

import pytest
import trimesh

from app.command_line import main
from app.commands import experiment
from core.experiments.pictures import Picture
from core.experiments.results import Figure, Results
from core.experiments.study import Study
from core.experiments.wide import run_wide
from core.hull.surface import EMPTY_SURFACE


def tiny(name, told, *, progress):
    progress("work", 1, 1)
    told.append(name)
    picture = Picture(name=f"{name}-hull", caption="", draw=lambda canvas: None, size_in=(2.0, 1.0))
    results = Results(
        name=name,
        settings={},
        figures=(Figure(name="a", value=1, wanted="<= 2"),),
        finding=f"The {name} was found.",
    )
    return Study(results=results, pictures=(picture,), hull=EMPTY_SURFACE)


def refusing(*, progress):
    raise ValueError("Wanted two views, got one.")


def faulty(*, progress):
    raise KeyError("lost")


def needing(data, *, progress):
    return tiny("temple", [str(data)], progress=progress)


@pytest.fixture
def told(monkeypatch):
    told = []
    studies = {
        "first": partial(tiny, "first", told),
        "refusing": refusing,
        "faulty": faulty,
        "temple": needing,
        "last": partial(tiny, "last", told),
    }
    monkeypatch.setattr(experiment, "STUDIES", studies)
    return told


def run(*words):
    main(["experiment", "all", *map(str, words)])


def test_an_experiment_that_fails_is_told_and_does_not_stop_the_rest(told, capsys, tmp_path):
    with pytest.raises(SystemExit) as ended:
        run("--out", tmp_path)
    assert ended.value.code == 1
    assert told == ["first", "last"]
    said = capsys.readouterr()
    assert "refusing failed: Wanted two views, got one." in said.out
    assert "faulty failed: KeyError: 'lost'" in said.out
    assert "temple skipped: Needs its data: --data FOLDER with templeSR_par.txt" in said.out
    assert "last (5 of 5)" in said.err
    assert "Traceback" in said.err
    page = (tmp_path / "index.html").read_text(encoding="utf-8")
    assert page.count("<section") == 5
    assert "The last was found." in page
    assert (tmp_path / "last" / "report.html").exists()


def test_all_numbers_are_in_one_file_and_on_standard_output(told, capsys, tmp_path):
    with pytest.raises(SystemExit):
        run("--out", tmp_path, "--json", "-")
    facts = json.loads(capsys.readouterr().out)
    assert facts == json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))
    assert facts["name"] == "all"
    failures = next(each for each in facts["figures"] if each["name"] == "experiments failed")
    assert (failures["value"], failures["met"]) == (2, False)
    outcomes = {each["name"]: each["outcome"] for each in facts["experiments"]}
    assert outcomes == {
        "first": "done",
        "refusing": "failed",
        "faulty": "failed",
        "temple": "skipped",
        "last": "done",
    }
    assert facts["experiments"][0]["figures"][0]["met"] is True


def test_data_goes_to_those_that_need_it(told, tmp_path):
    with pytest.raises(SystemExit):
        run("--out", tmp_path, "--data", tmp_path)
    assert (tmp_path / "temple" / "report.html").exists()


def test_a_real_one_lands_beside_the_page_and_ends_well(monkeypatch, tmp_path):
    small = partial(run_wide, views=3, spacing_m=1.0, scatterers=1_000)
    monkeypatch.setattr(experiment, "STUDIES", {"wide": small})
    run("--out", tmp_path)
    page = (tmp_path / "index.html").read_text(encoding="utf-8")
    assert 'alt="wide-hull" src="data:image/png;base64,' in page
    assert trimesh.load(tmp_path / "wide" / "hull.glb", force="mesh").volume > 100


@pytest.mark.parametrize(
    ("words", "wanted"),
    [
        ((), "--out FOLDER"),
        (("--out", "x", "--views", "3", "--seed", "2"), "no use for --views, --seed"),
    ],
)
def test_what_all_cannot_use_or_lacks_is_told(told, capsys, monkeypatch, tmp_path, words, wanted):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit) as ended:
        run(*words)
    assert ended.value.code == 2
    assert wanted in capsys.readouterr().err
    assert told == []
    assert list(tmp_path.iterdir()) == []
