import inspect
import json
from functools import partial
from typing import get_args

import pytest
import trimesh

from app.command_line import main
from app.commands import experiment
from core.experiments.limited import run_limited


@pytest.fixture
def few_frames(monkeypatch):
    run = partial(run_limited, frames=3, scatterers=2_000)
    monkeypatch.setattr(experiment, "STUDIES", {"limited": run})


def test_a_study_writes_numbers_hull_pictures_and_a_page(few_frames, capsys, tmp_path):
    out = tmp_path / "out"
    main(["experiment", "limited", "--spacing-m", "1", "--seed", "3", "--out", str(out)])
    said = capsys.readouterr().out
    results = json.loads((out / "results.json").read_text())
    assert (results["name"], results["settings"]["seed"]) == ("limited", 3)
    assert results["settings"]["spacing_m"] == 1
    assert trimesh.load(out / "hull.glb", force="mesh").volume > 100
    page = (out / "report.html").read_text()
    assert page.count("data:image/png;base64,") == len(list(out.glob("*.png"))) == 4
    (finding,) = [line for line in said.splitlines() if line.startswith("Radar alone")]
    assert f"<strong>{finding}</strong>" in page


def test_json_on_standard_output_is_nothing_else(few_frames, capsys):
    main(["experiment", "limited", "--spacing-m", "1", "--json", "-"])
    assert json.loads(capsys.readouterr().out)["name"] == "limited"


def test_a_study_refuses_what_it_has_no_use_for(capsys):
    with pytest.raises(SystemExit):
        main(["experiment", "fusion", "--views", "5", "--data", "X"])
    assert "fusion experiment has no use for --views, --data" in capsys.readouterr().err


def test_every_experiment_that_can_be_named_runs_and_reports_its_progress():
    assert get_args(experiment.Experiment) == (*experiment.STUDIES, "all")
    for run in experiment.STUDIES.values():
        assert "progress" in inspect.signature(run).parameters


def test_an_experiment_takes_the_options_that_its_signature_names():
    taken = experiment._settings("wide", experiment.STUDIES["wide"], {"--views": 5, "--data": None})
    assert taken == {"views": 5}
