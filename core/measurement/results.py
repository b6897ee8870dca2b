"""What a measurement found, or why it found nothing."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats, frozen
from core.measurement.parts import Faces


def _no_sizes() -> Floats:
    return np.empty(0)


def _no_points() -> Floats:
    return np.empty((0, 3))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Measurement:
    """A number read off a hull, with all that it rests on.

    Attributes:
        name: of the spec that it belongs to.
        value: in `unit`.
        unit: "m", "m²", "m³", "rad", or empty for a pure number.
        direction: (3,) unit attitude vector, target frame; None where there is none.
        is_undirected: whether the sign of `direction` means nothing.
        sizes_m: (n,) lengths along `axes`, where there are several: a polyline's lines, a box's
            or a body's extents, a fitted axis' length.
        axes: (n, 3) unit vectors, target frame.
        residual_m: rms distance of what was fitted from its support, None where nothing was.
        points_m: (n, 3) to draw it by: the ends in order; a plane's, box's or body's middle.
        curves_m: of a section, each (n, 3), closed without repeating the first point.
        support: numbers of the surface's faces that a fit or a body rests on.
        revision: of the hull that it was measured on.
        threshold: votes that a voxel of that hull has at least.
    """

    name: str
    value: float
    unit: str
    direction: Floats | None = None
    is_undirected: bool = False
    sizes_m: Floats = field(default_factory=_no_sizes)
    axes: Floats = field(default_factory=_no_points)
    residual_m: float | None = None
    points_m: Floats = field(default_factory=_no_points)
    curves_m: tuple[Floats, ...] = ()
    support: Faces | None = None
    revision: int = 0
    threshold: int = 0

    def __post_init__(self) -> None:
        if not np.isfinite(self.value):
            raise ValueError(f'Measurement "{self.name}" came out as {self.value} {self.unit}.')
        if self.direction is not None:
            direction = frozen(self.direction, np.float64, (3,), f"Direction of {self.name}")
            object.__setattr__(self, "direction", direction)
        sizes = frozen(self.sizes_m, np.float64, (None,), f"Sizes of {self.name}")
        object.__setattr__(self, "sizes_m", sizes)
        axes = frozen(self.axes, np.float64, (len(sizes), 3), f"Axes of {self.name}")
        object.__setattr__(self, "axes", axes)
        points = frozen(self.points_m, np.float64, (None, 3), f"Points of {self.name}")
        object.__setattr__(self, "points_m", points)
        curves = tuple(frozen(c, np.float64, (None, 3), "Section curve") for c in self.curves_m)
        object.__setattr__(self, "curves_m", curves)
        if self.support is not None:
            support = frozen(self.support, np.int64, (None,), f"Support of {self.name}")
            object.__setattr__(self, "support", support)

    def angles_to_axes_rad(self) -> Floats | None:
        """Return the angles between the direction and x, y and z of the target frame, (3,).

        0 … π, or 0 … π/2 where the direction's sign means nothing; None without a direction.
        """
        return None if self.direction is None else angles_rad(self.direction, self.is_undirected)


@dataclass(frozen=True, slots=True, kw_only=True)
class Lost:
    """A measurement that the hull no longer allows.

    Attributes:
        name: of the spec.
        reason: a sentence that says what is missing and what to do.
        revision: of the hull that was tried.
        threshold: votes that a voxel of that hull has at least.
    """

    name: str
    reason: str
    revision: int = 0
    threshold: int = 0


def angles_rad(direction: Floats, is_undirected: bool) -> Floats:
    """Return the angles between a unit vector (3,) and the frame's three axes, (3,).

    Near the axes, where an arc cosine loses half its digits, this keeps them.
    """
    along = np.abs(direction) if is_undirected else direction
    across = np.linalg.norm(np.cross(np.eye(3), direction), axis=1)
    angles: NDArray[np.float64] = np.arctan2(across, along)
    return angles
