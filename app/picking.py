"""Picks on the hull: from a ray through the view to an anchor, and from anchors to a measurement.

A pick on the plain surface becomes a `SurfacePoint`, not a `PickRay`. When a silhouette changes
the surface moves by little, and its point nearest to the old one moves by about as much; a ray that
grazed an edge misses the new hull, or falls through to its far side, metres away.
"""

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Literal, get_args

import numpy as np

from core.arrays import Floats, frozen
from core.hull.closed_mesh import Surface
from core.measurement.anchors import (
    Anchor,
    AnchorLost,
    Extreme,
    PartEnd,
    SurfacePoint,
    place_text,
    resolve,
)
from core.measurement.measures import LEAST_LENGTH_M
from core.measurement.parts import BodyAxes, body_axes, part_labels, surface_of_faces
from core.measurement.picking import nearest_point_m
from core.measurement.regions import ConnectedPart, Patch
from core.measurement.specs import (
    CylinderAxis,
    Length,
    LineFeature,
    PlaneNormal,
    Polyline,
    PrincipalAxes,
    Section,
    Spec,
)
from core.measurement.triangles import first_hit

Kind = Literal[
    "length",
    "polyline",
    "line feature",
    "plane normal",
    "cylinder axis",
    "principal axes",
    "section",
]
Snap = Literal["surface", "extreme", "part end"]

KINDS: tuple[Kind, ...] = get_args(Kind)
SNAPS: tuple[Snap, ...] = get_args(Snap)

EXTREME_SHARE = 0.1
"""Radius in which an extreme is searched, in sizes of the hull."""

REACH_SHARE = 0.1
"""How far the surface may move from a pick before its anchor is lost, in sizes of the hull."""

CYLINDER_SHARE = 0.2
"""Radius of the patch that a cylinder is fitted to, in sizes of the hull."""

MOST_PREPARED = 8
"""Parts whose axes are found beforehand, the largest first."""

