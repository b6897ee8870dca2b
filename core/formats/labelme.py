"""Silhouettes as labelme writes them: a JSON file per frame, each ring a polygon.

labelme has no word for holes either. The rings of an outline share a group, and those of holes
carry the flag "hole", which labelme shows and keeps.
"""

import json
from typing import Any

from core.formats.annotation import (
    OWN_FIELD,
    Annotation,
    Outlines,
    combined,
    common,
    frame_number,
    from_xy,
    image_name,
    member,
    stated_claim,
    stated_shape,
    to_xy,
    turned,
)
from core.formats.archive import packed
from core.silhouettes.silhouette import Silhouette, clockwise_area_px

HOLE = "hole"
NO_TARGET = "no target"


def labelme_zip(outlines: Outlines) -> bytes:
    """Return silhouettes as a ZIP archive of labelme files, for images beside them."""
    return packed(
        (image_name(number, ".json"), json.dumps(_content(number, silhouette), indent=1).encode())
        for number, silhouette in outlines
    )


def read_labelme(content: Any, name: str) -> Annotation | None:
    """Return the outline of a parsed labelme file, None where it has no shapes.

    Args:
        content: of the file.
        name: of the file; it carries the frame's number.

    Raises:
        ValueError: no labelme file, no number in its name, or shapes that are no polygons.
    """
    where = f'The file "{name[:80]}"'
    shapes = member(content, "shapes", list, where)
    flags = content.get("flags")
    if not shapes and not (isinstance(flags, dict) and flags.get(NO_TARGET) is True):
        return None
    rings = tuple(turned(_ring(each, where), clockwise=not _is_hole(each)) for each in shapes)
    return Annotation(
        number=frame_number(name),
        rings=combined([rings]),
        image_shape=stated_shape(content, "imageHeight", "imageWidth", where),
        claim=stated_claim(content.get(OWN_FIELD)),
        component=common(member(shape, "label", str, where) for shape in shapes),
    )


def _content(number: int, silhouette: Silhouette) -> dict[str, Any]:
    rows, columns = silhouette.image_shape
    return {
        "version": "5.5.0",
        "flags": {NO_TARGET: silhouette.is_empty},
        "shapes": [
            {
                "label": silhouette.component,
                "points": to_xy(ring),
                "group_id": 1,
                "description": "",
                "shape_type": "polygon",
                "flags": {HOLE: clockwise_area_px(ring) < 0},
            }
            for ring in silhouette.rings
        ],
        "imagePath": image_name(number),
        "imageData": None,
        "imageHeight": rows,
        "imageWidth": columns,
        OWN_FIELD: {"claim": silhouette.claim, "provenance": silhouette.provenance},
    }


def _is_hole(shape: Any) -> bool:
    flags = shape.get("flags") if isinstance(shape, dict) else None
    return isinstance(flags, dict) and flags.get(HOLE) is True


def _ring(shape: Any, where: str) -> Any:
    kind = shape.get("shape_type") if isinstance(shape, dict) else None
    if kind != "polygon":
        raise ValueError(f'{where} has a shape "{str(kind)[:40]}"; draw polygons only.')
    return from_xy(shape.get("points"), f"A polygon of {where}")
