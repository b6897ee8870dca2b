import io
import re
import sys
from pathlib import Path

import pytest

from app.arguments import parsed_call


def count(path: Path, /, *, times: int = 1, share: float = 0.5, verbose: bool = False) -> None:
    """Count what is in a file.

    Args:
        path: file to read.
        times: how often.
        share: of the file.
        verbose: say more.
    """
    print(path, times, share, verbose)


def test_the_call_waits_until_it_is_made(capsys):
    call = parsed_call(count, ["a.txt", "--times", "3"], program="radarhull count")
    assert capsys.readouterr().out == ""
    call()
    assert capsys.readouterr().out == "a.txt 3 0.5 False\n"


@pytest.mark.parametrize("encoding", ["utf-8", "ascii"])
@pytest.mark.parametrize(
    ("words", "wanted"),
    [
        ("--times 2", r"missing: .*file to read"),
        ("a --times 1e3", '--times wants a whole number, got "1e3"'),
        ("a --share much", '--share wants a number, got "much"'),
        ("a --" + 120 * "x", "unknown: --" + 120 * "x"),
        ("a --times", "Missing value for argument '--times'.*"),
    ],
)
def test_a_mistake_is_one_line(monkeypatch, words, wanted, encoding):
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(io.BytesIO(), encoding=encoding))
    monkeypatch.setenv("COLUMNS", "40")
    with pytest.raises(ValueError, match="see radarhull count --help") as raised:
        parsed_call(count, words.split(), program="radarhull count")
    assert re.fullmatch(wanted + "; see radarhull count --help", str(raised.value))


def test_help_keeps_to_the_terminal_and_ends_well(capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "60")
    with pytest.raises(SystemExit) as ended:
        parsed_call(count, ["--help"], program="radarhull count")
    assert not ended.value.code
    out = capsys.readouterr().out
    assert "how often." in out
    assert len(out.splitlines()[-2]) <= 60
