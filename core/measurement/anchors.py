"""Anchors: points that are found again on every new hull, never vertex numbers."""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from core.arrays import Floats, frozen
from core.hull.closed_mesh import Surface
from core.measurement.parts import body_axes, part_at
from core.measurement.picking import first_hit_m, nearest_point_m, points_within_m

NO_KEY_POINTS: Mapping[str, Floats] = MappingProxyType({})


@dataclass(frozen=True, slots=True, kw_only=True)
class AnchorLost:
    """An anchor that the surface does not have.

    Attributes:
        reason: a sentence that says what was looked for and what to do.
    """

    reason: str


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Point:
    """A fixed point that follows no surface.

    Attributes:
        point_m: (3,) target frame.
    """

    point_m: Floats

    def __post_init__(self) -> None:
        freeze_points(self, "point_m")


@dataclass(frozen=True, slots=True, kw_only=True)
class KeyPoint:
    """A corner marked in two or more frames, by its name.

    Attributes:
        name: under which the context holds its place.
    """

    name: str


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PickRay:
    """Where a ray first meets the surface.

    Attributes:
        origin_m: (3,) where the ray starts, target frame.
        direction: (3,) unit vector, target frame; any length above zero is accepted.
    """

    origin_m: Floats
    direction: Floats

    def __post_init__(self) -> None:
        freeze_points(self, "origin_m")
        freeze_direction(self, "direction")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SurfacePoint:
    """The point of the surface nearest to a given one.

    Attributes:
        near_m: (3,) target frame.
        reach_m: from further away the surface no longer counts as what was picked.
    """

    near_m: Floats
    reach_m: float = 1.0

    def __post_init__(self) -> None:
        freeze_points(self, "near_m")
        check_length(self, "reach_m")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Extreme:
    """The farthest point of the surface along a direction, within a radius of a point.

    Along the direction it is exact. Across it an edge or a flat end leaves the farthest point
    open, and the least noise moves it from one corner to the other; `cap_m` settles it.

    Attributes:
        near_m: (3,) centre of the ball that is searched, target frame.
        direction: (3,) unit vector, target frame; any length above zero is accepted.
        radius_m: of the ball.
        cap_m: depth of the cap below the farthest point, whose middle is then the point's place
            across the direction; 0 for the farthest point itself.
    """

    near_m: Floats
    direction: Floats
    radius_m: float
    cap_m: float = 0.0

    def __post_init__(self) -> None:
        freeze_points(self, "near_m")
        freeze_direction(self, "direction")
        check_length(self, "radius_m")
        check_length(self, "cap_m", least=0.0)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PartEnd:
    """An end of a principal axis of the connected part nearest to a point.

    It lies on the axis through the part's centroid, in the plane that touches the part there, so
    that two opposite ends are apart by the part's extent, along its axis.

    Attributes:
        near_m: (3,) target frame; the part nearest to it is meant.
        toward: (3,) picks the axis most nearly along it, and the end on its side.
        reach_m: from further away no part counts as what was picked.
    """

    near_m: Floats
    toward: Floats
    reach_m: float = 1.0

    def __post_init__(self) -> None:
        freeze_points(self, "near_m")
        freeze_direction(self, "toward")
        check_length(self, "reach_m")


Anchor = Point | KeyPoint | PickRay | SurfacePoint | Extreme | PartEnd


def resolve(
    anchor: Anchor, surface: Surface, key_points: Mapping[str, Floats] = NO_KEY_POINTS
) -> Floats | AnchorLost:
    """Return the (3,) place of an anchor on a surface, target frame, or why it has none.

    Args:
        anchor: what to find.
        surface: where to find it.
        key_points: (3,) places by name, target frame.
    """
    if isinstance(anchor, Point):
        return anchor.point_m
    if isinstance(anchor, KeyPoint):
        return _key_point(anchor, key_points)
    if surface.is_empty:
        return AnchorLost(reason="The hull is empty, so nothing can be picked on it.")
    if isinstance(anchor, PickRay):
        return _ray_hit(anchor, surface)
    return _extreme(anchor, surface) if isinstance(anchor, Extreme) else _nearby(anchor, surface)


def _nearby(anchor: SurfacePoint | PartEnd, surface: Surface) -> Floats | AnchorLost:
    found = nearest_within(surface, anchor.near_m, anchor.reach_m)
    if isinstance(found, AnchorLost):
        return found
    place, face = found
    return place if isinstance(anchor, SurfacePoint) else _part_end(anchor, surface, face)


