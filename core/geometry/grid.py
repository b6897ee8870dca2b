"""The voxel grid on which views vote."""

import math
from dataclasses import dataclass

import numpy as np

from core.arrays import Floats, frozen

MAX_VOXELS = 2**36
"""Voxels of the largest grid, 4096³: what can be carved plane by plane. Who stores a number for
each voxel asks for less."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class VoxelGrid:
    """A regular grid of voxel centres in the target frame.

    Attributes:
        origin_m: (3,) centre of voxel (0, 0, 0), target frame.
        spacing_m: distance between neighbouring centres, the same on all axes.
        shape: number of voxels along x, y, z.
    """

    origin_m: Floats
    spacing_m: float
    shape: tuple[int, int, int]

    def __post_init__(self) -> None:
        object.__setattr__(self, "origin_m", frozen(self.origin_m, np.float64, (3,), "Grid origin"))
        if not (np.isfinite(self.spacing_m) and self.spacing_m > 0):
            raise ValueError(
                f"Voxel spacing must be a positive length in metres, got {self.spacing_m}."
            )
        if len(self.shape) != 3 or min(self.shape) < 2:
            raise ValueError(
                f"A grid needs at least 2 voxels along each of 3 axes, got {self.shape}."
            )
        if self.voxel_count > MAX_VOXELS:
            gibibytes = -(-self.voxel_count // 2**30)
            raise ValueError(
                f"A grid of {self.shape} holds {self.voxel_count:,} voxels; one byte each would "
                f"need {gibibytes:,} GiB; at most {MAX_VOXELS:,} can be carved. "
                "Use a larger spacing."
            )

    @classmethod
    def cube(cls, *, side_m: float, spacing_m: float) -> "VoxelGrid":
        """Return a grid centred on the origin of the target frame that spans `side_m` each way."""
        if not (np.isfinite(side_m) and side_m > 0 and np.isfinite(spacing_m) and spacing_m > 0):
            raise ValueError(
                f"Grid side and spacing must be positive metres, got {side_m} and {spacing_m}."
            )
        if not np.isfinite(side_m / spacing_m):
            raise ValueError(
                f"A grid of {side_m} m at a spacing of {spacing_m} m holds more voxels than any "
                "memory; use a larger spacing."
            )
        count = max(2, round(side_m / spacing_m))
        origin = np.full(3, -0.5 * (count - 1) * spacing_m)
        return cls(origin_m=origin, spacing_m=spacing_m, shape=(count, count, count))

    @classmethod
    def over(cls, *, lower_m: Floats, upper_m: Floats, spacing_m: float) -> "VoxelGrid":
        """Return the smallest grid whose centres reach from `lower_m` to `upper_m`, both (3,).

        Raises:
            ValueError: a corner that is not finite, upper below lower, no positive spacing, or
                too many voxels.
        """
        lower, upper = (
            frozen(corner, np.float64, (3,), f"The grid's {name} corner")
            for corner, name in ((lower_m, "lower"), (upper_m, "upper"))
        )
        if not (np.isfinite(spacing_m) and spacing_m > 0):
            raise ValueError(f"Voxel spacing must be a positive length in metres, got {spacing_m}.")
        if np.any(upper < lower):
            raise ValueError(f"A grid's upper corner {upper} must not lie below its lower {lower}.")
        # Python's floats, too, overflow to infinity without a warning.
        steps = [extent / spacing_m for extent in (upper - lower).tolist()]
        if not all(map(math.isfinite, steps)):
            raise ValueError(
                f"A grid from {lower} to {upper} m at a spacing of {spacing_m} m holds more voxels "
                "than any memory; use a larger spacing."
            )
        x, y, z = (max(2, math.ceil(count - 1e-9) + 1) for count in steps)
        return cls(origin_m=lower, spacing_m=spacing_m, shape=(x, y, z))

    @property
    def voxel_count(self) -> int:
        """Number of voxels."""
        # Python's own integers: NumPy's would wrap around and let a far too large grid pass.
        return math.prod(map(int, self.shape))

    @property
    def upper_m(self) -> Floats:
        """(3,) centre of the last voxel, target frame."""
        upper: Floats = self.origin_m + self.spacing_m * (np.array(self.shape) - 1)
        return upper

    def centres_m(self) -> Floats:
        """Return all voxel centres, (nx, ny, nz, 3), target frame."""
        index = np.stack(np.meshgrid(*map(np.arange, self.shape), indexing="ij"), axis=-1)
        centres: Floats = self.origin_m + self.spacing_m * index
        return centres

    def index_to_target(self) -> Floats:
        """Return the 4 × 4 homogeneous map from voxel indices to target metres."""
        matrix = np.eye(4)
        matrix[:3, :3] *= self.spacing_m
        matrix[:3, 3] = self.origin_m
        return matrix
