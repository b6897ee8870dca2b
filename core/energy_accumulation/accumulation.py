"""The energy map: for every voxel, the images' sum at its projections."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal

import numba
import numpy as np
from numpy.typing import NDArray
from skimage.filters import threshold_otsu

from core.arrays import Floats
from core.frame import Frame
from core.geometry.grid import VoxelGrid
from core.hull.surface import Surface, mask_surface
from core.hull.threads import InnerLoop, in_parallel

Measure = Literal["amplitude", "energy"]

Map = NDArray[np.float32]

MAX_MAP_VOXELS = 2**28
"""A map stores four bytes for each voxel: 1 GiB."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PaddedImage:
    """An image with a border of zeros, so that what lies outside it fades to nothing.

    Attributes:
        values: (rows + 2, columns + 2).
        matrix: (2, 4) from voxel indices to (row, column) of `values`.
        weight: what the frame's amplitudes, or energies, were multiplied by.
    """

    values: Map
    matrix: Floats
    weight: float

    @property
    def window(self) -> Floats:
        """First row, last row, first column and last column of the image, all (4,)."""
        rows, columns = self.values.shape
        return np.array([0.0, rows - 1.0, 0.0, columns - 1.0])


def padded_image(frame: Frame, grid: VoxelGrid, *, measure: Measure = "amplitude") -> PaddedImage:
    """Return a frame's image as it is accumulated on a grid: of total energy one, padded.

    Args:
        frame: through an affine projection.
        grid: of the map.
        measure: "amplitude" or its square, "energy".

    Raises:
        ValueError: a perspective frame, one that is dark everywhere, or another measure.
    """
    if measure not in ("amplitude", "energy"):
        raise ValueError(f'A map adds up "amplitude" or "energy", not "{measure}".')
    if not frame.projection.is_affine:
        raise ValueError(
            f"Frame {frame.label!r} is a perspective picture; energy is accumulated over "
            "range-Doppler images. Leave it out."
        )
    total = float(np.sum(np.square(frame.amplitude, dtype=np.float64)))
    if not total > 0:
        raise ValueError(f"Frame {frame.label!r} is dark everywhere; leave it out.")
    power = 1 if measure == "amplitude" else 2
    weight = total ** (-power / 2)
    values = (weight * frame.amplitude.astype(np.float64) ** power).astype(np.float32)
    matrix = frame.projection.matrix @ grid.index_to_target()
    matrix[:, 3] += 1
    return PaddedImage(values=np.pad(values, 1), matrix=matrix, weight=weight)


def accumulated_energy(
    frames: Iterable[Frame], grid: VoxelGrid, *, measure: Measure = "amplitude"
) -> Map:
    """Return for each voxel the sum over frames of the image where the voxel projects to.

    Every frame is first scaled to a total energy of one, so that all weigh alike whatever glints;
    between pixels the image is bilinear, outside it zero.

    Args:
        frames: range-Doppler images, their projections known.
        grid: of the map.
        measure: of a pixel, see `padded_image`.

    Returns:
        (nx, ny, nz) float32.

    Raises:
        ValueError: no frames, a frame that `padded_image` refuses, or a grid too large to store.

    Source: the objective that Liu, Zhou, Zhou and Shi, "A new 3-D geometry reconstruction method
    of space target utilizing the scatterer energy accumulation of ISAR image sequence", 2020,
    maximise for one scatterer at a time (`core.energy_accumulation.extraction`), evaluated for
    all places at once. Frames of equal energy and bilinear pixels are our choice: only those who
    follow that paper were at hand.
    """
    images = [padded_image(frame, grid, measure=measure) for frame in frames]
    if not images:
        raise ValueError("Energy is accumulated over at least one frame; got none.")
    if grid.voxel_count > MAX_MAP_VOXELS:
        raise ValueError(
            f"A map of {grid.voxel_count:,} voxels is larger than the {MAX_MAP_VOXELS:,} that are "
            "stored; use a larger spacing."
        )
    energy = np.zeros(grid.shape, dtype=np.float32)
    add_images(energy, images, [image.window for image in images])
    return energy


