"""Shooting and bouncing rays: what a target returns after two and more reflections."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import trimesh
from numpy.typing import NDArray

from core.arrays import Floats
from core.radar.scatterers import SURFACE_OFFSET_M

MOST_TUBES = 20_000_000
"""Rays beyond which a grid is refused: some gigabytes."""

GRAZING_COSINE = 1e-3
"""Rays that meet a facet within 0.06° of its plane are dropped: their footprint has no bounds."""

_POLARISATION = np.array([0.0, 0.0, 1.0])
"""The field's direction, target frame, before it is made perpendicular to the line of sight."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class BouncePoints:
    """Multiple reflections as points, for all lines of sight near the one they were traced from.

    Attributes:
        position_m: (points, 3) target frame; where a single reflection would have the same path.
        amplitude: (points,) complex; its square is in m² at the wavelength traced.
        bounces: (points,) how many reflections each has behind it, 2 or more.
    """

    position_m: Floats
    amplitude: NDArray[np.complex128]
    bounces: NDArray[np.int64]


def bounce_points(
    mesh: trimesh.Trimesh,
    line_of_sight: Floats,
    *,
    wavelength_m: float,
    tube_m: float,
    most_bounces: int = 3,
    reflection: float = 1.0,
    polarisation: Floats = _POLARISATION,
) -> BouncePoints:
    """Return the echoes of all reflections from the second on.

    Square tubes of rays on a grid across the line of sight are reflected by geometrical optics.
    Wherever a tube lands, the field that it brings induces the current of physical optics, and
    that current radiates back to the radar if nothing stands between. The first landing is left
    out: its current is what `physical_optics` integrates in closed form. As each order's current
    is induced by another field, and all of them radiate, nothing counts twice.

    Unfolded at its mirrors a path is a straight line on from the first ray, and the landing point
    lies at a fixed place on it, whatever the line of sight. So the phase of a path is linear in k,
    and the path is a point halfway between the landing place and its mirror image. Only the tubes
    themselves, their weights and what is lit belong to the line of sight traced.

    Args:
        mesh: flat mirrors, seen from both sides.
        line_of_sight: (3,) unit vector from radar to target, target frame.
        wavelength_m: at which amplitudes are given; they grow with frequency.
        tube_m: side of a tube's square cross-section; smaller than the mesh's faces, and below
            λ / 2Δ if the line of sight is to turn by Δ either way.
        most_bounces: reflections to follow.
        reflection: share of the field's amplitude that a reflection keeps.
        polarisation: (3,) sent and received, target frame; its part across k counts.

    Raises:
        ValueError: no positive tube or wavelength, fewer than 2 bounces, too many tubes.

    Source: Ling, Chou and Lee, "Shooting and bouncing rays: calculating the RCS of an arbitrarily
    shaped cavity", 1989, for tubes and their shape function; the current 2 n × H of every order
    instead of an exit aperture follows Obelleiro-Basteiro, Rodriguez and Burkholder, "An iterative
    physical optics approach", 1995.
    """
    if not (wavelength_m > 0 and tube_m > 0 and most_bounces >= 2):
        raise ValueError(
            "Bouncing rays need a wavelength and tubes of positive metres and at least 2 bounces; "
            f"got {wavelength_m} m, {tube_m} m and {most_bounces}."
        )
    found = [
        _Landing.empty(),
        *_landings(
            mesh, line_of_sight, wavelength_m, tube_m, most_bounces, reflection, polarisation
        ),
    ]
    return BouncePoints(
        position_m=np.concatenate([each.position_m for each in found]),
        amplitude=np.concatenate([each.amplitude for each in found]),
        bounces=np.concatenate([np.full(len(each.amplitude), each.bounces) for each in found]),
    )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Landing:
    """What the tubes of one order return."""

    position_m: Floats
    amplitude: NDArray[np.complex128]
    bounces: int

    @staticmethod
    def empty() -> "_Landing":
        return _Landing(position_m=np.empty((0, 3)), amplitude=np.empty(0, complex), bounces=0)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Tubes:
    """Ray tubes under way, all arrays (tubes, 3) but the path, (tubes,).

    Attributes:
        origin_m: where they last left from.
        launch_m: the same just off the surface, or rays would meet their own facet.
        direction: where they go.
        field: the electric field that they carry, 1 at the start.
        across: (2, tubes, 3) sides of the tube's cross-section, metres.
        start_m: on the plane through which they set out.
        path_m: length from there on.
    """

    origin_m: Floats
    launch_m: Floats
    direction: Floats
    field: Floats
    across: Floats
    start_m: Floats
    path_m: Floats

    def taken(self, which: NDArray[np.int64]) -> "_Tubes":
        return _Tubes(
            origin_m=self.origin_m[which],
            launch_m=self.launch_m[which],
            direction=self.direction[which],
            field=self.field[which],
            across=self.across[:, which],
            start_m=self.start_m[which],
            path_m=self.path_m[which],
        )


