"""A hull seen through one of its views: what the silhouette should be if all views were right."""

import numba
import numpy as np
import shapely
from numpy.typing import NDArray

from core.arrays import Floats
from core.geometry.projection import Projection
from core.hull.surface import Surface
from core.hull.threads import Compiled
from core.silhouettes.areas import area_of
from core.silhouettes.contours import traced_rings
from core.silhouettes.silhouette import Silhouette


def reprojected_mask(
    surface: Surface, projection: Projection, image_shape: tuple[int, int]
) -> NDArray[np.bool_]:
    """Return the pixels (rows, columns) whose centres the surface covers in an image."""
    mask = np.zeros(image_shape, dtype=np.bool_)
    image = np.ascontiguousarray(projection.image_points(surface.vertices_m))
    _cover(image, surface.faces, mask)
    return mask


def reprojected_rings(
    surface: Surface, projection: Projection, image_shape: tuple[int, int], *, finer: int = 4
) -> tuple[Floats, ...]:
    """Return the outline of a surface's image, to seed a silhouette or to be compared with one.

    It is traced from a raster with `finer` × `finer` pixels to each of the image's: whatever lies
    further than 1 / `finer` pixels from the true outline is on the right side of it.

    Args:
        surface: of the hull.
        projection: of the frame.
        image_shape: (rows, columns).
        finer: how many times finer than the image's the raster is.

    Raises:
        ValueError: a raster that is not 1 to 8 times finer.
    """
    return _rings_within(surface, projection, np.zeros(2, dtype=int), image_shape, finer)


def uncovered_area_px(
    surface: Surface, projection: Projection, silhouette: Silhouette, *, finer: int = 4
) -> float:
    """Return how much of a silhouette's area, in square pixels, a surface's image leaves open.

    Where the surface reaches past the silhouette does not matter: a lit side may be smaller than
    the target.

    Args:
        surface: of the hull.
        projection: of the frame.
        silhouette: as drawn in the frame.
        finer: how many times finer than the image's the raster of the surface's image is.

    Raises:
        ValueError: a raster that is not 1 to 8 times finer.
    """
    if silhouette.is_empty:
        return 0.0
    points = np.concatenate(silhouette.rings)
    first = np.floor(points.min(axis=0)).astype(int)
    rows, columns = np.ceil(points.max(axis=0)).astype(int) + 1 - first
    rings = _rings_within(surface, projection, first, (int(rows), int(columns)), finer)
    drawn = area_of(silhouette.rings)
    return float(shapely.area(shapely.difference(drawn, area_of(rings))))


def _rings_within(
    surface: Surface,
    projection: Projection,
    first: NDArray[np.int_],
    shape: tuple[int, int],
    finer: int,
) -> tuple[Floats, ...]:
    """Trace the surface's image on the part of the image that begins at the pixel `first`."""
    if not 1 <= finer <= 8:
        raise ValueError(f"The raster may be 1 to 8 times finer than the image, not {finer}.")
    # Pixel centres at integers: (finer − 1) / 2 is the fine raster's place of the coarse origin.
    centre = (finer - 1) / 2
    shift = centre - finer * first
    matrix = projection.matrix.copy()
    if projection.is_affine:
        matrix[:2] *= finer
        matrix[:2, 3] += shift
    else:
        matrix[:2] = finer * matrix[:2] + np.outer(shift, matrix[2])
    fine_shape = (finer * shape[0], finer * shape[1])
    mask = reprojected_mask(surface, Projection(matrix=matrix), fine_shape)
    rings = traced_rings(mask.astype(np.float32), 0.5, simplification_px=0.3)
    return tuple((ring - centre) / finer + first for ring in rings)


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