PLANE_ANGLE_RAD = 0.3
CYLINDER_ANGLE_RAD = 0.2
"""Between a face and the picked one, and between neighbours, within which a patch goes on."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Ray:
    """A ray through a picture of the hull.

    Attributes:
        origin_m: (3,) where the camera stands, target frame.
        direction: (3,) target frame, of any length above zero.
    """

    origin_m: Floats
    direction: Floats

    def __post_init__(self) -> None:
        for name in ("origin_m", "direction"):
            value = frozen(getattr(self, name), np.float64, (3,), f"A ray's {name}")
            object.__setattr__(self, name, value)
        if not np.linalg.norm(self.direction) > 0:
            raise ValueError("A ray's direction must have a length above zero.")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Pick:
    """A picked place.

    Attributes:
        anchor: by which it is found on every later hull.
        place_m: (3,) where it lies on this one, target frame.
    """

    anchor: Anchor
    place_m: Floats


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Picking:
    """What somebody is about to measure, and what has been picked for it.

    Attributes:
        kind: of measurement.
        snap: what a click snaps to.
        picks: so far, oldest first.
        complaint: a sentence about the last click, empty where there is nothing to say.
    """

    kind: Kind
    snap: Snap = "surface"
    picks: tuple[Pick, ...] = ()
    complaint: str = ""

    @property
    def is_at_point(self) -> bool:
        """Whether its picks are points, which snap, and not faces or parts."""
        return self.kind in ("length", "polyline", "line feature", "section")

    @property
    def is_complete(self) -> bool:
        """Whether the picks make the measurement; a polyline has to be ended."""
        return len(self.picks) == _ENOUGH[self.kind]

    def with_pick(self, pick: Pick) -> "Picking":
        """Return it with one more pick, or with a complaint where that is the last one again."""
        if self.picks and _distance_m(self.picks[-1], pick) < LEAST_LENGTH_M:
            return replace(
                self,
                complaint=f"That is the same point again, {place_text(pick.place_m)}, so there is "
                "no line between the two; click another one.",
            )
        return replace(self, picks=(*self.picks, pick), complaint="")


def _distance_m(one: Pick, other: Pick) -> float:
    return float(np.linalg.norm(one.place_m - other.place_m))


_ENOUGH: Mapping[Kind, int | None] = {
    "length": 2,
    "polyline": None,
    "line feature": 2,
    "plane normal": 1,
    "cylinder axis": 1,
    "principal axes": 1,
    "section": 1,
}


@lru_cache(maxsize=4)
def hull_size_m(surface: Surface) -> float:
    """Return the longest side of the box around a surface that is not empty."""
    return max(float(np.ptp(column)) for column in surface.vertices_m.T)


def pick_on(surface: Surface | None, ray: Ray, snap: Snap) -> Pick:
    """Return what a ray picks.

    "surface" is where the ray first meets it. "extreme" is the surface point that lies farthest
    out within a radius of there, outward being from the centroid of the connected part through the
    place met; the radius is `EXTREME_SHARE` of the hull's size. "part end" is the end of a
    principal axis of the part that is nearest to the place met.

    Raises:
        ValueError: there is no hull, the ray misses it, or nothing is there to snap to.
    """
    if surface is None or surface.is_empty:
        raise ValueError("There is no hull yet, so there is nothing to pick.")
    unit = ray.direction / np.linalg.norm(ray.direction)
    distance_m, face = first_hit(surface.vertices_m, surface.faces, ray.origin_m, unit)
    if face < 0:
        raise ValueError("There is no hull under the pointer; click on its surface.")
    return _PICKS[snap](surface, ray.origin_m + distance_m * unit, int(face))


def surface_anchor(surface: Surface, place_m: Floats) -> SurfacePoint:
    """Return the anchor of a place (3,) on the surface itself."""
    return SurfacePoint(near_m=place_m, reach_m=REACH_SHARE * hull_size_m(surface))


def _surface_pick(surface: Surface, place_m: Floats, _: int) -> Pick:
    return Pick(anchor=surface_anchor(surface, place_m), place_m=place_m)


def _extreme_pick(surface: Surface, place_m: Floats, face: int) -> Pick:
    anchor = Extreme(
        near_m=place_m,
        direction=place_m - _body_of(surface, face).centroid_m,
        radius_m=EXTREME_SHARE * hull_size_m(surface),
    )
    found = resolve(anchor, surface)
    if isinstance(found, AnchorLost):
        raise ValueError(found.reason)
    return Pick(anchor=anchor, place_m=found)


def _end_pick(surface: Surface, place_m: Floats, face: int) -> Pick:
    body = _body_of(surface, face)
    ways = np.concatenate([body.axes, -body.axes])
    ends = body.centroid_m + np.concatenate([body.upper_m, -body.lower_m])[:, None] * ways
    nearest = int(np.argmin(np.linalg.norm(ends - place_m, axis=1)))
    reach_m = REACH_SHARE * hull_size_m(surface)
    anchor = PartEnd(near_m=place_m, toward=ways[nearest], reach_m=reach_m)
    return Pick(anchor=anchor, place_m=ends[nearest])


_PICKS: Mapping[Snap, Callable[[Surface, Floats, int], Pick]] = {
    "surface": _surface_pick,
    "extreme": _extreme_pick,
    "part end": _end_pick,
}


def prepare(surface: Surface) -> None:
    """Find the parts of a surface and their axes, which a click on a new hull would wait for."""
    hull_size_m(surface)
    labels, sizes = np.unique(part_labels(surface), return_counts=True)
    for label in labels[np.argsort(-sizes)][:MOST_PREPARED]:
        with suppress(ValueError):  # it encloses nothing
            _body(surface, int(label))


def body_at(surface: Surface, place_m: Floats) -> BodyAxes:
    """Return centroid and axes of the connected part that a place (3,) lies on.

    Raises:
        ValueError: the part encloses nothing.
    """
    return _body_of(surface, nearest_point_m(surface, place_m)[1])


def _body_of(surface: Surface, face: int) -> BodyAxes:
    return _body(surface, int(part_labels(surface)[face]))


@lru_cache(maxsize=4 * MOST_PREPARED)
def _body(surface: Surface, label: int) -> BodyAxes:
    faces = np.flatnonzero(part_labels(surface) == label)
    return body_axes(surface_of_faces(surface, faces))


def spec_of(picking: Picking, name: str, surface: Surface) -> Spec:
    """Return the measurement that complete picks make on a surface.

    A section lies across the longest principal axis of the part that was picked.

    Raises:
        ValueError: too few picks for a polyline, or a part that encloses nothing.
    """
    anchors = tuple(pick.anchor for pick in picking.picks)
    if picking.kind == "polyline":
        if len(anchors) < 2:
            raise ValueError("A polyline needs at least two points; click another one, then Enter.")
        return Polyline(name=name, anchors=anchors)
    if picking.kind in ("length", "line feature"):
        start, end = anchors
        make = Length if picking.kind == "length" else LineFeature
        return make(name=name, start=start, end=end)
    return _one_pick_spec(picking.kind, name, picking.picks[0], surface)


def _one_pick_spec(kind: Kind, name: str, pick: Pick, surface: Surface) -> Spec:
    size_m, near_m = hull_size_m(surface), pick.place_m
    reach_m = REACH_SHARE * size_m
    if kind == "section":
        normal = body_at(surface, near_m).axes[0]
        return Section(name=name, normal=normal, through=pick.anchor)
    if kind == "principal axes":
        return PrincipalAxes(name=name, region=ConnectedPart(near_m=near_m, reach_m=reach_m))
    if kind == "plane normal":
        flat = Patch(near_m=near_m, angle_rad=PLANE_ANGLE_RAD, reach_m=reach_m)
        return PlaneNormal(name=name, region=flat)
    side = Patch(
        near_m=near_m,
        angle_rad=CYLINDER_ANGLE_RAD,
        growth="smooth",
        reach_m=reach_m,
        radius_m=CYLINDER_SHARE * size_m,
    )
    return CylinderAxis(name=name, region=side)