def nearest_within(
    surface: Surface, near_m: Floats, reach_m: float
) -> tuple[Floats, int] | AnchorLost:
    """Return the nearest point of a surface and its face, or that none is within reach."""
    place, face = nearest_point_m(surface, near_m)
    distance_m = float(np.linalg.norm(place - near_m))
    if distance_m > reach_m:
        return AnchorLost(
            reason=f"The hull has no surface within {reach_m:g} m of {place_text(near_m)}; the "
            f"nearest is {distance_m:.2f} m away. What was picked there is gone: pick it again."
        )
    return place, face


def _key_point(anchor: KeyPoint, key_points: Mapping[str, Floats]) -> Floats | AnchorLost:
    if anchor.name not in key_points:
        return AnchorLost(
            reason=f'There is no key point "{anchor.name}"; mark it in two or more frames.'
        )
    return np.asarray(key_points[anchor.name], dtype=np.float64)


def _ray_hit(anchor: PickRay, surface: Surface) -> Floats | AnchorLost:
    place = first_hit_m(surface, anchor.origin_m, anchor.direction)
    if place is None:
        return AnchorLost(
            reason=f"The ray from {place_text(anchor.origin_m)} along "
            f"{direction_text(anchor.direction)} does not meet the hull; pick a point on it."
        )
    return place


def _extreme(anchor: Extreme, surface: Surface) -> Floats | AnchorLost:
    points = points_within_m(surface, anchor.near_m, anchor.radius_m)
    if not len(points):
        return AnchorLost(
            reason=f"The hull has no surface within {anchor.radius_m:g} m of "
            f"{place_text(anchor.near_m)}, so it has no extreme there; pick it again or search "
            "a larger radius."
        )
    along = points @ anchor.direction
    farthest = points[int(np.argmax(along))]
    if anchor.cap_m == 0:
        return np.array(farthest)
    cap = points[along >= along.max() - anchor.cap_m]
    middle = _middle(cap, anchor.direction)
    place: Floats = middle + (farthest - middle) @ anchor.direction * anchor.direction
    return place


def _middle(points: Floats, direction: Floats) -> Floats:
    """Return the middle of what points span across a direction: of their least box there."""
    across = points - np.outer(points @ direction, direction)
    mean = across.mean(axis=0)
    _, _, axes = np.linalg.svd(across - mean, full_matrices=False)
    reach = (across - mean) @ axes.T
    middle: Floats = mean + (reach.min(axis=0) + reach.max(axis=0)) / 2 @ axes
    return middle


def _part_end(anchor: PartEnd, surface: Surface, face: int) -> Floats | AnchorLost:
    body = body_axes(part_at(surface, face))
    cosines = body.axes @ anchor.toward
    axis = int(np.argmax(np.abs(cosines)))
    reach = body.upper_m[axis] if cosines[axis] >= 0 else body.lower_m[axis]
    place: Floats = body.centroid_m + reach * body.axes[axis]
    return place


def freeze_points(owner: object, *names: str) -> None:
    """Freeze fields of a frozen dataclass that are points (3,) in metres."""
    for name in names:
        value = frozen(getattr(owner, name), np.float64, (3,), f"{_called(owner)} {name}")
        object.__setattr__(owner, name, value)


def freeze_direction(owner: object, name: str) -> None:
    """Freeze a field of a frozen dataclass that is a direction, as a unit vector (3,)."""
    vector = frozen(getattr(owner, name), np.float64, (3,), f"{_called(owner)} {name}")
    length = float(np.linalg.norm(vector))
    if not length > 0:
        raise ValueError(f"{_called(owner)} {name} must have a length above zero, got {vector}.")
    # What is a unit vector already keeps its digits, so that files come back unchanged.
    if abs(length - 1) > 1e-15:
        vector = frozen(vector / length, np.float64, (3,), name)
    object.__setattr__(owner, name, vector)


def check_length(owner: object, name: str, *, least: float | None = None) -> None:
    """Refuse a field of a dataclass that is no length in metres: above zero, or from `least` on."""
    value = float(getattr(owner, name))
    object.__setattr__(owner, name, value)
    fits = np.isfinite(value) and (value > 0 if least is None else value >= least)
    if not fits:
        wanted = "above zero" if least is None else f"of at least {least:g} m"
        raise ValueError(f"{_called(owner)} {name} must be a length {wanted}, got {value} m.")


def _called(owner: object) -> str:
    return f"{type(owner).__name__}'s"


def place_text(point_m: Floats) -> str:
    """Return a point as people read it."""
    return "({:.2f}, {:.2f}, {:.2f}) m".format(*point_m)


def direction_text(direction: Floats) -> str:
    """Return a direction as people read it."""
    return "({:.3f}, {:.3f}, {:.3f})".format(*direction)
