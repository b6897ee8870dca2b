"""What a measurement looks like in space: lines, ends, arrows, a tinted support and its label."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from app.dimension_lines import step_aside_m
from app.layers import ATTITUDE_COLOUR, LENGTH_COLOUR, SECTION_COLOUR, STALE_COLOUR, Colour
from app.measured_items import Item
from app.picking import hull_size_m
from app.surface_node import lifted
from core.arrays import Floats
from core.hull.closed_mesh import Surface
from core.measurement import specs
from core.measurement.parts import surface_of_faces
from core.measurement.results import Measurement

BALL_SHARE = 0.01
SHAFT_SHARE = 0.003
STICK_OUT_SHARE = 0.1
LIFT_SHARE = 0.002
"""Radius of an end, radius of an arrow, how far an axis sticks out of the hull, and how far tinted
faces are lifted off it, in sizes of the hull."""


LabelAnchor = Literal["bottom-center", "center-left", "top-right"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Lines:
    """Straight lines (n, 2, 3) in metres."""

    points_m: Floats
    colour: Colour
    width_px: float = 3.0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class End:
    """A ball at a place (3,); `number` of the anchor that it can be dragged for."""

    place_m: Floats
    radius_m: float
    colour: Colour
    number: int


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Arrows:
    """Arrows (n, 2, 3) from tail to tip, in metres."""

    points_m: Floats
    radius_m: float
    colour: Colour


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Label:
    """Text at a place (3,), and which point of its frame lies there."""

    text: str
    place_m: Floats
    anchor: LabelAnchor = "bottom-center"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Tint:
    """Faces of the hull in another colour."""

    surface: Surface
    colour: Colour


Shape = Lines | End | Arrows | Label | Tint


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ShownHull:
    """The hull on show.

    Attributes:
        surface: whole, as it is measured.
        revision: of the hull.
        is_preview: whether it shows an outline that is not kept.
    """

    surface: Surface
    revision: int
    is_preview: bool = False


def shapes_of(item: Item, hull: ShownHull) -> dict[str, Shape]:
    """Return what to draw of a measurement, by names; nothing where it is hidden or lost.

    Args:
        item: the measurement.
        hull: on show; what belongs to another revision is grey, and its label says which.
    """
    found = item.result
    if item.is_hidden or not isinstance(found, Measurement) or hull.surface.is_empty:
        return {}
    make = _SHAPES.get(type(item.spec))
    if make is None:
        return {}
    job = _Job(found=found, hull=hull, size_m=hull_size_m(hull.surface))
    # A length that no view constrains must not be read as a plain number.
    is_number = item.observability != "unobserved"
    text = f"{found.name} {value_text(found) if is_number else 'unobserved'}"
    shapes, place_m = make(job)
    # Where a length, an axis and a section meet, their labels lie side by side.
    anchor = _ANCHORS.get(make, "bottom-center")
    return {**shapes, "label": Label(text=text + job.stamp, place_m=place_m, anchor=anchor)}


def value_text(found: Measurement) -> str:
    """Return a value as people read it."""
    if found.unit == "rad":
        return f"{np.degrees(found.value):.1f}°"
    digits = 3 if not found.unit else 2
    return f"{found.value:.{digits}f} {found.unit}".rstrip()


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Job:
    found: Measurement
    hull: ShownHull
    size_m: float

    @property
    def is_stale(self) -> bool:
        return self.hull.is_preview or self.found.revision != self.hull.revision

    @property
    def stamp(self) -> str:
        return f" (revision {self.found.revision})" if self.is_stale else ""

    def coloured(self, colour: Colour) -> Colour:
        return STALE_COLOUR if self.is_stale else colour


_Drawing = tuple[dict[str, Shape], Floats]
"""Shapes by name, and where the label goes."""


def _length(job: _Job) -> _Drawing:
    start, end = job.found.points_m
    step = step_aside_m(job.hull.surface, start, end)
    lines = [np.array([start + step, end + step])]
    if step.any():
        lines += [np.array([start, start + 1.1 * step]), np.array([end, end + 1.1 * step])]
    return _with_ends(job, np.array(lines), (start + end) / 2 + step)


def _polyline(job: _Job) -> _Drawing:
    points = job.found.points_m
    lines = np.stack([points[:-1], points[1:]], axis=1)
    longest = int(np.argmax(np.linalg.norm(lines[:, 1] - lines[:, 0], axis=1)))
    return _with_ends(job, lines, lines[longest].mean(axis=0))


def _with_ends(job: _Job, lines: Floats, label_m: Floats) -> _Drawing:
    colour = job.coloured(LENGTH_COLOUR)
    shapes: dict[str, Shape] = {"lines": Lines(points_m=lines, colour=colour)}
    for number, place in enumerate(job.found.points_m):
        radius_m = BALL_SHARE * job.size_m
        ball = End(place_m=place, radius_m=radius_m, colour=colour, number=number)
        shapes[f"end-{number}"] = ball
    return shapes, label_m


def _normal(job: _Job) -> _Drawing:
    assert job.found.direction is not None
    tail = job.found.points_m.mean(axis=0)
    tip = tail + 1.5 * STICK_OUT_SHARE * job.size_m * job.found.direction
    shapes = {**_support(job), "arrows": _arrows(job, np.array([[tail, tip]]))}
    if len(job.found.points_m) == 3:
        corners = job.found.points_m
        triangle = np.stack([corners, np.roll(corners, -1, axis=0)], axis=1)
        shapes["lines"] = Lines(points_m=triangle, colour=job.coloured(ATTITUDE_COLOUR))
    return shapes, tip


def _axis(job: _Job) -> _Drawing:
    """Draw a fitted axis from its middle to both sides, out of the hull."""
    assert job.found.direction is not None
    lower, upper = job.found.points_m[[0, -1]]
    out = STICK_OUT_SHARE * job.size_m * job.found.direction
    middle = (lower + upper) / 2
    arrows = np.array([[middle, upper + out], [middle, lower - out]])
    return {**_support(job), "arrows": _arrows(job, arrows)}, upper + out


def _body_axes(job: _Job) -> _Drawing:
    centre = job.found.points_m[0]
    reach = job.found.sizes_m / 2 + STICK_OUT_SHARE * job.size_m
    ways = reach[:, None] * job.found.axes
    tips = np.concatenate([centre + ways, centre - ways])
    arrows = np.stack([np.broadcast_to(centre, tips.shape), tips], axis=1)
    return {"arrows": _arrows(job, arrows)}, tips[0]


def _box(job: _Job) -> _Drawing:
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    corners = job.found.points_m[0] + signs / 2 * job.found.sizes_m @ job.found.axes
    edges = [(i, j) for i in range(8) for j in range(i) if np.sum(signs[i] != signs[j]) == 1]
    lines = Lines(points_m=corners[edges], colour=job.coloured(LENGTH_COLOUR), width_px=1.5)
    return {"lines": lines}, corners[int(np.argmin(corners[:, 2]))]


def _section(job: _Job) -> _Drawing:
    curves = job.found.curves_m
    lines = [np.stack([curve, np.roll(curve, -1, axis=0)], axis=1) for curve in curves]
    colour = job.coloured(SECTION_COLOUR)
    points = np.concatenate(curves)
    # Nadir is down, so the highest point has the least z.
    highest = points[int(np.argmin(points[:, 2]))]
    return {"lines": Lines(points_m=np.concatenate(lines), colour=colour)}, highest


def _area(job: _Job) -> _Drawing:
    shapes = _support(job)
    tint = shapes.get("support")
    middle = tint.surface.vertices_m.mean(axis=0) if isinstance(tint, Tint) else np.zeros(3)
    return shapes, middle


def _arrows(job: _Job, points_m: Floats) -> Arrows:
    colour = job.coloured(ATTITUDE_COLOUR)
    return Arrows(points_m=points_m, radius_m=SHAFT_SHARE * job.size_m, colour=colour)


def _support(job: _Job) -> dict[str, Shape]:
    """Return the faces that a fit rests on; those of another hull have other numbers."""
    support, surface = job.found.support, job.hull.surface
    if support is None or job.is_stale or len(support) in (0, len(surface.faces)):
        return {}
    faces = surface_of_faces(surface, support)
    tinted = lifted(faces, LIFT_SHARE * job.size_m)
    return {"support": Tint(surface=tinted, colour=ATTITUDE_COLOUR)}


_SHAPES: Mapping[type, Callable[[_Job], _Drawing]] = {
    specs.Length: _length,
    specs.LineFeature: _length,
    specs.Polyline: _polyline,
    specs.PlaneNormal: _normal,
    specs.PlaneThrough: _normal,
    specs.LineAxis: _axis,
    specs.CylinderAxis: _axis,
    specs.PrincipalAxes: _body_axes,
    specs.BoundingBox: _box,
    specs.OrientedBox: _box,
    specs.Section: _section,
    specs.Area: _area,
}
"""What can be drawn; volumes, angles and scale factors are told by the table alone."""

_ANCHORS: Mapping[Callable[[_Job], _Drawing], LabelAnchor] = {
    _normal: "center-left",
    _axis: "center-left",
    _body_axes: "center-left",
    _section: "top-right",
}
