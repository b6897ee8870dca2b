"""What the workstation hands out: the hull and the outlines, as files."""

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from app.snapshot import Snapshot
from app.source import Source
from core.formats.coco import coco_json
from core.formats.labelme import labelme_zip
from core.formats.masks import masks_zip
from core.formats.surfaces import SUFFIXES, surface_bytes

Writer = Callable[[Snapshot, Source], bytes]


@dataclass(frozen=True, slots=True, kw_only=True)
class Export:
    """A kind of file that can be had.

    Attributes:
        media_type: of the file.
        write: gives its content.
    """

    media_type: str
    write: Writer


def file_name(what: str, snapshot: Snapshot, source: Source) -> str:
    """Return what to call an export: source, hull's revision, kind; letters that any disk takes."""
    plain = re.sub(r"[^A-Za-z0-9]+", "-", re.sub(r"\.h5$", "", source.name)).strip("-").lower()
    revision = 0 if snapshot.hull is None else snapshot.hull.revision
    return f"{plain[:40].rstrip('-') or 'pass'}-rev{revision}-{what}"


def hull_as(suffix: str) -> Writer:
    """Return the writer of the hull's surface, metres in the target frame, for a file's ending."""

    def write(snapshot: Snapshot, _: Source) -> bytes:
        if snapshot.hull is None or snapshot.surface is None or snapshot.surface.is_empty:
            raise ValueError(
                "There is no hull to export yet; wait for frames that show the target."
            )
        _check_kept(snapshot)
        return surface_bytes(snapshot.surface, suffix)

    return write


def _check_kept(snapshot: Snapshot) -> None:
    if snapshot.hull is not None and snapshot.hull.is_preview:
        raise ValueError("The hull follows an outline that is not kept yet; keep or discard it.")


def _outlines_by(write: Callable[[Any], bytes]) -> Writer:
    def write_outlines(snapshot: Snapshot, _: Source) -> bytes:
        if not snapshot.records:
            raise ValueError("There is no outline to export yet; wait for the first frame.")
        return write([(record.number, record.silhouette) for record in snapshot.records])

    return write_outlines


EXPORTS = {
    **{
        f"hull{suffix}": Export(media_type=f"model/{kind}", write=hull_as(suffix))
        for suffix, kind in zip(SUFFIXES, ("gltf-binary", "ply", "stl"), strict=True)
    },
    "silhouettes-coco.json": Export(media_type="application/json", write=_outlines_by(coco_json)),
    "silhouettes-labelme.zip": Export(
        media_type="application/zip", write=_outlines_by(labelme_zip)
    ),
    "silhouettes-masks.zip": Export(media_type="application/zip", write=_outlines_by(masks_zip)),
}
"""By the name under which the interface has them; measurements are `app.measurements_api`'s."""
