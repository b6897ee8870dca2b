"""Targets for simulation: meshes with the truth about their size and attitude."""

from dataclasses import dataclass

import numpy as np
import trimesh
from numpy.typing import NDArray

from core.arrays import Floats, frozen
from core.geometry.grid import VoxelGrid


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LineFeature:
    """A straight feature of a target whose length and attitude are known.

    Attributes:
        name: what a person calls it.
        length_m: true length.
        direction: (3,) unit attitude vector, target frame; its sign means nothing.
    """

    name: str
    length_m: float
    direction: Floats

    def __post_init__(self) -> None:
        direction = frozen(self.direction, np.float64, (3,), f"Direction of {self.name}")
        object.__setattr__(
            self,
            "direction",
            frozen(direction / np.linalg.norm(direction), np.float64, (3,), self.name),
        )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Target:
    """A body made of closed parts, in the target frame.

    Attributes:
        name: what a person calls it.
        parts: closed meshes in metres; they may overlap.
        features: true line features, empty where unknown.
    """

    name: str
    parts: tuple[trimesh.Trimesh, ...]
    features: tuple[LineFeature, ...] = ()

    def mesh(self) -> trimesh.Trimesh:
        """Return all parts as one mesh, inner faces of overlaps included."""
        return trimesh.util.concatenate(list(self.parts))

    def voxels(self, grid: VoxelGrid) -> NDArray[np.bool_]:
        """Return which voxel centres lie inside a part, (nx, ny, nz): the truth to compare with.

        Raises:
            ValueError: a part is not closed, so that inside has no meaning.
        """
        inside = np.zeros(grid.shape, dtype=bool)
        for number, part in enumerate(self.parts):
            if not part.is_watertight:
                raise ValueError(
                    f"Part {number} of {self.name} is not closed, so that it has no inside; "
                    "repair the mesh or leave the comparison out."
                )
            lower, upper = ((bound - grid.origin_m) / grid.spacing_m for bound in part.bounds)
            start = np.clip(np.floor(lower).astype(int), 0, grid.shape)
            stop = np.clip(np.ceil(upper).astype(int) + 1, 0, grid.shape)
            if np.any(stop <= start):
                continue
            box = tuple(slice(a, b) for a, b in zip(start, stop, strict=True))
            index = np.stack(np.meshgrid(*map(np.arange, start, stop), indexing="ij"), axis=-1)
            centres = grid.origin_m + grid.spacing_m * index.reshape(-1, 3)
            inside[box] |= part.contains(centres).reshape(tuple(stop - start))
        return inside


def tiangong_like(
    *,
    length_m: float = 10.4,
    diameter_m: float = 3.35,
    span_m: float = 17.0,
    panel_width_m: float = 2.8,
    panel_tilt_rad: float = np.deg2rad(25.0),
) -> Target:
    """Return a Tiangong-1-like space laboratory, flying along +x with panels along y.

    Forward a laboratory cylinder of full diameter, behind it a narrower resource module with
    the two solar panels, joined by a cone; at the front a docking ring. The panels, tilted about
    y, and the two modules make it asymmetric along x and z, so that a mirrored hull is noticed.

    Args:
        length_m: from docking ring to tail.
        diameter_m: of the laboratory.
        span_m: from panel tip to panel tip.
        panel_width_m: chord of the panels.
        panel_tilt_rad: turn of the panels about y.

    Source: length 10.4 m and greatest diameter 3.35 m are the published figures (China Manned
    Space Agency, as in Encyclopaedia Britannica, "Tiangong"). No published figure
    of the panels' span was found: 17 m, like the modules' shares, chord and tilt, is ours.
    """
    radius = diameter_m / 2
    ring_m, lab_m, cone_m = 0.06 * length_m, 0.48 * length_m, 0.10 * length_m
    narrow = 0.75 * radius
    ahead = length_m / 2
    profile = [
        (0.45 * radius, ahead),
        (0.45 * radius, ahead - ring_m),
        (radius, ahead - ring_m),
        (radius, ahead - ring_m - lab_m),
        (narrow, ahead - ring_m - lab_m - cone_m),
        (narrow, -ahead),
    ]
    outline = np.array([(0.0, ahead), *profile, (0.0, -ahead)])[::-1]
    body = trimesh.creation.revolve(outline, sections=96)
    body.apply_transform(trimesh.geometry.align_vectors([0, 0, 1], [1, 0, 0]))
    x_panel = -ahead + 0.2 * length_m
    panels = [
        _panel(
            side,
            root_m=narrow,
            tip_m=span_m / 2,
            width_m=panel_width_m,
            tilt_rad=panel_tilt_rad,
            x_m=x_panel,
        )
        for side in (-1, 1)
    ]
    return Target(
        name="Tiangong-1-like laboratory",
        parts=(body, *panels),
        features=(
            LineFeature(name="span", length_m=span_m, direction=np.array([0.0, 1.0, 0.0])),
            LineFeature(name="length", length_m=length_m, direction=np.array([1.0, 0.0, 0.0])),
            LineFeature(name="diameter", length_m=diameter_m, direction=np.array([0.0, 0.0, 1.0])),
        ),
    )