def _landings(
    mesh: trimesh.Trimesh,
    line_of_sight: Floats,
    wavelength_m: float,
    tube_m: float,
    most_bounces: int,
    reflection: float,
    polarisation: Floats,
) -> Iterator[_Landing]:
    """Yield what each order from the second on returns, until no ray is left."""
    tubes = _grid(mesh, line_of_sight, tube_m, polarisation)
    if len(tubes.path_m) == 0:
        return
    received = tubes.field[0]
    for bounce in range(1, most_bounces + 1):
        tubes, normal = _landed(mesh, tubes)
        if len(tubes.path_m) == 0:
            return
        if bounce > 1:
            seen = _seen(mesh, tubes.launch_m, normal, line_of_sight)
            yield _Landing(
                position_m=(tubes.origin_m + tubes.start_m + tubes.path_m[:, None] * line_of_sight)[
                    seen
                ]
                / 2,
                amplitude=reflection
                * _radiated(
                    tubes.taken(seen), normal[seen], line_of_sight, received, wavelength_m, tube_m
                ),
                bounces=bounce,
            )
        tubes = _reflected(tubes, normal, reflection)


def _grid(
    mesh: trimesh.Trimesh, line_of_sight: Floats, tube_m: float, polarisation: Floats
) -> _Tubes:
    """Return tubes that cover the mesh as the radar sees it, all of the unit field."""
    field = _across(polarisation, line_of_sight)
    sides = np.stack([field, np.cross(line_of_sight, field)])
    # Turned by an angle with which no edge of a target lines up by design, so that the count of
    # tubes on a face errs at random along its edges.
    turned = np.array([[np.cos(0.6), np.sin(0.6)], [-np.sin(0.6), np.cos(0.6)]]) @ sides
    flat = mesh.vertices @ turned.T
    counts = np.ceil(np.ptp(flat, axis=0) / tube_m).astype(int) + 1
    if np.prod(counts, dtype=float) > MOST_TUBES:
        raise ValueError(
            f"Tubes of {tube_m} m on a target {np.ptp(flat, axis=0).max():.3g} m wide are "
            f"{np.prod(counts, dtype=float):.2g}, more than {MOST_TUBES:.0e}; use wider ones."
        )
    places = [
        low + tube_m * np.arange(count) for low, count in zip(flat.min(0), counts, strict=True)
    ]
    behind_m = float((mesh.vertices @ line_of_sight).min()) - 1.0
    place = np.stack(np.meshgrid(*places, indexing="ij"), axis=-1).reshape(-1, 2)
    origin = place @ turned + behind_m * line_of_sight
    shape = (len(place), 3)
    return _Tubes(
        origin_m=origin,
        launch_m=origin,
        direction=np.broadcast_to(line_of_sight, shape),
        field=np.broadcast_to(field, shape),
        across=np.broadcast_to(tube_m * turned[:, None], (2, *shape)),
        # Paths count from the plane through the target frame's origin.
        start_m=origin - behind_m * line_of_sight,
        path_m=np.full(len(place), behind_m),
    )


