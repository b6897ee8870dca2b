"""Silhouettes as COCO JSON: one annotation for each component in a frame.

COCO's polygons cannot say holes. An outline without holes is written as polygons, in corner
coordinates, so that sub-pixel vertices stay; one with holes as an uncompressed run-length mask,
and its rings beside that under "radarhull". Reading takes those rings only while they still give
that mask, so that a file which another program has edited is read as that program meant it.
"""

import json
from collections import defaultdict
from typing import Any

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.formats.annotation import (
    OWN_FIELD,
    Annotation,
    Outlines,
    by_frame,
    combined,
    frame_number,
    from_xy,
    image_name,
    mask_rings,
    member,
    stated_claim,
    stated_shape,
    to_xy,
    turned,
)
from core.silhouettes.silhouette import WHOLE, Silhouette, clockwise_area_px


def coco_json(outlines: Outlines) -> bytes:
    """Return silhouettes as a COCO file; `Annotation`s read from it have the same rings."""
    images = []
    annotations: list[dict[str, Any]] = []
    categories = {WHOLE: 1}
    for number, silhouettes in by_frame(outlines).items():
        images.append(_image(number, silhouettes))
        for silhouette in silhouettes:
            if not silhouette.is_empty:
                category = categories.setdefault(silhouette.component, len(categories) + 1)
                each = _annotation(number, silhouette, category)
                annotations.append({"id": len(annotations) + 1, **each})
    content = {
        "info": {"description": "Silhouettes of radarhull", "version": "1.0"},
        "licenses": [],
        "images": images,
        "annotations": annotations,
        "categories": [
            {"id": number, "name": name, "supercategory": ""} for name, number in categories.items()
        ],
    }
    return json.dumps(content, separators=(",", ":")).encode()


def read_coco(content: Any) -> tuple[Annotation, ...]:
    """Return the outlines of a parsed COCO file, in the order of its images.

    Several annotations of an image are one outline of each label, or of the target where the file
    has no category of that name. Images without any are left out, unless the file says that they
    show no target.

    Raises:
        ValueError: no COCO file, names without a frame's number, one number twice, or outlines
            that are neither polygons nor uncompressed run-length masks.
    """
    names = {
        member(each, "id", int, "A category of the COCO file"): member(each, "name", str, "It")
        for each in member(content, "categories", list, "A COCO file")
    }
    of_image = defaultdict(list)
    for each in member(content, "annotations", list, "A COCO file"):
        of_image[member(each, "image_id", int, "An annotation of the COCO file")].append(each)
    return tuple(
        annotation
        for image in member(content, "images", list, "A COCO file")
        for annotation in _read_image(
            image, of_image[member(image, "id", int, "An image of the COCO file")], names
        )
    )


_NO_TARGET = {"shows_target": False}


def _image(number: int, silhouettes: list[Silhouette]) -> dict[str, Any]:
    rows, columns = silhouettes[0].image_shape
    own = {OWN_FIELD: _NO_TARGET} if silhouettes[0].is_empty else {}
    name = image_name(number)
    return {"id": number, "file_name": name, "height": rows, "width": columns, **own}


def _annotation(number: int, silhouette: Silhouette, category: int) -> dict[str, Any]:
    corners = np.concatenate([to_xy(ring) for ring in silhouette.rings])
    low, high = corners.min(axis=0), corners.max(axis=0)
    own: dict[str, Any] = {"claim": silhouette.claim, "provenance": silhouette.provenance}
    if _has_holes(silhouette.rings):
        own["rings"] = [to_xy(ring) for ring in silhouette.rings]
        segmentation: Any = _runs(silhouette.mask())
    else:
        segmentation = [np.ravel(to_xy(ring)).tolist() for ring in silhouette.rings]
    return {
        "image_id": number,
        "category_id": category,
        "iscrowd": int(isinstance(segmentation, dict)),
        "segmentation": segmentation,
        "area": silhouette.area_px(),
        "bbox": [*low.tolist(), *(high - low).tolist()],
        OWN_FIELD: own,
    }


