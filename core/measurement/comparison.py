"""How well a hull agrees with a reference body on the same grid."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True, kw_only=True)
class Agreement:
    """Voxel agreement of a hull with the truth.

    Attributes:
        intersection_over_union: shared voxels over voxels in either, 0 to 1.
        coverage: share of the true body that the hull keeps, 0 to 1.
    """

    intersection_over_union: float
    coverage: float


def voxel_agreement(hull: NDArray[np.bool_], truth: NDArray[np.bool_]) -> Agreement:
    """Compare two voxel bodies (nx, ny, nz) on one grid.

    Raises:
        ValueError: different grids, or a true body without voxels.
    """
    if hull.shape != truth.shape:
        raise ValueError(f"The bodies stand on different grids, {hull.shape} and {truth.shape}.")
    true_count = int(np.count_nonzero(truth))
    if true_count == 0:
        raise ValueError("The true body fills no voxel; use a finer grid or check its scale.")
    shared = int(np.count_nonzero(hull & truth))
    either = int(np.count_nonzero(hull | truth))
    return Agreement(intersection_over_union=shared / either, coverage=shared / true_count)
