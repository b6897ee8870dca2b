"""A standing person from published body proportions, and a knife to carry."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import trimesh
from skimage.measure import marching_cubes

from core.arrays import Floats
from core.targets import LineFeature, Target

CELL_M = 0.016
"""Grid that the body is meshed on; between its points the distance is nearly linear, so that the
surface is right to a millimetre."""

BLEND_M = 0.03
"""Over this distance two solids flow into each other, as flesh does."""

SHOULDER_BAND = (0.78, 0.86)
"""Heights, as shares of the whole, between which the shoulders are widest."""

WAIST = 0.60
"""Height of the waist as a share of the whole."""

KNIFE = "knife"

Point = tuple[float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class _Limb:
    """A cone with round ends: axis points (forward, right, height) and their radii, in metres."""

    start_m: Point
    end_m: Point
    radii_m: tuple[float, float]

    def distance_m(self, points_m: Floats) -> Floats:
        start, axis = np.array(self.start_m), np.subtract(self.end_m, self.start_m)
        share = np.clip((points_m - start) @ axis / (axis @ axis), 0, 1)
        off = np.linalg.norm(points_m - start - share[..., None] * axis, axis=-1)
        first, last = self.radii_m
        distance: Floats = off - (first + share * (last - first))
        return distance


@dataclass(frozen=True, slots=True, kw_only=True)
class _Ellipsoid:
    """Centre and half axes (forward, right, height) in metres."""

    centre_m: Point
    half_m: Point

    def distance_m(self, points_m: Floats) -> Floats:
        """Return the distance to first order about the surface."""
        half = np.array(self.half_m)
        scaled = (points_m - np.array(self.centre_m)) / half
        reach = np.linalg.norm(scaled, axis=-1)
        slope = np.linalg.norm(scaled / half, axis=-1)
        distance: Floats = reach * (reach - 1) / np.maximum(slope, 1e-9)
        return distance


def standing_person(
    *,
    height_m: float = 1.75,
    shoulder_width_m: float = 0.44,
    knife_length_m: float = 0.25,
) -> Target:
    """Return a person who faces +x with a knife before the waist: body, blade, handle.

    z points down, so that the feet stand at +height/2 and the right arm hangs at +y. The arms
    hang a little off the body; nothing is symmetric once the knife is there.

    Args:
        height_m: from the soles to the crown.
        shoulder_width_m: over both deltoid muscles.
        knife_length_m: from the tip to the end of the handle.

    Raises:
        ValueError: proportions that no standing person has.
    """
    body = body_mesh(height_m, shoulder_width_m)
    knife, direction = _knife(body, height_m, knife_length_m)
    return Target(
        name="standing person with a knife",
        parts=(body, *knife),
        features=(
            LineFeature(name="height", length_m=height_m, direction=np.array([0.0, 0.0, 1.0])),
            LineFeature(
                name="shoulder width",
                length_m=shoulder_width_m,
                direction=np.array([0.0, 1.0, 0.0]),
            ),
            LineFeature(name=KNIFE, length_m=knife_length_m, direction=direction),
        ),
    )


@lru_cache(maxsize=4)
def body_mesh(height_m: float, shoulder_width_m: float) -> trimesh.Trimesh:
    """Return the closed surface of a body without anything on it, as `standing_person` stands.

    Raises:
        ValueError: proportions that no standing person has.

    Source: heights of the joints as shares of the stature from Drillis and Contini, "Body segment
    parameters", 1966 (as in Winter, "Biomechanics and motor control of human movement", fig. 4.1);
    girths are ours. The solids are joined by a smooth least distance (Quilez, "Smooth minimum",
    2013) and meshed by Lorensen and Cline's marching cubes, 1987.
    """
    if not (0.5 <= height_m <= 2.5 and 0.2 <= shoulder_width_m / height_m <= 0.32):
        raise ValueError(
            "A standing person is 0.5 to 2.5 m tall and 0.20 to 0.32 of that wide over the "
            f"shoulders; got {height_m:g} m and {shoulder_width_m:g} m."
        )
    upper = np.array([0.35, 0.5 * shoulder_width_m + 0.2, height_m + 0.1])
    lower = np.array([-0.35, -upper[1], -0.1])
    axes = [np.arange(a, b, CELL_M) for a, b in zip(lower, upper, strict=True)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    inside = -_distance_m(points, height_m, shoulder_width_m)
    vertices, faces, _, _ = marching_cubes(inside, 0.0, gradient_direction="ascent")
    placed = _to_size(vertices.astype(np.float64) * CELL_M + lower, height_m, shoulder_width_m)
    # Heights grow upward and z downward: one axis turned about, the faces turn with it.
    return trimesh.Trimesh(placed * [1, 1, -1] + [0, 0, height_m / 2], faces[:, ::-1])


def _distance_m(points_m: Floats, height_m: float, width_m: float) -> Floats:
    joined = np.full(points_m.shape[:-1], np.inf)
    for solid in _solids(height_m, width_m):
        distance = solid.distance_m(points_m)
        blend = np.maximum(BLEND_M - np.abs(joined - distance), 0) / BLEND_M
        joined = np.minimum(joined, distance) - 0.25 * BLEND_M * blend**2
    return joined


def _solids(tall: float, width: float) -> list[_Limb | _Ellipsoid]:
    """Return the body's parts, (forward, right, height); the joints' heights are the source's."""
    half = width / 2
    solids: list[_Limb | _Ellipsoid] = [
        _Ellipsoid(centre_m=(0.01, 0, 0.935 * tall), half_m=(0.097, 0.077, 0.065 * tall)),
        _Limb(start_m=(0, 0, 0.80 * tall), end_m=(0, 0, 0.90 * tall), radii_m=(0.06, 0.055)),
        _Ellipsoid(centre_m=(0, 0, 0.72 * tall), half_m=(0.115, 0.75 * half, 0.10 * tall)),
        _Ellipsoid(centre_m=(0, 0, 0.61 * tall), half_m=(0.10, 0.65 * half, 0.10 * tall)),
        _Ellipsoid(centre_m=(-0.01, 0, 0.53 * tall), half_m=(0.115, 0.75 * half, 0.07 * tall)),
    ]
    for side in (-1, 1):
        hip, knee, ankle = (
            (0.0, side * 0.41 * half, 0.50 * tall),
            (0.01, side * 0.43 * half, 0.285 * tall),
            (-0.02, side * 0.45 * half, 0.045 * tall),
        )
        shoulder, elbow, wrist, tip = (
            (0.0, side * 0.74 * half, 0.80 * tall),
            (-0.01, side * 0.98 * half, 0.63 * tall),
            (0.03, side * 1.06 * half, 0.485 * tall),
            (0.05, side * 1.08 * half, 0.40 * tall),
        )
        inner, toe = (0.0, side * 0.4 * half, 0.79 * tall), (0.15, side * 0.55 * half, 0.028)
        solids += [
            _Limb(start_m=inner, end_m=shoulder, radii_m=(0.07, 0.06)),
            _Limb(start_m=shoulder, end_m=elbow, radii_m=(0.048, 0.04)),
            _Limb(start_m=elbow, end_m=wrist, radii_m=(0.04, 0.028)),
            _Limb(start_m=wrist, end_m=tip, radii_m=(0.03, 0.03)),
            _Limb(start_m=hip, end_m=knee, radii_m=(0.085, 0.056)),
            _Limb(start_m=knee, end_m=ankle, radii_m=(0.056, 0.04)),
            _Limb(start_m=(-0.05, ankle[1], 0.035), end_m=toe, radii_m=(0.036, 0.03)),
        ]
    return solids


