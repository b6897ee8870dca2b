"""Pictures of a target in sunlight, by tracing rays."""

from dataclasses import dataclass

import numpy as np
import trimesh
from numpy.typing import NDArray

from core.arrays import Floats
from core.geometry.projection import Projection
from core.optical.materials import FacetMaterials, reflected
from core.optical.sun import EARTH_RADIUS_M

SURFACE_OFFSET_M = 1e-3
"""Rays to the sun start this far off the surface, or they would meet their own facet."""

EARTH_ALBEDO = 0.3
"""Bond albedo; clouds, snow and sea differ by tenths."""

_EARTH_PATCHES = 400


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Light:
    """What lights a target.

    Attributes:
        sun_direction: (3,) unit vector from target to sun, target frame.
        sun: share of full sunlight, 0 in the Earth's umbra.
        earth_direction: (3,) unit vector to the geocentre, target frame: +z in LVLH.
        earth_distance_m: to the geocentre; None leaves earthshine out.
    """

    sun_direction: Floats
    sun: float = 1.0
    earth_direction: tuple[float, float, float] = (0.0, 0.0, 1.0)
    earth_distance_m: float | None = None


def rendered(
    mesh: trimesh.Trimesh,
    materials: FacetMaterials,
    projection: Projection,
    light: Light,
    *,
    line_of_sight: Floats,
    shape: tuple[int, int],
    supersampling: int = 3,
) -> Floats:
    """Return the radiance at `supersampling` × `supersampling` points of every pixel.

    The unit is that of a white Lambertian surface facing the sun. Sunlight is shaded by the target
    itself; earthshine reaches every facet that looks at lit ground, unshaded. Facets reflect on
    both sides, as open meshes do not tell inside from outside; light that bounces twice is left
    out.

    Args:
        mesh: the target's, in metres.
        materials: of its facets.
        projection: of the picture.
        light: sun and Earth.
        line_of_sight: (3,) unit vector from sensor to target, target frame.
        shape: (rows, columns) of the picture.
        supersampling: points along each side of a pixel.

    Returns:
        (rows × supersampling, columns × supersampling) radiance.
    """
    image = np.zeros((shape[0] * supersampling, shape[1] * supersampling))
    rows, columns = _window(mesh, projection, shape, supersampling)
    samples = np.stack(np.meshgrid(rows, columns, indexing="ij"), axis=-1).reshape(-1, 2)
    if not len(samples):
        return image
    pixel = (samples + 0.5) / supersampling - 0.5
    origins, directions = rays(projection, pixel, line_of_sight, reach_m=_reach_m(mesh))
    facet, points = first_hits(mesh, origins, directions)
    hit = facet >= 0
    radiance = _shaded(mesh, materials, light, facet[hit], points[hit], -directions[hit])
    image[samples[hit, 0], samples[hit, 1]] = radiance
    return image


def rays(
    projection: Projection, image_points: Floats, line_of_sight: Floats, *, reach_m: float
) -> tuple[Floats, Floats]:
    """Return origins (n, 3) in metres and unit directions (n, 3) of the rays through pixels.

    Origins lie `reach_m` before the plane through the target frame's origin, not at the camera,
    so that single precision does for a camera hundreds of kilometres away.

    Args:
        projection: parallel or perspective.
        image_points: (n, 2) as (row, column).
        line_of_sight: (3,) from sensor to target, the rays' sense in a parallel projection.
        reach_m: beyond which there is nothing of the target.
    """
    if projection.is_affine:
        ahead = projection.viewing_direction()
        ahead = ahead * np.sign(ahead @ line_of_sight)
        directions = np.broadcast_to(ahead, (len(image_points), 3))
        return projection.plane_points(image_points) - reach_m * ahead, directions
    inverse = np.linalg.inv(projection.matrix[:, :3])
    centre = -inverse @ projection.matrix[:, 3]
    # The third row gives the depth, so that these directions lead ahead.
    ahead = np.column_stack([image_points, np.ones(len(image_points))]) @ inverse.T
    unit = ahead / np.linalg.norm(ahead, axis=1, keepdims=True)
    start = np.maximum(-(unit @ centre) - reach_m, 0.0)
    return centre + start[:, None] * unit, unit


