"""Files of two-line element sets."""

from pathlib import Path

from core.formats.files import reason


def read_element_sets(path: Path) -> tuple[tuple[str, str, str], ...]:
    """Return the (line 1, line 2, name) triples of a file, the name line being optional.

    The lines themselves are checked where a satellite is made of them.

    Raises:
        ValueError: no such text file, or no element set in it.
    """
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise ValueError(f"{path} could not be read: {reason(error)}.") from error
    except UnicodeDecodeError as error:
        raise ValueError(f"{path} is no text file of element sets.") from error
    lines = [line.rstrip() for line in text.splitlines() if line.strip()]
    found = []
    for number, line in enumerate(lines[:-1]):
        if line.startswith("1 ") and lines[number + 1].startswith("2 "):
            before = lines[number - 1] if number else ""
            found.append((line, lines[number + 1], "" if before.startswith("2 ") else before))
    if not found:
        raise ValueError(
            f'{path} holds no two-line element set: a line that begins with "1 " and after it one '
            'that begins with "2 ".'
        )
    return tuple(found)