def _to_size(vertices_m: Floats, height_m: float, width_m: float) -> Floats:
    """Return the vertices stretched by the per cents that blending and the grid have moved them."""
    sized = vertices_m.copy()
    sized[:, 2] -= sized[:, 2].min()
    sized[:, 2] *= height_m / sized[:, 2].max()
    share = sized[:, 2] / height_m
    band = sized[(share >= SHOULDER_BAND[0]) & (share <= SHOULDER_BAND[1])]
    sized[:, 1] *= width_m / np.ptp(band[:, 1])
    return sized


def _knife(
    body: trimesh.Trimesh, height_m: float, length_m: float
) -> tuple[tuple[trimesh.Trimesh, trimesh.Trimesh], Floats]:
    """Return a blade and its handle, before the waist and slanting down to the right."""
    slant = np.deg2rad(35.0)
    handle_m, overlap_m = 0.44 * length_m, 0.02
    blade = trimesh.creation.box(extents=(0.006, length_m - handle_m + overlap_m, 0.032))
    blade.apply_translation([0, 0.5 * (handle_m - overlap_m), 0])
    handle = trimesh.creation.box(extents=(0.02, handle_m, 0.028))
    handle.apply_translation([0, 0.5 * (handle_m - length_m), 0])
    centre = np.array([0.0, 0.03, height_m * (0.5 - WAIST)])
    reach = np.abs(body.vertices[:, 1:] - centre[1:])
    near = body.vertices[(reach[:, 0] < 0.1) & (reach[:, 1] < 0.07)]
    centre[0] = near[:, 0].max() + 0.012
    for part in (blade, handle):
        part.apply_transform(trimesh.transformations.rotation_matrix(slant, [1, 0, 0]))
        part.apply_translation(centre)
    return (blade, handle), np.array([0.0, np.cos(slant), np.sin(slant)])
