"""The outline of the target in one frame."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from skimage.draw import polygon

from core.arrays import Floats, frozen

Claim = Literal["lit side", "complete"]

WHOLE = "target"
"""The component that is all of the target."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Silhouette:
    """Rings of sub-pixel vertices around what was seen of the target.

    Attributes:
        rings: each (vertices, 2) as (row, column), not repeated at the end. Outer rings run
            clockwise as seen on the image (rows down, columns right), holes counter-clockwise.
        image_shape: (rows, columns) of the frame it was drawn in.
        claim: "lit side" when the outline shows only what the sensor lit (radar), so that what
            lies behind along range is unknown; "complete" when it is the whole outline.
        component: label of the part of the target that it outlines.
        provenance: how it came to be, for people to read.
    """

    rings: tuple[Floats, ...]
    image_shape: tuple[int, int]
    claim: Claim
    component: str = WHOLE
    provenance: str = ""

    def __post_init__(self) -> None:
        rings = tuple(
            frozen(ring, np.float64, (None, 2), f"Ring {number} of the silhouette")
            for number, ring in enumerate(self.rings)
        )
        for number, ring in enumerate(rings):
            if len(ring) < 3:
                raise ValueError(
                    f"Ring {number} of the silhouette has {len(ring)} vertices; at least 3 needed."
                )
        if self.claim not in ("lit side", "complete"):
            raise ValueError(f'A silhouette claims "lit side" or "complete", not "{self.claim}".')
        object.__setattr__(self, "rings", rings)

    @property
    def is_empty(self) -> bool:
        """Whether nothing of the target was seen."""
        return not self.rings

    def area_px(self) -> float:
        """Return the enclosed area in square pixels, holes taken out."""
        return float(sum(clockwise_area_px(ring) for ring in self.rings))

    def mask(self) -> NDArray[np.bool_]:
        """Return the pixels whose centres lie inside, (rows, columns), for display and brushes.

        Votes never look at it.
        """
        raster = np.zeros(self.image_shape, dtype=bool)
        for ring in self.rings:
            rows, columns = polygon(ring[:, 0], ring[:, 1], self.image_shape)
            raster[rows, columns] ^= True
        return raster


def clockwise_area_px(ring: Floats) -> float:
    """Return the signed area of a ring (vertices, 2) in square pixels.

    Positive when it runs clockwise as seen on the image (rows down, columns right).
    """
    row, column = ring[:, 0], ring[:, 1]
    return 0.5 * float(column @ np.roll(row, -1) - np.roll(column, -1) @ row)
