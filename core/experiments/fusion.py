"""The paper's experiment B: one pass seen by the radar and by a telescope beside it (eq. 26)."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure as Canvas
from numpy.typing import NDArray

from core.experiments.beijing_pass import (
    BeijingPass,
    beijing_pass,
    optical_frames,
    radar_frames,
)
from core.experiments.carved_hull import CarvedHull, carved_hull
from core.experiments.frame_pictures import OutlinedFrame, frames_picture
from core.experiments.hull_pictures import error_pictures, sides_picture
from core.experiments.limited import SIDE_M, hulls_table, pass_settings, radar_views, true_views
from core.experiments.observability_picture import observability_picture, unobserved_percent
from core.experiments.pictures import Picture
from core.experiments.results import Figure, Results, Table
from core.experiments.study import Progress, Study
from core.experiments.true_outline import true_silhouette
from core.geometry.grid import VoxelGrid
from core.hull.sunlight import carving_frame_view
from core.hull.view import View
from core.optical.camera import perpendicular_partner
from core.optical.simulation import OpticalSettings
from core.silhouettes.extraction import extract_silhouette
from core.targets import Target, tiangong_like

SWEEP = (0, 1, 2, 5, 10)
"""Numbers of optical frames beside all radar frames; then all of them."""

RADAR, OPTICAL, BOTH = "radar alone", "telescope alone", "both"
TRUE_RADAR, TRUE_BOTH = "true outlines, radar", "true outlines, both, every moment"

Sensors = tuple[list[OutlinedFrame], list[OutlinedFrame]]
"""Outlined frames of the radar and of the telescope."""


def run_fusion(
    *,
    frames: int | None = None,
    spacing_m: float = 0.15,
    scatterers: int = 60_000,
    signal_to_noise_db: float = 20.0,
    seed: int = 1,
    progress: Progress = lambda _stage, _done, _total: None,
) -> Study:
    """Carve a Tiangong-like target from one pass by radar, by telescope, and by both.

    A telescope frame is taken at the moment of each radar frame; those in which the satellite
    stands in shadow or too far against the sun do not carve. Rows of true outlines say what a
    telescope would add that sees the whole outline at every moment, as in the paper.

    Args:
        frames: of the pass's intervals, so many; None for all.
        spacing_m: voxel spacing.
        scatterers: points on the target's surface.
        signal_to_noise_db: as in `simulate_echoes`.
        seed: of the random generator.
        progress: told of stage, steps done and steps in all.

    Raises:
        ValueError: fewer than two frames, or parameters a stage refuses.

    Source: eq. 26, the voxels that both sensors' silhouettes leave; eqs. 7 and 8 for the camera,
    which looks along the radar's line of sight.
    """
    target, seen = tiangong_like(), beijing_pass(frames=frames)
    sensors = _observed(seen, target, scatterers, signal_to_noise_db, seed, progress)
    grid = VoxelGrid.cube(side_m=SIDE_M, spacing_m=spacing_m)
    truth = target.voxels(grid)
    true_m3 = float(np.count_nonzero(truth)) * spacing_m**3
    voting = _voting(seen, sensors, target)
    hulls = {}
    for number, (name, views) in enumerate(voting.items(), start=1):
        hulls[name] = carved_hull(views, grid, truth)
        progress("hulls", number, len(voting))
    sweep = swept(voting[RADAR], voting[OPTICAL], grid, truth)
    settings = {
        "target": target.name,
        **pass_settings(seen),
        "optical frames fit to carve": len(voting[OPTICAL]),
        "spacing_m": spacing_m,
        "scatterers": scatterers,
        "signal_to_noise_db": signal_to_noise_db,
        "seed": seed,
    }
    results = Results(
        name="fusion",
        settings=settings,
        figures=_figures(hulls, sweep, voting),
        tables=(
            hulls_table(hulls, true_m3, target.mesh().extents.tolist()),
            _sweep_table(sweep),
        ),
        finding=_finding(hulls, sweep, true_m3, moments=len(seen.intervals)),
    )
    pictures = (
        *_frame_pictures(sensors, target),
        sides_picture(hulls[BOTH].surface, target, name="fusion-hull", what="Hull of both"),
        *error_pictures(hulls[BOTH].surface, target, name="fusion-errors"),
        _sweep_picture(sweep, true_m3),
        observability_picture(
            {name: voting[name] for name in (RADAR, OPTICAL, BOTH)},
            name="fusion-directions",
            note="A sunlit side bounds its shaded edge loosely, which these maps do not count.",
        ),
    )
    return Study(results=results, pictures=pictures, hull=hulls[BOTH].surface)


def swept(
    radar: Sequence[View],
    optical: Sequence[View],
    grid: VoxelGrid,
    truth: NDArray[np.bool_],
) -> dict[int, CarvedHull]:
    """Return the hulls of all radar views with more and more optical ones, by their number.

    Each number's optical views are among those of the next, so that no hull grows.
    """
    counts = sorted({min(count, len(optical)) for count in (*SWEEP, len(optical))})
    spread = [optical[index] for index in _spread_order(len(optical))]
    return {
        count: carved_hull([*radar, *spread[:count]], grid, truth, has_surface=False)
        for count in counts
    }


def _spread_order(count: int) -> list[int]:
    """Return 0 … count − 1 so that each is as far as can be from all before it, middle first."""
    order: list[int] = [count // 2] if count else []
    while len(order) < count:
        rest = [index for index in range(count) if index not in order]
        order.append(max(rest, key=lambda index: min(abs(index - other) for other in order)))
    return order


def _observed(
    seen: BeijingPass,
    target: Target,
    scatterers: int,
    signal_to_noise_db: float,
    seed: int,
    progress: Progress,
) -> Sensors:
    random = np.random.default_rng(seed)
    images = radar_frames(
        seen,
        target,
        scatterers=scatterers,
        signal_to_noise_db=signal_to_noise_db,
        random=random,
        progress=lambda done, total: progress("echoes and images", done, total),
    )
    photographs = optical_frames(
        seen,
        target,
        seen.fit_moments(),
        OpticalSettings(supersampling=2),
        random=random,
        progress=lambda done, total: progress("photographs", done, total),
    )
    radar, optical = (
        [OutlinedFrame(frame=each, silhouette=extract_silhouette(each)) for each in sensor]
        for sensor in (images, photographs)
    )
    return radar, optical


def _voting(seen: BeijingPass, sensors: Sensors, target: Target) -> dict[str, list[View]]:
    radar, optical = sensors
    by_radar = radar_views(radar, "shadow")
    by_telescope = [
        carving_frame_view(each.frame, each.silhouette, "shadow", depth_m=SIDE_M)
        for each in optical
        if not each.silhouette.is_empty
    ]
    true_radar = true_views(radar, target)
    return {
        RADAR: by_radar,
        OPTICAL: by_telescope,
        BOTH: by_radar + by_telescope,
        TRUE_RADAR: true_radar,
        TRUE_BOTH: true_radar + _whole_partners(seen, radar, target),
    }


def _whole_partners(
    seen: BeijingPass, radar: Sequence[OutlinedFrame], target: Target
) -> list[View]:
    """Return the true outlines in the pictures that a telescope would take with radar frames."""
    mesh, views = target.mesh(), []
    for interval, each in zip(seen.intervals, radar, strict=True):
        projection = perpendicular_partner(
            line_of_sight=seen.track.line_of_sight[interval.middle],
            cross_range=seen.track.line_of_sight_rate_per_s[interval.middle],
            pixel_m=float(each.frame.column_spacing_m or 1.0),
            shape=each.frame.shape,
        )
        silhouette = true_silhouette(mesh, projection, each.frame.shape)
        views.append(View(silhouette=silhouette, projection=projection))
    return views


def _figures(
    hulls: Mapping[str, CarvedHull],
    sweep: Mapping[int, CarvedHull],
    voting: Mapping[str, Sequence[View]],
) -> tuple[Figure, ...]:
    figures = [figure for name, hull in hulls.items() for figure in hull.figures(name)]
    figures += [
        Figure(name=f"{name}: directions unobserved", value=unobserved_percent(views), unit="%")
        for name, views in voting.items()
    ]
    for count, hull in sweep.items():
        figures.append(
            Figure(
                name=f"with {count} optical frames: IoU",
                value=hull.agreement.intersection_over_union,
            )
        )
    return tuple(figures)


def _sweep_table(sweep: Mapping[int, CarvedHull]) -> Table:
    rows = [
        (
            f"{count}{' (all)' if count == max(sweep) else ''}",
            f"{hull.agreement.intersection_over_union:.3f}",
            f"{hull.agreement.coverage:.3f}",
            f"{hull.volume_m3:.1f}",
        )
        for count, hull in sweep.items()
    ]
    return Table(
        title="All radar frames with some optical ones",
        columns=("optical frames", "IoU", "coverage", "volume (m³)"),
        rows=tuple(rows),
    )


def _finding(
    hulls: Mapping[str, CarvedHull],
    sweep: Mapping[int, CarvedHull],
    true_m3: float,
    *,
    moments: int,
) -> str:
    radar, optical, both, _, perfect = (
        f"{hull.volume_m3:.0f} m³ (IoU {hull.agreement.intersection_over_union:.3f})"
        for hull in hulls.values()
    )
    first = sweep[min(1, max(sweep))]
    return (
        f"Of a body of {true_m3:.0f} m³ the radar alone leaves {radar}, the telescope alone "
        f"{optical}, both together {both} and keep "
        f"{100 * hulls[BOTH].agreement.coverage:.0f} % of it; one optical frame already brings "
        f"the radar's hull to {first.volume_m3:.0f} m³. The sun stands well for "
        f"{max(sweep)} of {moments} moments; whole outlines at all of them would leave {perfect}."
    )


def _frame_pictures(sensors: Sensors, target: Target) -> tuple[Picture, ...]:
    radar, optical = sensors
    return (
        frames_picture(
            radar,
            target,
            name="fusion-radar",
            caption="Radar frames of the pass with the outlines found and the true ones: range "
            "down, cross-range right, 45 dB of amplitude.",
            most=4,
        ),
        frames_picture(
            optical,
            target,
            name="fusion-photographs",
            caption="Telescope frames (3.67 m, 0.7 µm) at the moments of radar frames, under a "
            "square root: what is found is the sunlit side.",
        ),
    )


def _sweep_picture(sweep: Mapping[int, CarvedHull], true_m3: float) -> Picture:
    counts = list(sweep)

    def draw(canvas: Canvas) -> None:
        left, right = canvas.subplots(1, 2)
        left.plot(counts, [hull.volume_m3 for hull in sweep.values()], "o-", label="hull")
        left.axhline(true_m3, color="#7fd48a", linestyle=":", label="truth")
        left.set(yscale="log", xlabel="optical frames", ylabel="volume (m³)")
        left.legend()
        for name in ("intersection_over_union", "coverage"):
            values = [getattr(hull.agreement, name) for hull in sweep.values()]
            right.plot(counts, values, "o-", label=name.replace("_", " "))
        right.set(xlabel="optical frames", ylim=(0, 1.03))
        right.legend()

    return Picture(
        name="fusion-sweep",
        caption="What optical frames add to all radar frames of the pass, from none to all that "
        "the sun allows.",
        draw=draw,
        size_in=(10.0, 4.0),
    )
