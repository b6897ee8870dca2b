"""What is measured of a person's hull and of the knife's, and the same of the truth."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import trimesh
from numpy.typing import NDArray
from skimage.measure import label

from core.arrays import Floats, frozen
from core.geometry.grid import VoxelGrid
from core.hull.distance_hull import CurvedView, distance_surface, hull_distance_px
from core.hull.surface import EMPTY_SURFACE, Surface
from core.human_body import KNIFE, SHOULDER_BAND
from core.measurement.comparison import Agreement, voxel_agreement
from core.measurement.lines import angle_between_lines_rad, body_covariance_m5, principal_lines
from core.targets import Target

KNIFE_FINER = 2.5
"""Voxels of the knife's grid per voxel of the body's."""

KNIFE_MARGIN_M = 0.03

MAY_MISS = 0.5
"""Share of the knife's frames that may not hold a voxel: half of them decide. An arm before it or a
dark speckle in it cuts its outline short, and a frame that does not show it may have taken some
bright skin for it."""

FEWEST_FRAMES = 3
"""A knife seen in fewer frames is none."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PersonMeasures:
    """Lengths and places of a person and a knife; None and NaN where there is nothing to measure.

    Attributes:
        height_m: from the lowest to the highest point.
        shoulder_m: greatest horizontal width at the shoulders' height.
        feet_z_m: z of the lowest point.
        axis_m: (2,) x and y of the body's centroid.
        knife_m: length along its own longest axis.
        knife_direction: (3,) of that axis.
        knife_middle_m: (3,) halfway between its ends.
    """

    height_m: float | None = None
    shoulder_m: float | None = None
    feet_z_m: float = float("nan")
    axis_m: Floats | None = None
    knife_m: float | None = None
    knife_direction: Floats | None = None
    knife_middle_m: Floats | None = None

    def knife_height_m(self) -> float | None:
        """Return how high above the feet the knife's middle is."""
        if self.knife_middle_m is None or self.axis_m is None:
            return None
        return self.feet_z_m - float(self.knife_middle_m[2])

    def knife_offset_m(self) -> Floats | None:
        """Return the knife's middle from the body's upright axis, (2,) along x and y."""
        if self.knife_middle_m is None or self.axis_m is None:
            return None
        offset: Floats = self.knife_middle_m[:2] - self.axis_m
        return offset

    def knife_angle_deg(self, truth: "PersonMeasures") -> float | None:
        """Return the angle between two knives' directions."""
        if self.knife_direction is None or truth.knife_direction is None:
            return None
        angle_rad = angle_between_lines_rad(self.knife_direction, truth.knife_direction)
        return float(np.rad2deg(angle_rad))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PersonHull:
    """Hull of a body and of the knife on it.

    Attributes:
        body: its surface, empty if nothing is left.
        knife: likewise.
        agreement: of the body's voxels with the true ones.
        measures: of both.
    """

    body: Surface
    knife: Surface
    agreement: Agreement
    measures: PersonMeasures


def person_hull(
    body: Sequence[CurvedView],
    knife: Sequence[CurvedView],
    grid: VoxelGrid,
    truth: NDArray[np.bool_],
    *,
    may_miss: float = MAY_MISS,
) -> PersonHull:
    """Carve body and knife and measure both; the truth enters the agreement alone.

    Args:
        body: views of the whole, as they vote; all of them must hold a voxel.
        knife: views of the knife, as they vote.
        grid: for the body.
        truth: (nx, ny, nz) true voxels on it.
        may_miss: share of the knife's views that may not hold a voxel.
    """
    inside = largest_region(hull_distance_px(body, grid))
    body_surface = distance_surface(inside, grid)
    knife_surface = knife_hull(knife, grid, may_miss=may_miss)
    return PersonHull(
        body=body_surface,
        knife=knife_surface,
        agreement=voxel_agreement(inside > 0, truth),
        measures=person_measures(body_surface, knife_surface),
    )