def _panel(
    side: int, *, root_m: float, tip_m: float, width_m: float, tilt_rad: float, x_m: float
) -> trimesh.Trimesh:
    """Return one solar panel, 0.12 m thick, from inside the body out to its tip."""
    inner = 0.9 * root_m
    panel = trimesh.creation.box(extents=(width_m, tip_m - inner, 0.12))
    panel.apply_transform(trimesh.transformations.rotation_matrix(tilt_rad, [0, 1, 0]))
    panel.apply_translation([x_m, side * (tip_m + inner) / 2, 0.0])
    return panel


MRO_LINES: tuple[tuple[str, float, tuple[float, float, float]], ...] = (
    ("l1", 27.69, (-0.97, 0.26, 0.0)),
    ("l2", 58.12, (1.0, 0.0, 0.0)),
    ("l3", 15.88, (0.0, 0.0, 1.0)),
)
"""Name, length in metres and attitude of the line features of the paper's Table 2."""


def mro_like() -> Target:
    """Return an orbiter like the Mars Reconnaissance Orbiter with three known tip-to-tip lines.

    l1 is a sounder's boom across the bottom of the bus, from end to end; l2 reaches from the tip of
    one solar panel to that of the other; l3 from the end of the feed before the dish to the end of
    the engine's nozzle below. A star tracker on one side tells it from its mirror image.

    Source: lengths and attitudes are those of the paper's Table 2; all shapes are ours.
    """
    (_, boom_m, boom), (_, span_m, _), (_, height_m, _) = MRO_LINES
    side_m, top_m = 5.0, height_m / 2
    rim_m = top_m - 2.4
    parts = [
        _block((0, 0, -1.2), (side_m, side_m, 6.4)),
        _block((side_m / 2 + 0.5, 1.4, -3.0), (1.4, 1.0, 1.0)),
        _turned([(0.0, 2.0), (1.0, 2.0), (4.6, rim_m), (4.6, rim_m + 0.15), (0.0, 2.6)]),
        _turned([(0.0, 2.0), (0.3, 2.0), (0.3, top_m), (0.0, top_m)]),
        _turned([(0.0, -top_m), (0.5, -top_m), (0.3, -4.0), (0.0, -4.0)]),
        _rod(np.array(boom), boom_m, radius_m=0.25, centre_m=np.array([0.0, 0.0, -4.2])),
    ]
    for sign in (-1, 1):
        inner, outer = 0.45 * side_m, span_m / 2
        parts.append(_block((sign * (inner + 6.0) / 2, 0, 0), (6.0 - inner, 0.6, 0.6)))
        parts.append(_block((sign * (6.0 + outer) / 2, 0, 0), (outer - 6.0, 5.2, 0.4)))
    return Target(
        name="MRO-like orbiter",
        parts=tuple(parts),
        features=tuple(
            LineFeature(name=name, length_m=length_m, direction=np.array(direction))
            for name, length_m, direction in MRO_LINES
        ),
    )


def _block(
    centre_m: tuple[float, float, float], sizes_m: tuple[float, float, float]
) -> trimesh.Trimesh:
    block = trimesh.creation.box(extents=sizes_m)
    block.apply_translation(centre_m)
    return block


def _turned(outline_m: list[tuple[float, float]]) -> trimesh.Trimesh:
    """Return the body that (radius, height) points sweep about z, from the axis and back to it."""
    return trimesh.creation.revolve(np.array(outline_m), sections=64)


def _rod(
    direction: Floats, length_m: float, *, radius_m: float, centre_m: Floats
) -> trimesh.Trimesh:
    rod = trimesh.creation.cylinder(radius=radius_m, height=length_m, sections=48)
    rod.apply_transform(
        trimesh.geometry.align_vectors([0, 0, 1], direction / np.linalg.norm(direction))
    )
    rod.apply_translation(centre_m)
    return rod
