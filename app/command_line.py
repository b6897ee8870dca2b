"""The command `radarhull`."""

import importlib.metadata
import inspect
import sys
from collections.abc import Callable

from app.arguments import parsed_call
from app.commands.bench import bench
from app.commands.console import sentence_of
from app.commands.experiment import experiment
from app.commands.image import image
from app.commands.import_ import import_
from app.commands.measure import measure
from app.commands.reconstruct import reconstruct
from app.commands.serve import serve
from app.commands.simulate import simulate

PROGRAM = "radarhull"
EXIT_BAD_INPUT = 2
EXIT_STOPPED = 130

_COMMANDS: dict[str, Callable[..., None]] = {
    "serve": serve,
    "simulate": simulate,
    "import": import_,
    "image": image,
    "reconstruct": reconstruct,
    "measure": measure,
    "experiment": experiment,
    "bench": bench,
}

_HELP = """usage: radarhull [COMMAND] [--help] [--version]

Visual hulls, lengths and attitude of satellites from multi-view radar images.

Without a command, radarhull serves the workstation on a built-in demo: three simulated passes
of a space laboratory. "radarhull --open" also opens it in the browser.

commands, each with --help:
"""


def main(arguments: list[str] | None = None) -> None:
    """Run the command line; bad input ends with one line on standard error and exit code 2."""
    try:
        _run(list(sys.argv[1:] if arguments is None else arguments))
    except (ValueError, MemoryError, OSError) as error:
        _end(sentence_of(error), EXIT_BAD_INPUT)
    except KeyboardInterrupt:
        _end("stopped.", EXIT_STOPPED)


def _run(words: list[str]) -> None:
    if words[:1] in (["-h"], ["--help"]):
        print(_help())
        return
    if words[:1] == ["--version"]:
        print(f"{PROGRAM} {_version()}")
        return
    # Bare "radarhull" and "radarhull --open" serve the demo.
    if not words or words[0].startswith("-"):
        words = ["serve", *words]
    name, *rest = words
    if name not in _COMMANDS:
        raise ValueError(
            f'there is no command "{name}", only {", ".join(_COMMANDS)}; see {PROGRAM} --help'
        )
    parsed_call(_COMMANDS[name], rest, program=f"{PROGRAM} {name}")()


def _version() -> str:
    try:
        return importlib.metadata.version(PROGRAM)
    except importlib.metadata.PackageNotFoundError:
        return "(run from its sources, not installed)"


def _help() -> str:
    lines = [
        f"  {name:12} {(inspect.getdoc(command) or '').splitlines()[0]}"
        for name, command in _COMMANDS.items()
    ]
    return _HELP + "\n".join(lines)


def _end(sentence: str, code: int) -> None:
    print(f"{PROGRAM}: {sentence}", file=sys.stderr)
    raise SystemExit(code) from None


if __name__ == "__main__":
    main()
