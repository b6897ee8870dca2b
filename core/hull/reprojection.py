"""A hull seen through one of its views: what the silhouette should be if all views were right."""

import numba
import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.geometry.projection import Projection
from core.hull.surface import Surface
from core.hull.threads import Compiled


def reprojected_mask(
    surface: Surface, projection: Projection, image_shape: tuple[int, int]
) -> NDArray[np.bool_]:
    """Return the pixels (rows, columns) whose centres the surface covers in an image."""
    mask = np.zeros(image_shape, dtype=np.bool_)
    image = np.ascontiguousarray(projection.image_points(surface.vertices_m))
    _cover(image, surface.faces, mask)
    return mask


@numba.njit(**Compiled)  # type: ignore[untyped-decorator]
def _cover(
    image: Floats, faces: NDArray[np.int32], mask: NDArray[np.bool_]
) -> None:  # pragma: no cover - compiled
    """Set the pixels within any triangle's image."""
    for f in range(len(faces)):
        ar, ac = image[faces[f, 0], 0], image[faces[f, 0], 1]
        br, bc = image[faces[f, 1], 0], image[faces[f, 1], 1]
        cr, cc = image[faces[f, 2], 0], image[faces[f, 2], 1]
        turn = 1.0 if (br - ar) * (cc - ac) >= (bc - ac) * (cr - ar) else -1.0
        first, last = max(np.ceil(min(ar, br, cr)), 0.0), min(max(ar, br, cr), mask.shape[0] - 1.0)
        left, right = max(np.ceil(min(ac, bc, cc)), 0.0), min(max(ac, bc, cc), mask.shape[1] - 1.0)
        for row in range(int(first), int(np.floor(last)) + 1):
            for column in range(int(left), int(np.floor(right)) + 1):
                if mask[row, column]:
                    continue
                ab = (br - ar) * (column - ac) - (bc - ac) * (row - ar)
                bc_ = (cr - br) * (column - bc) - (cc - bc) * (row - br)
                ca = (ar - cr) * (column - cc) - (ac - cc) * (row - cr)
                mask[row, column] = min(turn * ab, turn * bc_, turn * ca) >= 0
