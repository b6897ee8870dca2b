"""What can be measured: each a plain description that any later hull can be measured by."""

import unicodedata
from dataclasses import dataclass, field

import numpy as np

from core.arrays import Floats
from core.measurement.anchors import Anchor, Point, freeze_direction
from core.measurement.regions import ConnectedPart, Region, WholeSurface

MAX_NAME = 200
MAX_NOTE = 10_000


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Named:
    """What every measurement has.

    Attributes:
        name: what a person calls it; unique among the measurements of a hull.
        note: free text.
    """

    name: str
    note: str = ""

    def __post_init__(self) -> None:
        _check_text(self.name, "name", MAX_NAME)
        _check_text(self.note, "note", MAX_NOTE, allowed="\n\t")
        if not self.name.strip():
            raise ValueError("A measurement needs a name; got an empty one.")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Length(_Named):
    """The distance between two anchors, directed from the first to the second."""

    start: Anchor
    end: Anchor


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LineFeature(_Named):
    """A straight feature of the target between its two ends, an undirected line.

    Source: the paper's l₁, l₂, l₃; `scale_factors` gives its b = lᵢ/lⱼ.
    """

    start: Anchor
    end: Anchor


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Polyline(_Named):
    """The length of a chain of straight lines from anchor to anchor, two or more."""

    anchors: tuple[Anchor, ...]

    def __post_init__(self) -> None:
        _Named.__post_init__(self)
        if len(self.anchors) < 2:
            raise ValueError(
                f'Polyline "{self.name}" needs at least 2 anchors, got {len(self.anchors)}.'
            )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ScaleFactor(_Named):
    """The quotient b of two measured lengths, each by its measurement's name."""

    first: str
    second: str


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LineAxis(_Named):
    """The axis of a line fitted to a region."""

    region: Region


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class CylinderAxis(_Named):
    """The axis and the diameter of a cylinder fitted to a region."""

    region: Region


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PlaneNormal(_Named):
    """The normal of a plane fitted to a region."""

    region: Region


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PlaneThrough(_Named):
    """The normal of the plane through three anchors, which run counter-clockwise about it."""

    anchors: tuple[Anchor, Anchor, Anchor]

    def __post_init__(self) -> None:
        _Named.__post_init__(self)
        if len(self.anchors) != 3:
            raise ValueError(
                f'Plane "{self.name}" goes through 3 anchors, got {len(self.anchors)}.'
            )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _OfBody(_Named):
    """What is measured of a closed body.

    Attributes:
        region: all of the surface, or one connected part.
    """

    region: WholeSurface | ConnectedPart = field(default_factory=WholeSurface)

    def __post_init__(self) -> None:
        _Named.__post_init__(self)
        if not isinstance(self.region, WholeSurface | ConnectedPart):
            raise ValueError(
                f'{type(self).__name__} "{self.name}" is measured of the whole surface or of a '
                f"connected part, not of a {type(self.region).__name__}, which encloses nothing."
            )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PrincipalAxes(_OfBody):
    """The principal axes of inertia and the extents along them, the longest first."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class BoundingBox(_OfBody):
    """The extents along x, y and z of the target frame."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class OrientedBox(_OfBody):
    """The box of least volume around the body, its longest side first."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Volume(_OfBody):
    """The enclosed volume."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Area(_Named):
    """The area of a region of the surface."""

    region: Region = field(default_factory=WholeSurface)


def _origin() -> Point:
    return Point(point_m=np.zeros(3))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Section(_Named):
    """The closed curves in which a plane cuts the body, and the area within them.

    Attributes:
        through: an anchor in the plane.
        normal: (3,) unit vector, target frame; any length above zero is accepted.
    """

    normal: Floats
    through: Anchor = field(default_factory=_origin)

    def __post_init__(self) -> None:
        _Named.__post_init__(self)
        freeze_direction(self, "normal")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class AngleBetween(_Named):
    """The angle between the directions of two measurements, each by its name."""

    first: str
    second: str


DependentSpec = ScaleFactor | AngleBetween
"""What is computed from other measurements."""

Spec = (
    Length
    | LineFeature
    | Polyline
    | ScaleFactor
    | LineAxis
    | CylinderAxis
    | PlaneNormal
    | PlaneThrough
    | PrincipalAxes
    | BoundingBox
    | OrientedBox
    | Volume
    | Area
    | Section
    | AngleBetween
)


def check_specs(specs: tuple[Spec, ...]) -> None:
    """Refuse measurements of which two share a name, or one refers to a name that is missing.

    Raises:
        ValueError: so it is; the sentence names the measurement.
    """
    names = [spec.name for spec in specs]
    for name in names:
        if names.count(name) > 1:
            raise ValueError(
                f'{names.count(name)} measurements are called "{name}"; give each its own name.'
            )
    for spec in specs:
        if isinstance(spec, DependentSpec):
            for other in (spec.first, spec.second):
                if other not in names:
                    raise ValueError(
                        f'{type(spec).__name__} "{spec.name}" refers to "{other}", but there is '
                        "no such measurement."
                    )


def _check_text(text: str, what: str, most: int, allowed: str = "") -> None:
    if not isinstance(text, str):
        raise ValueError(f"A measurement's {what} is text, got {text!r}.")
    if any(unicodedata.category(c) in ("Cc", "Cs") and c not in allowed for c in text):
        raise ValueError(f"A measurement's {what} holds a control character: {text[:40]!r}.")
    if len(text) > most:
        raise ValueError(f"A measurement's {what} has at most {most} characters, got {len(text)}.")