def _across(polarisation: Floats, line_of_sight: Floats) -> Floats:
    """Return the unit vector across the line of sight that lies nearest a polarisation."""
    for wanted in (np.asarray(polarisation, dtype=np.float64), np.array([1.0, 0.0, 0.0])):
        part = wanted - (wanted @ line_of_sight) * line_of_sight
        length = float(np.linalg.norm(part))
        if length > 1e-3:
            return part / length
    raise AssertionError("two directions cannot both lie along a third")  # pragma: no cover


def _landed(mesh: trimesh.Trimesh, tubes: _Tubes) -> tuple[_Tubes, Floats]:
    """Return the tubes that meet the mesh, at their landing, and the normals facing them there."""
    face = mesh.ray.intersects_first(tubes.launch_m, tubes.direction)
    normal: Floats = mesh.face_normals[face]
    approach = np.sum(normal * tubes.direction, axis=1)
    hit = np.flatnonzero((face >= 0) & (np.abs(approach) > GRAZING_COSINE))
    tubes, face, approach = tubes.taken(hit), face[hit], approach[hit]
    normal = -np.sign(approach)[:, None] * normal[hit]
    # The rays are traced in single precision; the plane's equation is not.
    ahead = np.sum(normal * (mesh.triangles[face, 0] - tubes.origin_m), axis=1) / -np.abs(approach)
    place = tubes.origin_m + ahead[:, None] * tubes.direction
    landed = _Tubes(
        origin_m=place,
        launch_m=place + SURFACE_OFFSET_M * normal,
        direction=tubes.direction,
        field=tubes.field,
        across=tubes.across,
        start_m=tubes.start_m,
        path_m=tubes.path_m + ahead,
    )
    return landed, normal


def _seen(
    mesh: trimesh.Trimesh, launch_m: Floats, normal: Floats, line_of_sight: Floats
) -> NDArray[np.int64]:
    """Return which places face the radar with nothing in between."""
    facing = np.flatnonzero(normal @ line_of_sight < 0)
    toward_radar = np.broadcast_to(-line_of_sight, (len(facing), 3))
    hidden = mesh.ray.intersects_any(launch_m[facing], toward_radar)
    seen: NDArray[np.int64] = facing[~hidden]
    return seen


def _radiated(
    tubes: _Tubes,
    normal: Floats,
    line_of_sight: Floats,
    received: Floats,
    wavelength_m: float,
    tube_m: float,
) -> NDArray[np.complex128]:
    """Return what the currents that landed tubes induce send back, (tubes,).

    The current 2 n × H under a plane wave along d is 2 [d (n·E) − E (n·d)] / η; its far field
    is integrated over the tube's footprint, a parallelogram, on which its phase is linear.
    """
    approach = np.sum(normal * tubes.direction, axis=1)
    current = (tubes.direction @ received) * np.sum(normal * tubes.field, axis=1)
    current = (current - (tubes.field @ received) * approach) / -approach
    wave = 2 * np.pi / wavelength_m * (tubes.direction + line_of_sight)
    for side in tubes.across:
        slide = np.sum(normal * side, axis=1) / approach
        footprint = side - slide[:, None] * tubes.direction
        current = current * np.sinc(np.sum(wave * footprint, axis=1) / (2 * np.pi))
    amplitude: NDArray[np.complex128] = (
        -1j * np.sqrt(4 * np.pi) / wavelength_m * tube_m**2 * current
    )
    return amplitude


def _reflected(tubes: _Tubes, normal: Floats, reflection: float) -> _Tubes:
    """Return tubes as they leave a mirror; the field turns over, for none is left along it."""
    return _Tubes(
        origin_m=tubes.origin_m,
        launch_m=tubes.launch_m,
        direction=_mirrored(tubes.direction, normal),
        field=-reflection * _mirrored(tubes.field, normal),
        across=_mirrored(tubes.across, normal),
        start_m=tubes.start_m,
        path_m=tubes.path_m,
    )


def _mirrored(vectors: Floats, normal: Floats) -> Floats:
    along = np.sum(vectors * normal, axis=-1, keepdims=True)
    mirrored: Floats = vectors - 2 * along * normal
    return mirrored
