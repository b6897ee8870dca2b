import re
from pathlib import Path

README = Path(__file__).parents[1] / "README.md"


EXAMPLES = re.findall(r"```python\n(.*?)```", README.read_text(encoding="utf-8"), re.DOTALL)


def test_the_python_example_runs(capsys):
    exec(EXAMPLES[0], {})
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 3
    assert lines[0].startswith("x along-track")


def test_the_example_of_measuring_reads_what_the_target_is(capsys):
    assert len(EXAMPLES) == 2
    exec(EXAMPLES[1], {})
    lines = capsys.readouterr().out.splitlines()
    assert lines[:2] == ["span 17.0 m", "extents 17.0 m"]
    assert lines[-2] == "volume 75.64 m³"


def test_every_picture_is_there():
    for name in re.findall(r"!\[[^\]]*\]\(([^)]+)\)", README.read_text(encoding="utf-8")):
        assert (README.parent / name).is_file()
