"""Outlines of all views laid out for the search of crossings."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.hull.edge_cells import EdgeCells
from core.hull.outline import Outline


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class CrossingTables:
    """Outlines of all views, one after another, as the search for crossings needs them.

    Attributes:
        to_image: (views, 3, 4) from homogeneous voxel indices to the homogeneous image.
        points: (points, 2) of all outlines as (row, column).
        cell_maps: (views, 17) 3 × 4 from homogeneous voxel indices to the row and column of a
            cell, then the number of cell rows and columns, and where the view's part begins in
            `starts`, in `edges` and in `points`.
        starts: of each view (cells + 1,) where each cell's edges start in the view's `edges`.
        edges: which of the view's `points` the edges near each cell start at.
        lines: (points, 3) as in `EdgeCells`.
    """

    to_image: Floats
    points: Floats
    cell_maps: Floats
    starts: NDArray[np.int32]
    edges: NDArray[np.int32]
    lines: Floats

    @classmethod
    def of(
        cls, maps: Sequence[Floats], outlines: Sequence[Outline], cells: Sequence[EdgeCells]
    ) -> "CrossingTables":
        """Return the tables of views, given each one's map to the image, outline and cells."""
        return cls(
            to_image=np.array(maps),
            points=np.concatenate([outline.points for outline in outlines]),
            cell_maps=_cell_maps(np.array(maps), outlines, cells),
            starts=np.concatenate([cell.starts for cell in cells]),
            edges=np.concatenate([cell.edges for cell in cells]),
            lines=np.concatenate([cell.lines for cell in cells]),
        )


def _cell_maps(to_image: Floats, outlines: Sequence[Outline], cells: Sequence[EdgeCells]) -> Floats:
    """Return the cell maps (views, 17) of maps to the image (views, 3, 4) and of cells."""
    origin = np.array([cell.origin for cell in cells])[:, :, None]
    to_cell = to_image.copy()
    to_cell[:, :2] = (to_image[:, :2] - origin[:, :2] * to_image[:, 2:]) * origin[:, 2:]
    begins = [
        np.cumsum([0, *lengths])[:-1]
        for lengths in (
            [len(cell.starts) for cell in cells],
            [len(cell.edges) for cell in cells],
            [len(outline.points) for outline in outlines],
        )
    ]
    shapes = [cell.shape for cell in cells]
    return np.column_stack([to_cell.reshape(-1, 12), shapes, *begins])
