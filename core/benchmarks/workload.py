"""The test body and its exact outlines: one deterministic workload for every benchmark."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from core.arrays import Floats
from core.geometry.grid import VoxelGrid
from core.geometry.projection import Projection
from core.hull.view import View
from core.silhouettes.areas import rings_of
from core.silhouettes.silhouette import Silhouette

IMAGE_SIDE_PX = 512
PIXEL_M = 0.0185
GRID_SIDE_M = 9.6
BODY_LENGTH_M = 3.6
PANEL_SPAN_M = 8.4
PANEL_THICKNESS_M = 0.06
ATTITUDE = Rotation.from_euler("xyz", (0.3, 0.4, 0.5))
"""The body stands askew in the grid, so that no face is flattered by lying in voxel planes."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Task:
    """The same work for every contender: views and a grid on which they vote.

    Attributes:
        views: affine ones.
        grid: where they vote.
        masks: (views, rows, columns) uint8, the silhouettes at pixel centres. Peers that look
            votes up in masks get them for nothing. (0, 0, 0) where no peer runs.
        to_image: (views, 2, 4) from homogeneous voxel indices to (row, column).
    """

    views: tuple[View, ...]
    grid: VoxelGrid
    masks: NDArray[np.uint8]
    to_image: Floats

    @classmethod
    def of(cls, views: Iterable[View], grid: VoxelGrid, *, masks: bool = False) -> "Task":
        """Return the task of these views on this grid, with `masks` for peers that want them."""
        chosen = tuple(views)
        return cls(
            views=chosen,
            grid=grid,
            masks=np.array([view.silhouette.mask() for view in chosen], dtype=np.uint8)
            if masks
            else np.empty((0, 0, 0), dtype=np.uint8),
            to_image=np.array([view.projection.matrix @ grid.index_to_target() for view in chosen]),
        )

    @property
    def dtype(self) -> type[np.uint8] | type[np.uint16]:
        """The smallest type that holds as many votes as there are views."""
        return np.uint8 if len(self.views) <= 255 else np.uint16

    def all_planes(self) -> NDArray[np.int64]:
        """Return the numbers of all planes along x."""
        return np.arange(self.grid.shape[0])


def satellite_task(
    size: int, views: int, *, seed: int = 1, segments: int = 64, masks: bool = False
) -> Task:
    """Return the test body under random views on a cubic grid of `size` voxels a side."""
    chosen = satellite_views(views, seed=seed, segments=segments)
    return Task.of(chosen, cubic_grid(size), masks=masks)


def cubic_grid(size: int) -> VoxelGrid:
    """Return the grid of `size` voxels a side that holds the test body."""
    return VoxelGrid.cube(side_m=GRID_SIDE_M, spacing_m=GRID_SIDE_M / size)


def satellite_views(count: int, *, seed: int = 1, segments: int = 64) -> tuple[View, ...]:
    """Return exact outlines of the test body under random views over the whole sphere."""
    random = np.random.default_rng(seed)
    parts = satellite(segments)
    turns = Rotation.random(count, rng=random).as_matrix()
    centres = 0.5 * (IMAGE_SIDE_PX - 1) + random.uniform(-3, 3, (count, 2))
    return tuple(
        _view_of(parts, np.column_stack([turn[:2] / PIXEL_M, centre]))
        for turn, centre in zip(turns, centres, strict=True)
    )


