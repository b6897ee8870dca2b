"""Hulls of a spinning target under its rough, its estimated and its true motion."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from core.experiments.carved_hull import CarvedHull, carved_hull
from core.experiments.frame_pictures import frames_picture
from core.experiments.hull_pictures import error_pictures, sides_picture
from core.experiments.limited import radar_views
from core.experiments.pictures import Picture
from core.experiments.results import Figure, Table
from core.experiments.spin_scene import (
    STATIONS,
    SpinningEchoes,
    SpunFrame,
    spun_frames,
    true_spin,
)
from core.experiments.spin_trials import (
    Trial,
    axis_error_deg,
    rate_error_percent,
    rough_start,
    seen_by,
    stations_text,
)
from core.experiments.study import Progress
from core.geometry.grid import VoxelGrid
from core.geometry.spin import Spin
from core.registration.spin import SpinAgreement, estimate_spin
from core.targets import Target

SIDE_M = 21.0

ROUGH, ESTIMATED, TRUE = "rough motion", "estimated motion", "true motion"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SpunHulls:
    """Hulls under rough, estimated and true motion, by motion and number of stations.

    Attributes:
        rough: frames under the rough motion.
        estimated: frames under what all stations estimate.
        hulls: their hulls.
        normal_deg: largest angle between the spin's axis and an image plane's normal.
        agreements: of the outlines of all stations under each motion.
        refined: what all stations estimate once more, from images under their first estimate.
        truth: the true spin.
    """

    rough: list[SpunFrame]
    estimated: list[SpunFrame]
    hulls: Mapping[tuple[str, int], CarvedHull]
    normal_deg: float
    agreements: Mapping[str, float]
    refined: Spin
    truth: Spin

    @classmethod
    def of(
        cls,
        target: Target,
        echoes: Sequence[SpinningEchoes],
        trials: Sequence[Trial],
        rate_deg_per_s: float,
        spacing_m: float,
        progress: Progress,
    ) -> "SpunHulls":
        """Carve the hulls of one rate's echoes.

        Args:
            target: the truth.
            echoes: of all stations.
            trials: whose first ones are of this rate and of the first start.
            rate_deg_per_s: of the true spin.
            spacing_m: voxel spacing.
            progress: told of hulls done and in all.
        """
        truth = true_spin(rate_deg_per_s)
        start, every = rough_start(0, truth), len(STATIONS)
        rough, perfect = spun_frames(echoes, start), spun_frames(echoes, truth)
        grid = VoxelGrid.cube(side_m=SIDE_M, spacing_m=spacing_m)
        voxels = target.voxels(grid)
        hulls, estimated = {}, rough
        for stations in range(1, every + 1):
            # The first trials are of the first rate and the first start.
            found = trials[stations - 1].found
            estimated = spun_frames([x for x in echoes if x.station < stations], found)
            for motion, spun in ((ROUGH, rough), (ESTIMATED, estimated), (TRUE, perfect)):
                views = radar_views([x.found for x in seen_by(spun, stations)], "shadow")
                hulls[motion, stations] = carved_hull(
                    views, grid, voxels, has_surface=stations == every
                )
                progress("hulls", len(hulls), 3 * every)
        outlines = [each.outline for each in estimated]
        agreement, found = SpinAgreement(outlines, start), trials[every - 1].found
        return cls(
            rough=rough,
            estimated=estimated,
            hulls=hulls,
            normal_deg=max(_normal_deg(each, truth) for each in perfect),
            agreements={
                motion: agreement(spin)
                for motion, spin in ((ROUGH, start), (ESTIMATED, found), (TRUE, truth))
            },
            refined=estimate_spin(outlines, found).spin,
            truth=truth,
        )

    def figures(self) -> list[Figure]:
        """Return IoU and coverage of all hulls, and agreement of the outlines."""
        figures = []
        for (motion, stations), hull in self.hulls.items():
            name = f"{stations_text(stations)}, {motion}"
            figures += [
                Figure(name=f"{name}: IoU", value=hull.agreement.intersection_over_union),
                Figure(name=f"{name}: coverage", value=hull.agreement.coverage),
            ]
        figures += [
            Figure(name=f"agreement of outlines with the others' hull, {motion}", value=value)
            for motion, value in self.agreements.items()
        ]
        return [
            *figures,
            Figure(
                name="image planes' normals off the axis, most", value=self.normal_deg, unit="°"
            ),
            Figure(
                name=f"{stations_text(len(STATIONS))}, images formed anew: axis error",
                value=axis_error_deg(self.refined, self.truth),
                unit="°",
            ),
            Figure(
                name=f"{stations_text(len(STATIONS))}, images formed anew: rate error",
                value=abs(rate_error_percent(self.refined, self.truth)),
                unit="%",
            ),
        ]

    def table(self) -> Table:
        """Return the hulls as a table."""
        rows = [
            (
                f"{stations_text(stations)}, {motion}",
                f"{hull.agreement.intersection_over_union:.3f}",
                f"{hull.agreement.coverage:.3f}",
                f"{hull.volume_m3:.1f}",
            )
            for (motion, stations), hull in self.hulls.items()
        ]
        return Table(
            title="Hulls from echoes, shadow rule, images formed under each motion",
            columns=("", "IoU", "coverage", "volume (m³)"),
            rows=tuple(rows),
        )

    def pictures(self, target: Target) -> tuple[Picture, ...]:
        """Return frames, hulls and the error of the estimated one."""
        every = len(STATIONS)
        estimated = self.hulls[ESTIMATED, every].surface
        return (
            frames_picture(
                [each.found for each in self.estimated],
                target,
                name="spin-frames",
                caption="Frames of three stations under the estimated motion with the outlines "
                "found and the true ones: range down, cross-range right, 45 dB of amplitude.",
            ),
            *(
                _side_picture(self.hulls[motion, every], target, motion)
                for motion in (ROUGH, ESTIMATED, TRUE)
            ),
            *error_pictures(estimated, target, name="spin-errors"),
        )


def _normal_deg(spun: SpunFrame, spin: Spin) -> float:
    cosine = abs(float(spun.found.frame.projection.viewing_direction() @ spin.axis))
    return float(np.rad2deg(np.arccos(min(cosine, 1.0))))


def _side_picture(hull: CarvedHull, target: Target, motion: str) -> Picture:
    name = f"spin-hull-{motion.removesuffix(' motion')}"
    drawn = sides_picture(hull.surface, target, name=name, what=motion)
    return replace(
        drawn,
        caption=f"Hull of three stations under the {motion}: from three sides, above the hull and "
        "below the truth (metres, target frame: the inertial axes at the epoch).",
    )