def _has_holes(rings: tuple[Floats, ...]) -> bool:
    return any(clockwise_area_px(ring) < 0 for ring in rings)


def _read_image(
    image: Any, annotations: list[Any], names: dict[int, str]
) -> tuple[Annotation, ...]:
    where = f'The image "{member(image, "file_name", str, "An image of the COCO file")[:80]}"'
    groups: dict[str | None, list[Any]] = defaultdict(list)
    for each in annotations:
        kind = member(each, "category_id", int, f"An annotation of {where}")
        groups[names.get(kind) if WHOLE in names.values() else None].append(each)
    # That it shows no target is said of the whole, beside whatever parts it may show.
    if image.get(OWN_FIELD) == _NO_TARGET and WHOLE not in groups and None not in groups:
        groups[WHOLE] = []
    return tuple(_read_group(image, group, label, where) for label, group in groups.items())


def _read_group(image: Any, annotations: list[Any], label: str | None, where: str) -> Annotation:
    shape = stated_shape(image, "height", "width", where)
    parts = [_rings(each, shape, where) for each in annotations]
    claims = {stated_claim(each.get(OWN_FIELD)) for each in annotations}
    return Annotation(
        number=frame_number(image["file_name"]),
        rings=combined(parts),
        image_shape=shape,
        claim=claims.pop() if len(claims) == 1 else None,
        component=label,
    )


def _rings(annotation: Any, shape: tuple[int, int], where: str) -> tuple[Floats, ...]:
    segmentation = annotation.get("segmentation")
    if isinstance(segmentation, list):
        polygons = [np.asarray(_even(each, where)).reshape(-1, 2) for each in segmentation]
        return combined(
            [(turned(from_xy(each, f"A polygon of {where}"), clockwise=True),) for each in polygons]
        )
    mask = _unpacked(segmentation, shape, where)
    own = annotation.get(OWN_FIELD)
    if isinstance(own, dict) and isinstance(own.get("rings"), list):
        rings = tuple(from_xy(ring, f"A ring of {where}") for ring in own["rings"])
        like = Silhouette(rings=rings, image_shape=shape, claim="lit side")
        if np.array_equal(like.mask(), mask):
            return rings
    return mask_rings(mask)


def _even(polygon: Any, where: str) -> list[float]:
    is_flat = isinstance(polygon, list) and all(isinstance(value, int | float) for value in polygon)
    if not is_flat or len(polygon) % 2:
        raise ValueError(f"A polygon of {where} must be a list x, y, x, y, … of numbers.")
    numbers: list[float] = polygon
    return numbers


def _runs(mask: NDArray[np.bool_]) -> dict[str, Any]:
    """Return a mask as COCO's run lengths: down the columns, background first."""
    flat = mask.ravel(order="F")
    changes = np.flatnonzero(np.diff(flat, prepend=False))
    counts = np.diff(changes, prepend=0, append=len(flat))
    return {"counts": counts.tolist(), "size": list(mask.shape)}


def _fill(counts: list[Any], size: int) -> bool:
    """Whether run lengths are whole numbers that add up to so many pixels."""
    are_lengths = all(isinstance(count, int) and 0 <= count <= size for count in counts)
    return are_lengths and sum(counts) == size


def _unpacked(runs: Any, shape: tuple[int, int], where: str) -> NDArray[np.bool_]:
    counts = runs.get("counts") if isinstance(runs, dict) else None
    if isinstance(counts, str):
        raise ValueError(
            f"The mask of {where} is compressed; write polygons or uncompressed run lengths."
        )
    size = shape[0] * shape[1]
    if not isinstance(counts, list) or runs.get("size") != list(shape) or not _fill(counts, size):
        raise ValueError(
            f"The annotation of {where} must be polygons, or run lengths that fill its "
            f"{shape[0]} × {shape[1]} pixels."
        )
    values = np.arange(len(counts)) % 2 == 1
    return np.repeat(values, counts).reshape(shape, order="F")
