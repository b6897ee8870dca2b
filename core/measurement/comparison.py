"""How well a hull agrees with a reference body: voxel by voxel, and as distances in metres."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats, frozen
from core.geometry.grid import VoxelGrid
from core.hull.closed_mesh import Surface
from core.measurement.regions import area_vectors_m2
from core.measurement.triangle_tree import tree_of

SAMPLES = 20_000


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


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ReferenceComparison:
    """A hull held against a reference surface.

    Attributes:
        signed_distances_m: (vertices,) of the hull's vertices from the reference, outside it
            positive.
        intersection_over_union: of the enclosed voxels, 0 to 1.
        chamfer_m: mean distance from surface to surface, the mean of both ways.
        hausdorff_m: greatest distance found, either way.
    """

    signed_distances_m: Floats
    intersection_over_union: float
    chamfer_m: float
    hausdorff_m: float


def placed(surface: Surface, *, rotation: Floats, translation_m: Floats) -> Surface:
    """Return a reference surface in its own attitude: turned, then moved.

    Args:
        surface: as its file has it.
        rotation: (3, 3) right-handed rotation from the surface's axes to the target frame.
        translation_m: (3,) target frame.

    Raises:
        ValueError: no rotation: axes that are not perpendicular unit vectors, or a mirror image.
    """
    turn = frozen(rotation, np.float64, (3, 3), "The reference's rotation")
    if not np.allclose(turn @ turn.T, np.eye(3), atol=1e-6) or np.linalg.det(turn) < 0:
        raise ValueError(
            "The reference's attitude must be a rotation: perpendicular unit axes, right-handed; "
            f"got {turn.tolist()}."
        )
    shift = frozen(translation_m, np.float64, (3,), "The reference's translation")
    return Surface(vertices_m=surface.vertices_m @ turn.T + shift, faces=surface.faces)


def signed_distances_m(points_m: Floats, reference: Surface) -> Floats:
    """Return the distance of points (n, 3) from a closed surface, (n,), positive outside it.

    The reference may be of several bodies that overlap. Inside two of them at once, the distance
    is that from the nearest face, even one within the other body.

    Raises:
        ValueError: an empty reference.
    """
    tree = tree_of(reference)
    places, _ = tree.nearest_m(points_m)
    distances = np.linalg.norm(places - points_m, axis=1)
    signed: Floats = np.where(tree.windings(points_m) > 0, -distances, distances)
    return signed


def compare(
    hull: Surface, reference: Surface, *, spacing_m: float, samples: int = SAMPLES
) -> ReferenceComparison:
    """Hold a hull against a reference surface.

    Mean distances are those of points spread evenly at random over each surface's area, always
    the same ones; the greatest also looks at all vertices. Both are therefore exact only as far as
    the samples go: with n of them a mean is off by its spread over √n.

    Args:
        hull: closed.
        reference: closed, in its own attitude (`placed`).
        spacing_m: of the voxels that are compared.
        samples: points on each surface.

    Raises:
        ValueError: an empty surface, no positive spacing, or too fine a one.
    """
    if hull.is_empty or reference.is_empty:
        which = "hull" if hull.is_empty else "reference"
        raise ValueError(f"The {which} is empty, so there is nothing to compare.")
    signed = signed_distances_m(hull.vertices_m, reference)
    there = _distances_m(_spread_over(hull, samples), reference)
    back = _distances_m(_spread_over(reference, samples), hull)
    of_vertices = _distances_m(reference.vertices_m, hull)
    return ReferenceComparison(
        signed_distances_m=signed,
        intersection_over_union=_voxel_iou(hull, reference, spacing_m),
        chamfer_m=float(there.mean() + back.mean()) / 2,
        hausdorff_m=float(max(there.max(), back.max(), of_vertices.max(), np.abs(signed).max())),
    )


def _distances_m(points_m: Floats, surface: Surface) -> Floats:
    places, _ = tree_of(surface).nearest_m(points_m)
    distances: Floats = np.linalg.norm(places - points_m, axis=1)
    return distances


def _spread_over(surface: Surface, count: int) -> Floats:
    """Return points evenly at random over a surface's area, (count, 3), always the same ones."""
    random = np.random.default_rng(0)
    areas = np.linalg.norm(area_vectors_m2(surface), axis=1)
    chosen = random.choice(len(areas), count, p=areas / areas.sum())
    u, v = np.sqrt(random.random(count)), random.random(count)
    shares = np.stack([1 - u, u * (1 - v), u * v], axis=1)
    points: Floats = np.einsum("ni,nij->nj", shares, surface.vertices_m[surface.faces[chosen]])
    return points


def _voxel_iou(hull: Surface, reference: Surface, spacing_m: float) -> float:
    both = np.concatenate([hull.vertices_m, reference.vertices_m])
    grid = VoxelGrid.over(lower_m=both.min(axis=0), upper_m=both.max(axis=0), spacing_m=spacing_m)
    shared = either = 0
    for plane in range(grid.shape[0]):
        index = np.stack(np.meshgrid(*map(np.arange, grid.shape[1:]), indexing="ij"), axis=-1)
        corner = np.full((*grid.shape[1:], 1), plane)
        voxels = np.concatenate([corner, index], axis=-1).reshape(-1, 3)
        centres = grid.origin_m + grid.spacing_m * voxels
        first, second = (tree_of(body).windings(centres) > 0 for body in (hull, reference))
        shared += int(np.count_nonzero(first & second))
        either += int(np.count_nonzero(first | second))
    if either == 0:
        raise ValueError(f"Both bodies fill no voxel of {spacing_m} m; use a finer spacing.")
    return shared / either
