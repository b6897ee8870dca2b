"""ISEA as published: scatterer after scatterer, the brightest place first, taken out of the images.

The field means this by image-sequence energy accumulation. It needs the lines of sight, as the
visual hull does, but no tracks and no outlines.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats, frozen
from core.energy_accumulation.accumulation import (
    Map,
    Measure,
    PaddedImage,
    accumulated_energy,
    add_images,
    padded_image,
)
from core.frame import Frame
from core.geometry.grid import VoxelGrid

BRIGHT = 0.1
"""A frame shows a scatterer that has this share of the frame's brightest pixel or more."""

ROUNDING = 1e-5
"""Share of the first scatterer's energy that single precision may leave of cells taken out."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class EnergyScatterers:
    """Scatterers in the order in which they were found, the brightest first.

    Attributes:
        position_m: (scatterers, 3) voxel centres, target frame.
        energy: (scatterers,) sum of the images, as they then were, at its projections.
        frames: (scatterers,) number of images that held a tenth of their brightest pixel or more
            there.
        left_over: share of the images' sum that the search left in them.
    """

    position_m: Floats
    energy: Floats
    frames: NDArray[np.int64]
    left_over: float

    def __post_init__(self) -> None:
        count = len(self.energy)
        for name, dtype, shape in (
            ("position_m", np.float64, (count, 3)),
            ("energy", np.float64, (count,)),
            ("frames", np.int64, (count,)),
        ):
            object.__setattr__(self, name, frozen(getattr(self, name), dtype, shape, name))

    def __len__(self) -> int:
        """Return the number of scatterers."""
        return len(self.energy)

    def extents_m(self) -> Floats:
        """Return how far the scatterers reach along x, y and z, (3,)."""
        if not len(self):
            return np.zeros(3)
        extents: Floats = np.ptp(self.position_m, axis=0)
        return extents

    def seen_in(self, least_frames: int) -> "EnergyScatterers":
        """Return those that at least so many frames show.

        What is found late stands where the leavings of several scatterers happen to meet.
        """
        kept = self.frames >= least_frames
        return EnergyScatterers(
            position_m=self.position_m[kept],
            energy=self.energy[kept],
            frames=self.frames[kept],
            left_over=self.left_over,
        )

    def voxels(self, grid: VoxelGrid) -> NDArray[np.bool_]:
        """Return which voxels (nx, ny, nz) of a grid hold a scatterer; those outside are lost."""
        index = np.rint((self.position_m - grid.origin_m) / grid.spacing_m).astype(int)
        index = index[np.all((index >= 0) & (index < grid.shape), axis=1)]
        held = np.zeros(grid.shape, dtype=bool)
        held[tuple(index.T)] = True
        return held


def extract_scatterers(
    frames: Sequence[Frame],
    grid: VoxelGrid,
    *,
    most: int = 1000,
    least_share: float = 0.0,
    stop_left_over: float = 0.05,
    measure: Measure = "energy",
    progress: Callable[[str, int, int], None] = lambda _stage, _done, _total: None,
) -> EnergyScatterers:
    """Find scatterers one by one where the images together are brightest.

    Each is the voxel with the most accumulated energy. In every image its resolution cell, one
    resolution to each side of its projection, is then set to zero, and the map follows.

    Args:
        frames: range-Doppler images with known projections, spacings and resolutions.
        grid: candidate places.
        most: scatterers to find at most.
        least_share: stop at one with less than this share of the first one's energy.
        stop_left_over: stop when this share of the images' sum is left.
        measure: of a pixel, amplitude or energy; every frame is scaled to a total energy of one.
        progress: told of stage, scatterers found and `most`.

    Raises:
        ValueError: no frames, frames that cannot be accumulated, or of unknown resolution.

    Source: Liu, Zhou, Zhou and Shi, "A new 3-D geometry reconstruction method of space target
    utilizing the scatterer energy accumulation of ISAR image sequence", 2020, as those who follow
    tell it ("PP-ISEA", Sensors 24(11) 3550, 2024): they search the maximum by a particle swarm.
    Here all voxels are candidates, so that the maximum is certain, to half a voxel. How much of an
    image one scatterer takes out, and when the search ends, is our choice.
    """
    _check_limits(most, least_share, stop_left_over)
    energy = accumulated_energy(frames, grid, measure=measure)
    images = [padded_image(frame, grid, measure=measure) for frame in frames]
    cells = [_cell_px(frame) for frame in frames]
    bright = np.array([BRIGHT * image.values.max() for image in images])
    whole = left = sum(float(image.values.sum(dtype=np.float64)) for image in images)
    voxels: list[tuple[np.intp, ...]] = []
    values: list[float] = []
    counts: list[int] = []
    while len(voxels) < most and left > stop_left_over * whole:
        voxel = np.unravel_index(int(energy.argmax()), grid.shape)
        value = float(energy[voxel])
        if voxels and value <= max(least_share, ROUNDING) * values[0]:
            break
        places = [image.matrix[:, :3] @ voxel + image.matrix[:, 3] for image in images]
        samples = [_brightest(*pair) for pair in zip(images, places, strict=True)]
        voxels.append(voxel)
        values.append(value)
        counts.append(int(np.count_nonzero(samples >= bright)))
        left -= _take_out(energy, images, places, cells)
        progress("scatterers", len(voxels), most)
    index = np.array(voxels, dtype=np.float64).reshape(-1, 3)
    return EnergyScatterers(
        position_m=grid.origin_m + grid.spacing_m * index,
        energy=np.array(values),
        frames=np.array(counts, dtype=np.int64),
        left_over=left / whole,
    )


def _check_limits(most: int, least_share: float, stop_left_over: float) -> None:
    if most < 1 or not (0 <= least_share <= 1 and 0 <= stop_left_over <= 1):
        raise ValueError(
            "A search finds at least 1 scatterer and its shares lie from 0 to 1; got "
            f"{most}, {least_share} and {stop_left_over}."
        )


def _cell_px(frame: Frame) -> tuple[float, float]:
    """Return the resolutions of an image in pixels, at least one."""
    cells = []
    for axis in ("row", "column"):
        resolution = getattr(frame, f"{axis}_resolution_m")
        spacing = getattr(frame, f"{axis}_spacing_m")
        if resolution is None or spacing is None:
            raise ValueError(
                f"The {axis} resolution of frame {frame.label!r} is unknown, so that nobody can "
                "say how much of it one scatterer takes; give spacing and resolution."
            )
        cells.append(max(1.0, resolution / spacing))
    return cells[0], cells[1]


def _brightest(image: PaddedImage, place: Floats) -> float:
    """Return the brightest of the four pixels about a place, 0 outside."""
    row, column = np.floor(place).astype(int)
    rows, columns = image.values.shape
    if not (0 <= row < rows - 1 and 0 <= column < columns - 1):
        return 0.0
    return float(image.values[row : row + 2, column : column + 2].max())


def _take_out(
    energy: Map,
    images: Sequence[PaddedImage],
    places: Sequence[Floats],
    cells: Sequence[tuple[float, float]],
) -> float:
    """Set the cells about places to zero, in the images and in the map; return what they held."""
    boxes = [
        _box(image, place, cell) for image, place, cell in zip(images, places, cells, strict=True)
    ]
    held, taken = 0.0, []
    for image, (top, bottom, left, right) in zip(images, boxes, strict=True):
        where = slice(top, bottom), slice(left, right)
        # A pixel reaches one pixel to each side between which the image is linear.
        part = np.pad(image.values[where], 1)
        matrix = image.matrix.copy()
        matrix[:, 3] -= top - 1, left - 1
        taken.append(PaddedImage(values=part, matrix=matrix, weight=image.weight))
        image.values[where] = 0
        held += float(part.sum(dtype=np.float64))
    add_images(energy, taken, [part.window for part in taken], sign=-1)
    return held


def _box(image: PaddedImage, place: Floats, cell: tuple[float, float]) -> NDArray[np.int64]:
    """Return first row, row past the last, and the same of columns, of a cell about a place."""
    edges = []
    for middle, half, count in zip(place, cell, image.values.shape, strict=True):
        edges += [np.ceil(middle - half), np.floor(middle + half) + 1]
        edges[-2:] = np.clip(edges[-2:], 0, count).tolist()
    return np.array(edges, dtype=np.int64)
