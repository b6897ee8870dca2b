"""Words of a command line into a call, and what is wrong with them in one line."""

import functools
import io
import os
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stderr
from itertools import dropwhile, takewhile
from operator import itemgetter

import tyro

_ANSI = re.compile(r"\x1b\[[0-9;]*m")
_RULE = re.compile(r"\s*[╰─-]{3,}╯?\s*")
_BOX = re.compile(r"^[│|]\s?|\s*[│|]$")
_PLAIN = (
    (re.compile(r"invalid literal for int\(\) with base 10: '(.*)'"), r'a whole number, got "\1"'),
    (re.compile(r"could not convert string to float: '(.*)'"), r'a number, got "\1"'),
)


def parsed_call(
    command: Callable[..., None], words: list[str], *, program: str
) -> Callable[[], None]:
    """Return the call of `command` that `words` ask for; --help prints and ends the process.

    Raises:
        ValueError: the words are not understood; says in one line why, and where to read more.
    """

    @functools.wraps(command)
    def deferred(*values: object, **named: object) -> Callable[[], None]:
        return functools.partial(command, *values, **named)

    printed = io.StringIO()
    try:
        with redirect_stderr(printed), _wide_terminal(unless={"-h", "--help"} & {*words}):
            call: Callable[[], None] = tyro.cli(deferred, prog=program, args=words)
    except SystemExit as ended:
        if not ended.code:
            raise
        raise ValueError(f"{_first_sentence(printed.getvalue())}; see {program} --help") from None
    return call


def _first_sentence(box: str) -> str:
    """Return what tyro's box says between its title and its first rule, on one line.

    tyro has no other public way to hand out its complaint.
    """
    lines = [_BOX.sub("", line) for line in _ANSI.sub("", box).splitlines()[1:]]
    rules = [bool(_RULE.fullmatch(line)) for line in lines]
    # Where the terminal knows ASCII only, there is also a rule below the title.
    content = dropwhile(itemgetter(0), zip(rules, lines, strict=True))
    said = [line for _, line in takewhile(lambda pair: not pair[0], content)]
    return _in_plain_words(" ".join(" ".join(said).split()))


def _in_plain_words(text: str) -> str:
    for pattern, plain in _PLAIN:
        text = pattern.sub(plain, text)
    text = re.sub(r"^Error parsing (\S+): (an? )", r"\1 wants \2", text)
    text = re.sub(r"^Missing from [^:]*: ", "missing: ", text)
    return text.replace(" (required)", "").rstrip(".").replace("Unrecognized options", "unknown")


@contextmanager
def _wide_terminal(*, unless: object) -> Iterator[None]:
    """Keep tyro from breaking its complaint at the terminal's width."""
    before = os.environ.get("COLUMNS")
    if not unless:
        os.environ["COLUMNS"] = "100000"
    try:
        yield
    finally:
        os.environ.pop("COLUMNS", None)
        if before is not None:
            os.environ["COLUMNS"] = before
