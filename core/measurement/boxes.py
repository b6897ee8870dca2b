"""The box of least volume around points."""

import numpy as np
import trimesh

from core.arrays import Floats


def least_box(points_m: Floats) -> tuple[Floats, Floats, Floats]:
    """Return centre (3,), axes (rows, 3 × 3) and sizes (3,) of the least box, longest side first.

    Args:
        points_m: (n, 3) not all in one plane.

    Raises:
        ValueError: points in one plane, around which no box has least volume.

    Source: O'Rourke, "Finding minimal enclosing boxes", 1985, over the faces of the convex hull,
    as in trimesh.
    """
    spread = np.linalg.svd(points_m - points_m.mean(axis=0), compute_uv=False)
    if len(points_m) < 4 or spread[2] <= 1e-9 * spread[0]:
        raise ValueError("The points lie in one plane; a box of least volume needs a body.")
    to_box, sizes = trimesh.bounds.oriented_bounds(points_m)
    order = np.argsort(-sizes, kind="stable")
    axes = to_box[:3, :3]
    return -to_box[:3, 3] @ axes, axes[order], sizes[order]
