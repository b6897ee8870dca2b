"""Components: parts of a target that have silhouettes, and so a hull, of their own."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from core.arrays import Floats, frozen
from core.hull.closed_mesh import Surface
from core.hull.view import View
from core.measurement.parts import BodyAxes, body_axes


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ComponentPlace:
    """Where one component's hull stands relative to the whole.

    Attributes:
        offset_m: (3,) from the whole's centroid to the component's, target frame.
        offset_along_axes_m: (3,) the same along the whole's principal axes.
        turn_rad: least angle that turns the whole's principal axes, as lines, onto the component's.
        component: its centroid, axes and extents.
        whole: those of the whole.
        volume_share: of the whole's volume.
    """

    offset_m: Floats
    offset_along_axes_m: Floats
    turn_rad: float
    component: BodyAxes
    whole: BodyAxes
    volume_share: float

    def __post_init__(self) -> None:
        for name in ("offset_m", "offset_along_axes_m"):
            object.__setattr__(self, name, frozen(getattr(self, name), np.float64, (3,), name))


def views_by_component(views: Sequence[View]) -> dict[str, tuple[View, ...]]:
    """Return the views of each component, by its silhouettes' label, in the order they first come.

    Each group carves a hull of its own.
    """
    groups: dict[str, list[View]] = {}
    for view in views:
        groups.setdefault(view.silhouette.component, []).append(view)
    return {label: tuple(group) for label, group in groups.items()}


def place_in_whole(component: Surface, whole: Surface) -> ComponentPlace:
    """Return place and attitude of a component's hull relative to the whole's.

    Args:
        component: closed hull, target frame.
        whole: closed hull, target frame.

    Raises:
        ValueError: either is empty or encloses nothing.
    """
    for surface, name in ((component, "component's"), (whole, "whole target's")):
        if surface.is_empty:
            raise ValueError(f"The {name} hull is empty, so it has no place; check its outlines.")
    part, body = body_axes(component), body_axes(whole)
    offset_m = part.centroid_m - body.centroid_m
    return ComponentPlace(
        offset_m=offset_m,
        offset_along_axes_m=body.axes @ offset_m,
        turn_rad=_least_turn_rad(body.axes, part.axes),
        component=part,
        whole=body,
        volume_share=component.volume_m3() / whole.volume_m3(),
    )


def _least_turn_rad(first: Floats, second: Floats) -> float:
    """Return the least turn between right-handed axes (rows) whose signs mean nothing."""
    flips = [np.diag(signs) for signs in ((1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1))]
    return float(min(Rotation.from_matrix((flip @ second).T @ first).magnitude() for flip in flips))
