"""Files that are written whole or not at all."""

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path


def checked_output(path: Path, suffixes: Sequence[str] = ()) -> Path:
    """Return `path` if a file can be written there, before any work is done for it.

    Args:
        path: of the file to write.
        suffixes: endings that name its format, in small letters; none for any ending.

    Raises:
        ValueError: another ending, no such folder, a folder that cannot be written, or a path
            that is itself a folder.
    """
    if suffixes and path.suffix.lower() not in suffixes:
        raise ValueError(f'{path} must end in {", ".join(suffixes)}; got "{path.suffix}".')
    if path.is_dir():
        raise ValueError(f"{path} is a folder; name a file to write.")
    if not path.parent.is_dir():
        raise ValueError(f"{path} could not be written: there is no folder {path.parent}.")
    if not os.access(path.parent, os.W_OK | os.X_OK):
        raise ValueError(f"{path} could not be written: the folder {path.parent} is read-only.")
    return path


@contextmanager
def written_aside(path: Path) -> Iterator[Path]:
    """Give a path beside `path` to write to; it takes `path`'s place if all went well.

    Raises:
        ValueError: the folder is missing or cannot be written.
    """
    aside = path.with_name(f".{path.stem}.{os.getpid()}{path.suffix}")
    try:
        yield aside
        aside.replace(path)
    except OSError as error:
        raise ValueError(f"{path} could not be written: {reason(error)}.") from error
    finally:
        aside.unlink(missing_ok=True)


def reason(error: OSError) -> str:
    """Return in a few words why the system refused; libraries put their own text around it."""
    return os.strerror(error.errno) if error.errno else str(error)
