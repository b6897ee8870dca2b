"""Outlines of all frames taken from their images anew, by other settings."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.analysis.frames import AnalysedFrame
from core.silhouettes.extraction import ExtractionSettings, extract_silhouette
from core.silhouettes.silhouette import Silhouette


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Extracted:
    """What extracting again makes of frames.

    Attributes:
        outlines: of the frames that change, by number.
        kept: numbers of the frames that keep the outline that the analyst gave them.
    """

    outlines: dict[int, Silhouette]
    kept: tuple[int, ...]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Extraction:
    """One that was done, to be taken back.

    Attributes:
        before: the settings until then.
        revisions: of the outlines that it gave, by the frames' numbers.
    """

    before: ExtractionSettings
    revisions: dict[int, int]


def extracted_again(
    frames: Sequence[AnalysedFrame],
    extraction: ExtractionSettings,
    *,
    overwrites_edited: bool = False,
) -> Extracted:
    """Return the outlines that other settings find, where they differ from the present ones.

    Only the whole target's are. Edited outlines are kept unless `overwrites_edited`.

    Raises:
        ValueError: a frame without contrast.
    """
    kept = [f.number for f in frames if f.history.is_edited and not overwrites_edited]
    due = [f for f in frames if f.number not in kept]
    found = {f.number: extract_silhouette(f.received, extraction) for f in due}
    return Extracted(
        outlines={
            f.number: found[f.number]
            for f in due
            if f.history.is_edited or not _is_same(found[f.number], f.silhouette)
        },
        kept=tuple(kept),
    )


def _is_same(one: Silhouette, other: Silhouette) -> bool:
    rings = len(one.rings) == len(other.rings) and all(
        np.array_equal(first, second) for first, second in zip(one.rings, other.rings, strict=True)
    )
    return rings and one.claim == other.claim
