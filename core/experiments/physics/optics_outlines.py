"""Outlines and hulls from telescope frames against the truth."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely

from core.arrays import Floats
from core.experiments.true_outline import true_silhouette
from core.frame import Frame
from core.geometry.grid import VoxelGrid
from core.hull.shadow import CarvingRule
from core.hull.sunlight import carving_frame_view, frame_view
from core.hull.view import View
from core.hull.volume import VoteVolume
from core.measurement.comparison import Agreement, voxel_agreement
from core.optical.camera import perpendicular_partner
from core.optical.materials import facet_materials, part_materials
from core.optical.rendering import Light
from core.optical.simulation import OpticalSettings, optical_frame
from core.silhouettes.extraction import extract_silhouette
from core.silhouettes.silhouette import Silhouette
from core.targets import Target

RANGE_M = 450e3

SIDE_M = 21.0
"""Of the grid, which the target does not exceed in any direction."""

LOST_PX = 5.0
"""Where the outline on the sun's side is this far off, the target's edge was not lit."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Outlined:
    """A frame with the outline taken from it and the one that the target truly has."""

    frame: Frame
    silhouette: Silhouette
    truth: Silhouette


def outlined(frame: Frame, target: Target) -> Outlined:
    """Return a frame with its extracted and true outlines."""
    truth = true_silhouette(target.mesh(), frame.projection, frame.shape)
    return Outlined(frame=frame, silhouette=extract_silhouette(frame), truth=truth)


def random_frames(
    target: Target,
    *,
    phases_rad: Floats,
    settings: OpticalSettings,
    random: np.random.Generator,
    progress: Callable[[int, int], None],
) -> list[Outlined]:
    """Return frames from random directions, the sun at these phase angles in any direction."""
    mesh, coats = target.mesh(), facet_materials(target, part_materials(target))
    found = []
    for number, phase in enumerate(phases_rad, start=1):
        ahead, across, other = np.linalg.qr(random.normal(size=(3, 3)))[0].T
        camera = perpendicular_partner(
            line_of_sight=ahead,
            cross_range=across,
            pixel_m=RANGE_M * settings.pixel_rad(),
            shape=settings.shape,
        )
        frame = optical_frame(
            mesh,
            coats,
            camera,
            Light(sun_direction=np.sin(phase) * other - np.cos(phase) * ahead),
            settings,
            line_of_sight=ahead,
            range_m=RANGE_M,
            time_s=float(number),
            random=random,
        )
        found.append(outlined(frame, target))
        progress(number, len(phases_rad))
    return found


def area_error_percent(each: Outlined) -> float:
    """Return by how much the outline's area differs from the true one's, in per cent."""
    return 100 * (each.silhouette.area_px() / each.truth.area_px() - 1)


def sunward_errors_px(each: Outlined) -> Floats:
    """Return how far the edge on the sun's side lies outside the true one, per column of pixels.

    It is taken along the sun's direction in the picture, where the outline carves; columns that
    show nothing count as infinitely far inside.
    """
    truth = frame_view(each.frame, replace(each.truth, claim="lit side")).silhouette
    ours = frame_view(each.frame, each.silhouette).silhouette
    first, last = (edge(np.concatenate(truth.rings)[:, 1]) for edge in (np.min, np.max))
    columns = np.arange(np.ceil(first) + 2, np.floor(last) - 1)
    errors: Floats = _sunward_rows(truth, columns) - _sunward_rows(ours, columns)
    return errors


def _sunward_rows(silhouette: Silhouette, columns: Floats) -> Floats:
    """Return the least row of an outline in each column, +∞ where it has none."""
    body = shapely.MultiLineString([np.vstack([ring, ring[:1]]) for ring in silhouette.rings])
    far = 10.0 * silhouette.image_shape[0]
    lines = shapely.linestrings([[(-far, column), (far, column)] for column in columns])
    crossings = shapely.intersection(lines, body)
    rows: Floats = shapely.bounds(crossings)[:, 0]
    return np.where(np.isnan(rows), np.inf, rows)


def agreement(
    found: Sequence[Outlined], target: Target, rule: CarvingRule | None, spacing_m: float
) -> Agreement:
    """Return how the hull of frames agrees with the target; of the true outlines for no rule."""
    grid = VoxelGrid.cube(side_m=SIDE_M, spacing_m=spacing_m)
    volume = VoteVolume(grid)
    for each in found:
        if rule is None:
            volume.add(View(silhouette=each.truth, projection=each.frame.projection))
        else:
            volume.add(carving_frame_view(each.frame, each.silhouette, rule, depth_m=SIDE_M))
    return voxel_agreement(volume.hull(), target.voxels(grid))
