"""Reading outlines from whatever annotation file somebody gives: the file says what it is."""

import json
from itertools import pairwise
from typing import Any

from core.formats.annotation import Annotation
from core.formats.archive import unpacked
from core.formats.coco import read_coco
from core.formats.labelme import read_labelme
from core.formats.masks import read_mask
from core.silhouettes.silhouette import WHOLE

KINDS = "COCO JSON, labelme JSON, a PNG mask, or a ZIP archive of them"


def read_annotations(content: bytes, name: str) -> tuple[Annotation, ...]:
    """Return the outlines in a file, of each component in a frame one, in the order of the frames.

    An archive's JSON files are read if it has any, else its PNG files, for images lie beside
    labelme's files.

    Args:
        content: of a COCO file, a labelme file, a PNG mask, or a ZIP archive of them.
        name: of the file, which carries the frame's number where it is of one frame.

    Raises:
        ValueError: none of these, one that is damaged or too large, no outline in it, or two of
            the same component in a frame.
    """
    if content.startswith(b"PK"):
        members = list(unpacked(content))
        of_json = [each for each in members if each[0].lower().endswith(".json")]
        of_png = [each for each in members if each[0].lower().endswith(".png")]
        found = [each for inner, data in of_json or of_png for each in _read_one(data, inner)]
    else:
        found = list(_read_one(content, name))
    if not found:
        raise ValueError(f'"{name[:80]}" holds no outline; wanted {KINDS}.')
    found.sort(key=_key)
    for one, next_one in pairwise(found):
        if _key(one) == _key(next_one):
            raise ValueError(
                f'"{name[:80]}" holds two outlines of frame {one.number}; one is needed.'
            )
    return tuple(found)


def _read_one(content: bytes, name: str) -> tuple[Annotation, ...]:
    if content.startswith(b"\x89PNG"):
        return (read_mask(content, name),)
    parsed = _parsed(content, name)
    if isinstance(parsed, dict) and "annotations" in parsed:
        return read_coco(parsed)
    if isinstance(parsed, dict) and "shapes" in parsed:
        return read_labelme(parsed, name)
    raise ValueError(f'"{name[:80]}" is JSON, but neither COCO nor labelme; wanted {KINDS}.')


def _key(annotation: Annotation) -> tuple[int, str]:
    return annotation.number, annotation.component or WHOLE


def _parsed(content: bytes, name: str) -> Any:
    try:
        return json.loads(content)
    except (ValueError, RecursionError) as error:
        raise ValueError(f'"{name[:80]}" is not understood; wanted {KINDS}.') from error
