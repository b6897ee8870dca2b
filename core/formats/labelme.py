"""Silhouettes as labelme writes them: a JSON file per frame, each ring a polygon.

labelme has no word for holes either. The rings of an outline share a group, and those of holes
carry the flag "hole", which labelme shows and keeps. The label is the component.
"""

import json
from collections import defaultdict
from typing import Any

from core.formats.annotation import (
    OWN_FIELD,
    Annotation,
    Outlines,
    by_frame,
    combined,
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
from core.silhouettes.silhouette import WHOLE, Silhouette, clockwise_area_px

HOLE = "hole"
NO_TARGET = "no target"


def labelme_zip(outlines: Outlines) -> bytes:
    """Return silhouettes as a ZIP archive of labelme files, for images beside them."""
    return packed(
        (image_name(number, ".json"), json.dumps(_content(number, each), indent=1).encode())
        for number, each in by_frame(outlines).items()
    )


def read_labelme(content: Any, name: str) -> tuple[Annotation, ...]:
    """Return the outlines of a parsed labelme file, of each label one; none where it has no shapes.

    Args:
        content: of the file.
        name: of the file; it carries the frame's number.

    Raises:
        ValueError: no labelme file, no number in its name, or shapes that are no polygons.
    """
    where = f'The file "{name[:80]}"'
    groups: dict[str | None, list[Any]] = defaultdict(list)
    shapes = member(content, "shapes", list, where)
    tells_parts = OWN_FIELD in content or any(_label(each, where) == WHOLE for each in shapes)
    for each in shapes:
        groups[_label(each, where) if tells_parts else None].append(each)
    flags = content.get("flags")
    is_empty = isinstance(flags, dict) and flags.get(NO_TARGET) is True
    if is_empty and WHOLE not in groups and None not in groups:
        groups[WHOLE] = []
    return tuple(_read_group(content, group, label, name) for label, group in groups.items())


def _read_group(content: Any, shapes: list[Any], label: str | None, name: str) -> Annotation:
    where = f'The file "{name[:80]}"'
    own = content.get(OWN_FIELD)
    claims = own.get("claims") if isinstance(own, dict) else None
    claim = claims.get(label or WHOLE) if isinstance(claims, dict) else None
    rings = tuple(turned(_ring(each, where), clockwise=not _is_hole(each)) for each in shapes)
    return Annotation(
        number=frame_number(name),
        rings=combined([rings]),
        image_shape=stated_shape(content, "imageHeight", "imageWidth", where),
        claim=stated_claim({"claim": claim}),
        component=label,
    )


def _label(shape: Any, where: str) -> str:
    label: str = member(shape, "label", str, f"A shape of {where}")
    return label


def _content(number: int, silhouettes: list[Silhouette]) -> dict[str, Any]:
    rows, columns = silhouettes[0].image_shape
    return {
        "version": "5.5.0",
        "flags": {NO_TARGET: silhouettes[0].is_empty},
        "shapes": [
            {
                "label": silhouette.component,
                "points": to_xy(ring),
                "group_id": group,
                "description": "",
                "shape_type": "polygon",
                "flags": {HOLE: clockwise_area_px(ring) < 0},
            }
            for group, silhouette in enumerate(silhouettes, start=1)
            for ring in silhouette.rings
        ],
        "imagePath": image_name(number),
        "imageData": None,
        "imageHeight": rows,
        "imageWidth": columns,
        OWN_FIELD: {
            "claims": {each.component: each.claim for each in silhouettes},
            "provenance": {each.component: each.provenance for each in silhouettes},
        },
    }


def _is_hole(shape: Any) -> bool:
    flags = shape.get("flags") if isinstance(shape, dict) else None
    return isinstance(flags, dict) and flags.get(HOLE) is True


def _ring(shape: Any, where: str) -> Any:
    kind = shape.get("shape_type") if isinstance(shape, dict) else None
    if kind != "polygon":
        raise ValueError(f'{where} has a shape "{str(kind)[:40]}"; draw polygons only.')
    return from_xy(shape.get("points"), f"A polygon of {where}")
