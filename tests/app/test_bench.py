import json

import pytest

from app.command_line import main


def test_bench_writes_the_common_form(capsys: pytest.CaptureFixture[str]) -> None:
    main(["bench", "carve", "--sizes", "16x4", "--repeats", "1", "--json", "-"])
    found = json.loads(capsys.readouterr().out)
    assert set(found) == {"name", "settings", "figures"}
    assert found["name"] == "carve"
    assert {"name", "value", "unit", "wanted", "met"} == set(found["figures"][0])


def test_growth_draws_its_curves(tmp_path) -> None:
    main(["bench", "growth", "--sizes", "16x4", "24x4", "--repeats", "1", "--out", str(tmp_path)])
    assert (tmp_path / "growth.png").stat().st_size > 10_000


@pytest.mark.parametrize(
    "words",
    [
        ["carve", "--sizes", "256"],
        ["carve", "--sizes", "2x1"],
        ["edit", "--repeats", "0"],
        ["edit", "--out", "plots"],
        ["image", "--sizes", "64x4"],
    ],
)
def test_bad_input_is_one_line_and_exit_code_2(
    words: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["bench", *words])
    assert ended.value.code == 2
    assert capsys.readouterr().err.strip().count("\n") == 0
