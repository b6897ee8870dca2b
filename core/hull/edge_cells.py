"""A view's outline sorted into cells of the image, to find the edges near a point at once."""

from dataclasses import dataclass

import numba
import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.geometry.grid import VoxelGrid
from core.hull.outline import Outline
from core.hull.threads import Compiled

CELLS_ACROSS = 96


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class EdgeCells:
    """For each cell of an image, the edges that a grid edge centred in the cell could cross.

    Attributes:
        origin: (3,) row and column of the first cell's corner, and cells per pixel.
        shape: (2,) cells along rows and columns.
        starts: (cells + 1,) where each cell's edges start in `edges`.
        edges: numbers of the points at which the edges start.
        lines: (points, 3) the line through the edge that starts at each point: from row and column
            in cells and 1 to the distance from it, at most 1 where a grid edge could cross it.
    """

    origin: Floats
    shape: NDArray[np.int64]
    starts: NDArray[np.int32]
    edges: NDArray[np.int32]
    lines: Floats

    @classmethod
    def of(cls, outline: Outline, to_image: Floats, grid: VoxelGrid) -> "EdgeCells":
        """Return the cells of an outline for grid edges seen through `to_image` (3 × 4)."""
        points, reach = outline.points, longest_grid_edge_px(to_image, grid)
        if len(points) == 0:
            empty = np.zeros(2, dtype=np.int32)
            one = np.ones(2, dtype=np.int64)
            lines = np.empty((0, 3))
            return cls(origin=np.zeros(3), shape=one, starts=empty, edges=empty[:0], lines=lines)
        extent = float(np.ptp(points, axis=0).max()) + 2 * reach
        cell = max(reach, extent / CELLS_ACROSS)
        # A rim of empty cells stands for everything beyond.
        low = points.min(axis=0) - reach - cell
        shape = np.floor((points.max(axis=0) + reach - low) / cell).astype(np.int64) + 2
        origin = np.array([low[0], low[1], 1 / cell])
        starts, edges = _sorted_into_cells(points, outline.offsets, origin, shape, reach)
        # Seen in perspective a grid edge's middle may lie near one of its ends.
        far = (0.5 if np.all(to_image[2, :3] == 0) else 1.0) * reach / cell
        lines = _lines((points - low) / cell) / far
        return cls(origin=origin, shape=shape, starts=starts, edges=edges, lines=lines)

    def to_cell(self, to_image: Floats) -> Floats:
        """Return the 3 × 4 map from homogeneous voxel indices to a cell's row and column."""
        mapped = to_image.copy()
        mapped[:2] = (to_image[:2] - self.origin[:2, None] * to_image[2]) * self.origin[2]
        return mapped


def longest_grid_edge_px(to_image: Floats, grid: VoxelGrid) -> float:
    """Return how long, in pixels, the step between neighbouring voxels can look in an image."""
    ends = [np.array([0.0, count - 1]) for count in grid.shape]
    corners = np.stack(np.meshgrid(*ends, indexing="ij"), axis=-1).reshape(-1, 3)
    depth = corners @ to_image[2, :3] + to_image[2, 3]
    seen = (corners @ to_image[:2, :3].T + to_image[:2, 3]) / depth[:, None]
    # The derivative of the projection is greatest at a corner, where the depth is least.
    steps = (to_image[:2, :3] - seen[:, :, None] * to_image[2, :3]) / depth[:, None, None]
    return float(np.linalg.norm(steps, axis=1).max()) * 1.01


def _lines(points: Floats) -> Floats:
    """Return rows (points, 3) that give the distance from the line to the next point."""
    along = np.diff(points, axis=0, append=points[-1:])
    # A point without a next one has a line from which nothing is far.
    length = np.maximum(np.hypot(along[:, 0], along[:, 1]), 1e-300)
    normal = along[:, ::-1] * (1.0, -1.0) / length[:, None]
    return np.column_stack([normal, -np.sum(normal * points, axis=1)])


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def _sorted_into_cells(
    points: Floats,
    offsets: NDArray[np.int64],
    origin: Floats,
    shape: NDArray[np.int64],
    reach: float,
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:  # pragma: no cover - compiled
    """Return starts and edges: first counted, then written."""
    starts = np.zeros(shape[0] * shape[1] + 1, dtype=np.int32)
    edges = np.zeros(0, dtype=np.int32)
    for writing in range(2):
        for ring in range(len(offsets) - 1):
            for i in range(offsets[ring], offsets[ring + 1] - 1):
                _visit_cells(points, i, origin, shape, reach, starts, edges, writing == 1)
        if writing == 0:
            total = np.int32(0)
            for cell in range(len(starts)):
                total += starts[cell]
                starts[cell] = total
            # Writing counts each cell's end down to its start.
            edges = np.empty(total, dtype=np.int32)
    return starts, edges


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def _visit_cells(
    points: Floats,
    i: int,
    origin: Floats,
    shape: NDArray[np.int64],
    reach: float,
    starts: NDArray[np.int32],
    edges: NDArray[np.int32],
    writing: bool,
) -> None:  # pragma: no cover - compiled
    """Count or write edge i in every cell from which it is within reach."""
    per_px = origin[2]
    ar, ac = (points[i, 0] - origin[0]) * per_px, (points[i, 1] - origin[1]) * per_px
    br, bc = (points[i + 1, 0] - origin[0]) * per_px, (points[i + 1, 1] - origin[1]) * per_px
    far = reach * per_px
    dr, dc = br - ar, bc - ac
    wide = (0.5 + far) * (abs(dr) + abs(dc))
    for row in range(max(int(min(ar, br) - far), 0), min(int(max(ar, br) + far) + 1, shape[0])):
        for column in range(
            max(int(min(ac, bc) - far), 0), min(int(max(ac, bc) + far) + 1, shape[1])
        ):
            if abs(dr * (column + 0.5 - ac) - dc * (row + 0.5 - ar)) > wide:
                continue
            cell = row * shape[1] + column
            if writing:
                starts[cell] -= 1
                edges[starts[cell]] = i
            else:
                starts[cell] += 1