def add_images(
    energy: Map, images: Sequence[PaddedImage], windows: Sequence[Floats], *, sign: int = 1
) -> None:
    """Add to a map (nx, ny, nz) what images hold inside their windows, or take it off again."""

    def add_plane(x: int) -> None:
        # Plane by plane, all images: the plane stays in the processor's cache.
        for image, window in zip(images, windows, strict=True):
            _add_plane(energy[x], x, image.values, image.matrix, window, np.float32(sign))

    in_parallel(add_plane, range(len(energy)))


@numba.njit(**InnerLoop)  # type: ignore[untyped-decorator]
def _add_plane(
    plane: Map, x: int, image: Map, matrix: Floats, window: Floats, sign: np.float32
) -> None:  # pragma: no cover - compiled
    """Add an image's samples to one plane (ny, nz) of the map."""
    top, bottom, left, right = window
    row_step, column_step = matrix[0, 2], matrix[1, 2]
    # A step of next to nothing keeps its place: the division then leaves all z, or none.
    per_row = 1 / row_step if abs(row_step) > 1e-12 else 1e12
    per_column = 1 / column_step if abs(column_step) > 1e-12 else 1e12
    for y in range(plane.shape[0]):
        row_0 = matrix[0, 0] * x + matrix[0, 1] * y + matrix[0, 3]
        column_0 = matrix[1, 0] * x + matrix[1, 1] * y + matrix[1, 3]
        # The stretch of z whose row and column lie inside the window, a voxel too long …
        one, other = (top - row_0) * per_row, (bottom - row_0) * per_row
        low, high = max(0.0, min(one, other) - 1), min(plane.shape[1] - 1.0, max(one, other) + 1)
        one, other = (left - column_0) * per_column, (right - column_0) * per_column
        low, high = max(low, min(one, other) - 1), min(high, max(one, other) + 1)
        if high < low:
            continue
        first, last = int(low), int(high)
        # … so that its ends are drawn in. On the window's last row and column the image is zero.
        while first <= last and not (
            top <= row_0 + row_step * first < bottom
            and left <= column_0 + column_step * first < right
        ):
            first += 1
        while first <= last and not (
            top <= row_0 + row_step * last < bottom
            and left <= column_0 + column_step * last < right
        ):
            last -= 1
        for z in range(first, last + 1):
            row, column = row_0 + row_step * z, column_0 + column_step * z
            i, j = int(row), int(column)
            down, across = np.float32(row - i), np.float32(column - j)
            above = image[i, j] + across * (image[i, j + 1] - image[i, j])
            below = image[i + 1, j] + across * (image[i + 1, j + 1] - image[i + 1, j])
            plane[y, z] += sign * (above + down * (below - above))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class EnergyBody:
    """The voxels of an energy map above a threshold.

    Attributes:
        inside: (nx, ny, nz).
        threshold: in the map's unit.
        grid: where the voxels stand.
    """

    inside: NDArray[np.bool_]
    threshold: float
    grid: VoxelGrid

    def points_m(self) -> Floats:
        """Return the centres of the voxels, (points, 3), target frame."""
        points: Floats = self.grid.origin_m + self.grid.spacing_m * np.argwhere(self.inside)
        return points

    def surface(self) -> Surface:
        """Return the surface halfway between the voxels inside and outside."""
        return mask_surface(self.inside, self.grid)

    def extents_m(self) -> Floats:
        """Return how far the body reaches along x, y and z, (3,), zero if it is empty.

        A voxel counts with its whole width.
        """
        points = self.points_m()
        if not len(points):
            return np.zeros(3)
        extents: Floats = np.ptp(points, axis=0) + self.grid.spacing_m
        return extents


def energy_body(energy: Map, grid: VoxelGrid, *, threshold: float | None = None) -> EnergyBody:
    """Return the body of an energy map: the voxels at the threshold or above it.

    Args:
        energy: (nx, ny, nz) from `accumulated_energy`.
        grid: its grid.
        threshold: in the map's unit; by default Otsu's, which parts its histogram in two (Otsu, "A
            threshold selection method from gray-level histograms", 1979).

    Raises:
        ValueError: a map of another grid, or without any contrast.
    """
    if energy.shape != grid.shape:
        raise ValueError(f"The map of {energy.shape} voxels is not of a grid of {grid.shape}.")
    if threshold is None:
        if not float(np.ptp(energy)) > 0:
            raise ValueError("The map has one value everywhere: no threshold can part it.")
        threshold = float(threshold_otsu(energy))
    return EnergyBody(inside=energy >= threshold, threshold=threshold, grid=grid)
