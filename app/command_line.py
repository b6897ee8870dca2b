"""The command `radarhull`."""

import sys
from collections.abc import Callable

import tyro

from app.commands.bench import bench
from app.commands.experiment import experiment
from app.commands.image import image
from app.commands.import_ import import_
from app.commands.reconstruct import reconstruct
from app.commands.serve import serve
from app.commands.simulate import simulate

EXIT_BAD_INPUT = 2

_COMMANDS: dict[str, Callable[..., None]] = {
    "serve": serve,
    "simulate": simulate,
    "import": import_,
    "image": image,
    "reconstruct": reconstruct,
    "experiment": experiment,
    "bench": bench,
}

_DESCRIPTION = """Visual hulls, lengths and attitude of satellites from multi-view radar images.

Without a command, radarhull serves the workstation on a built-in demo: three simulated passes
of a space laboratory. Every command has --help."""


def main(arguments: list[str] | None = None) -> None:
    """Run the command line; bad input ends with one line on standard error and exit code 2."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    # Bare "radarhull" and "radarhull --open" serve the demo.
    if not words or (words[0].startswith("-") and words[0] not in ("-h", "--help")):
        words = ["serve", *words]
    try:
        tyro.extras.subcommand_cli_from_dict(
            _COMMANDS, prog="radarhull", description=_DESCRIPTION, args=words
        )
    except ValueError as error:
        print(f"radarhull: {error}", file=sys.stderr)
        raise SystemExit(EXIT_BAD_INPUT) from None
    except KeyboardInterrupt:
        print("radarhull: stopped.", file=sys.stderr)
        raise SystemExit(130) from None


if __name__ == "__main__":
    main()