def satellite(segments: int = 64) -> tuple[Floats, ...]:
    """Return the test body's convex parts, each (points, 3) in metres, target frame.

    A cylinder along its z, 60 mm panels along ±y on two struts each (a window between them), a
    dish on a boom at +x and a long thin boom at −x.
    """
    thin, half = 0.5 * PANEL_THICKNESS_M, 0.5 * PANEL_SPAN_M
    parts = [
        _rounds([(1.0, -0.5 * BODY_LENGTH_M), (1.0, 0.5 * BODY_LENGTH_M)], segments),
        _rounds([(0.15, 1.8), (0.6, 1.95), (0.9, 2.2)], segments * 3 // 4)[:, [2, 1, 0]],
        _box((0.9, 1.9), (-0.05, 0.05), (-0.05, 0.05)),
        _box((-3.0, -0.9), (-0.04, 0.04), (-0.04, 0.04)),
        _box((-3.3, -3.0), (-0.15, 0.15), (-0.15, 0.15)),
    ]
    for side in (-1, 1):
        parts.append(_box((-thin, thin), (side * 1.4, side * half), (-0.8, 0.8)))
        parts += [
            _box((-thin, thin), (side * 0.9, side * 1.45), (height - 0.03, height + 0.03))
            for height in (-0.4, 0.4)
        ]
    return tuple(ATTITUDE.apply(part) for part in parts)


def degenerate_task(*, seed: int = 1, size: int = 33) -> Task:
    """Return integer outlines with holes under axis-aligned and 45° views.

    Vertices and edges lie exactly on voxel centres, views look along grid axes and diagonals.
    """
    random = np.random.default_rng(seed)
    grid = VoxelGrid(origin_m=np.zeros(3), spacing_m=1.0, shape=(size, size, size))
    axes = np.eye(3)
    directions = [(axes[i], axes[j]) for i in range(3) for j in range(3) if i != j]
    directions += [(axes[i] + axes[j], axes[k]) for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1))]
    directions += [(axes[i] - axes[j], axes[k]) for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1))]
    directions += [(axes[i] + axes[j], axes[i] - axes[j]) for i, j in ((0, 1), (1, 2), (0, 2))]
    views = []
    for row, column in directions:
        matrix = np.column_stack([np.stack([row, column]), np.full(2, 4.0)])
        views.append(_view(_integer_outline(random, size), matrix, 2 * size + 8))
    return Task.of(views, grid, masks=True)


def _integer_outline(random: np.random.Generator, size: int) -> shapely.Geometry:
    """Return a union of integer rectangles and diamonds with integer holes."""
    shapes = []
    for _ in range(4):
        row, column = random.integers(4, size, 2)
        height, width = random.integers(6, size, 2)
        shapes.append(shapely.box(row, column, row + height, column + width))
        shapes.append(_diamond(int(row), int(column), int(height)))
    holes = []
    for _ in range(6):
        row, column = random.integers(4, 2 * size, 2)
        holes.append(shapely.box(row, column, row + 3, column + 4))
        holes.append(_diamond(int(column), int(row), 3))
    return shapely.difference(shapely.union_all(shapes), shapely.union_all(holes))


def _diamond(row: int, column: int, reach: int) -> shapely.Geometry:
    corners = ((row - reach, column), (row, column - reach), (row + reach, column))
    return shapely.polygons((*corners, (row, column + reach)))


def _view_of(parts: Iterable[Floats], matrix: Floats) -> View:
    projection = Projection(matrix=matrix)
    shadows = [
        shapely.convex_hull(shapely.multipoints(projection.image_points(part))) for part in parts
    ]
    return _view(shapely.union_all(shadows), matrix, IMAGE_SIDE_PX)


def _view(outline: shapely.Geometry, matrix: Floats, side_px: int) -> View:
    silhouette = Silhouette(
        rings=rings_of(outline), image_shape=(side_px, side_px), claim="complete"
    )
    return View(silhouette=silhouette, projection=Projection(matrix=matrix))


def _box(x: tuple[float, float], y: tuple[float, float], z: tuple[float, float]) -> Floats:
    corners: Floats = np.array(np.meshgrid(x, y, z)).reshape(3, 8).T
    return corners


def _rounds(circles: list[tuple[float, float]], segments: int) -> Floats:
    """Return regular polygons about the z axis, each given by its (radius, height)."""
    angle = 2 * np.pi * np.arange(segments) / segments
    unit = np.stack([np.cos(angle), np.sin(angle), np.zeros(segments)], axis=1)
    return np.concatenate([radius * unit + (0, 0, height) for radius, height in circles])