def knife_hull(views: Sequence[CurvedView], grid: VoxelGrid, *, may_miss: float) -> Surface:
    """Return the hull of the knife's own silhouettes: where it is on a coarse grid, then finely."""
    if len(views) < FEWEST_FRAMES:
        return EMPTY_SURFACE
    count = int(may_miss * len(views))
    coarse_m = 2 * grid.spacing_m
    whole = VoxelGrid.over(lower_m=grid.origin_m, upper_m=grid.upper_m, spacing_m=coarse_m)
    # Half a voxel of slack, in pixels of 5 mm, or a blade falls between the coarse grid's points.
    slack_px = coarse_m / 0.005
    rough = largest_region(hull_distance_px(views, whole, may_miss=count) + slack_px / 2)
    if not (rough > 0).any():
        return EMPTY_SURFACE
    places = whole.origin_m + coarse_m * np.argwhere(rough > 0)
    fine = VoxelGrid.over(
        lower_m=places.min(axis=0) - KNIFE_MARGIN_M,
        upper_m=places.max(axis=0) + KNIFE_MARGIN_M,
        spacing_m=grid.spacing_m / KNIFE_FINER,
    )
    return distance_surface(largest_region(hull_distance_px(views, fine, may_miss=count)), fine)


def largest_region(inside_px: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return distances with every region inside but the largest put outside."""
    regions = label(inside_px > 0, connectivity=1)
    sizes = np.bincount(regions.ravel())
    if len(sizes) <= 2:
        return inside_px
    sizes[0] = 0
    others = (regions > 0) & (regions != np.argmax(sizes))
    kept: NDArray[np.float32] = np.where(others, np.float32(-1), inside_px)
    return kept


def person_measures(body: Surface, knife: Surface) -> PersonMeasures:
    """Measure hulls; nothing of the truth goes in."""
    if body.is_empty:
        return PersonMeasures()
    z = body.vertices_m[:, 2]
    length = direction = middle = None
    if not knife.is_empty:
        longest, second, third = principal_lines(knife, ("length", "width", "thickness"))
        axes = np.array([line.direction for line in (longest, second, third)])
        length, direction = longest.length_m, longest.direction
        middle = _middle_m(knife.vertices_m, axes)
    return PersonMeasures(
        height_m=float(np.ptp(z)),
        shoulder_m=shoulder_width_m(body.vertices_m),
        feet_z_m=float(z.max()),
        axis_m=body_covariance_m5(body)[0][:2],
        knife_m=length,
        knife_direction=direction,
        knife_middle_m=middle,
    )


def true_measures(person: Target) -> PersonMeasures:
    """Return the same of the true meshes, with the lengths that they were made to."""
    body, *parts = person.parts
    lengths = {feature.name: feature for feature in person.features}
    knife = lengths[KNIFE]
    axes = np.array([knife.direction, [1.0, 0.0, 0.0], np.cross(knife.direction, [1.0, 0.0, 0.0])])
    points = np.concatenate([np.asarray(part.vertices) for part in parts])
    return PersonMeasures(
        height_m=lengths["height"].length_m,
        shoulder_m=lengths["shoulder width"].length_m,
        feet_z_m=float(body.bounds[1, 2]),
        axis_m=frozen(body.center_mass[:2], np.float64, (2,), "The body's axis"),
        knife_m=knife.length_m,
        knife_direction=knife.direction,
        knife_middle_m=_middle_m(points, axes),
    )


def shoulder_width_m(points_m: Floats) -> float | None:
    """Return the greatest horizontal width of a body's points between `SHOULDER_BAND`'s heights."""
    z = points_m[:, 2]
    share = (z.max() - z) / np.ptp(z)
    band = points_m[(share >= SHOULDER_BAND[0]) & (share <= SHOULDER_BAND[1]), :2]
    if len(band) < 2:
        return None
    turn = np.deg2rad(np.arange(180))
    return float(np.ptp(band @ np.stack([np.cos(turn), np.sin(turn)]), axis=0).max())


def surface_of(mesh: trimesh.Trimesh) -> Surface:
    """Return a mesh as a surface."""
    return Surface(vertices_m=np.asarray(mesh.vertices), faces=np.asarray(mesh.faces))


def _middle_m(points_m: Floats, axes: Floats) -> Floats:
    along = points_m @ axes.T
    middle: Floats = 0.5 * (along.min(axis=0) + along.max(axis=0)) @ axes
    return middle