def first_hits(
    mesh: trimesh.Trimesh, origins: Floats, directions: Floats
) -> tuple[NDArray[np.intp], Floats]:
    """Return the facet (n,) that each ray meets first, −1 for none, and where (n, 3)."""
    facet = np.asarray(mesh.ray.intersects_first(origins, directions), dtype=np.intp)
    normal = mesh.face_normals[facet]
    corner = mesh.vertices[mesh.faces[facet, 0]]
    steep = np.sum(normal * directions, axis=1)
    steep = np.where(np.abs(steep) > 1e-9, steep, 1e-9)
    distance = np.sum(normal * (corner - origins), axis=1) / steep
    points: Floats = origins + distance[:, None] * directions
    return facet, points


def _shaded(
    mesh: trimesh.Trimesh,
    materials: FacetMaterials,
    light: Light,
    facet: NDArray[np.intp],
    points: Floats,
    to_eye: Floats,
) -> Floats:
    normal = mesh.face_normals[facet]
    normal = normal * np.where(np.sum(normal * to_eye, axis=1) >= 0, 1.0, -1.0)[:, None]
    radiance = np.zeros(len(facet))
    facing = np.flatnonzero(normal @ light.sun_direction > 0)
    if light.sun > 0 and len(facing):
        starts = points[facing] + SURFACE_OFFSET_M * normal[facing]
        shaded = mesh.ray.intersects_any(starts, np.broadcast_to(light.sun_direction, starts.shape))
        lit = facing[~shaded]
        radiance[lit] = light.sun * reflected(
            materials, facet[lit], normal[lit], light.sun_direction, to_eye[lit]
        )
    if light.earth_distance_m is not None:
        radiance += materials.diffuse[facet] * earthshine(normal, light)
    return radiance


def earthshine(normal: Floats, light: Light) -> Floats:
    """Return the irradiance (n,) from the sunlit ground below, as a share of full sunlight.

    The visible cap of the Earth, a Lambertian sphere, is cut into patches; each shines with
    albedo / π times the cosine of the sun's zenith angle over it.

    Args:
        normal: (n, 3) unit normals of the surfaces.
        light: sun and Earth; a light without the Earth's distance gives no earthshine.
    """
    if light.earth_distance_m is None:
        return np.zeros(len(normal))
    toward, solid_angle, radiance = _earth_patches(light, light.earth_distance_m)
    irradiance: Floats = np.maximum(normal @ toward.T, 0.0) @ (radiance * solid_angle)
    return irradiance


def _earth_patches(light: Light, distance_m: float) -> tuple[Floats, float, Floats]:
    """Return directions (patches, 3) to equal solid angles of the Earth, their size, radiance."""
    nadir = np.asarray(light.earth_direction)
    horizon = np.sqrt(1 - (EARTH_RADIUS_M / distance_m) ** 2)
    number = np.arange(_EARTH_PATCHES) + 0.5
    cosine = 1 - (1 - horizon) * number / _EARTH_PATCHES
    turn = number * np.pi * (3 - np.sqrt(5))  # the golden angle spreads them evenly
    sine = np.sqrt(1 - cosine**2)
    one = np.cross(nadir, np.eye(3)[int(np.argmin(np.abs(nadir)))])
    one = one / np.linalg.norm(one)
    across = np.cos(turn)[:, None] * one + np.sin(turn)[:, None] * np.cross(nadir, one)
    toward = cosine[:, None] * nadir + sine[:, None] * across
    near = distance_m * cosine - np.sqrt(EARTH_RADIUS_M**2 - (distance_m * sine) ** 2)
    ground = (near[:, None] * toward - distance_m * nadir) / EARTH_RADIUS_M
    radiance = EARTH_ALBEDO / np.pi * np.maximum(ground @ light.sun_direction, 0.0)
    return toward, 2 * np.pi * (1 - horizon) / _EARTH_PATCHES, radiance


def _reach_m(mesh: trimesh.Trimesh) -> float:
    return float(np.linalg.norm(np.abs(mesh.bounds).max(axis=0))) + 1.0


def _window(
    mesh: trimesh.Trimesh, projection: Projection, shape: tuple[int, int], supersampling: int
) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return the sample rows and columns of the pixels that the mesh may reach."""
    corners = projection.image_points(mesh.vertices)
    first = np.maximum(np.floor(corners.min(axis=0)), 0).astype(int)
    last = np.minimum(np.ceil(corners.max(axis=0)) + 1, shape).astype(int)
    rows, columns = (
        np.arange(a * supersampling, b * supersampling) for a, b in zip(first, last, strict=True)
    )
    return rows, columns
