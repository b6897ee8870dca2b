"""The paper's experiment B, radar alone: what one pass over Beijing tells of a target."""

from collections.abc import Sequence

import numpy as np

from core.experiments.beijing_pass import PAPER_SPANS_DEG, BeijingPass, beijing_pass, radar_frames
from core.experiments.carved_hull import COLUMNS, CarvedHull, carved_hull
from core.experiments.frame_pictures import OutlinedFrame, frames_picture
from core.experiments.hull_pictures import error_pictures, sides_picture
from core.experiments.observability_picture import observability_picture, unobserved_percent
from core.experiments.results import Figure, Results, Table
from core.experiments.study import Progress, Study
from core.experiments.true_outline import true_silhouette
from core.geometry.grid import VoxelGrid
from core.geometry.track import angles_from_line_of_sight
from core.hull.shadow import CarvingRule, carving_view
from core.hull.view import View
from core.measurement.observability import observability
from core.silhouettes.extraction import extract_silhouette
from core.targets import Target, tiangong_like

SIDE_M = 21.0
"""Of the grid, which cuts off what the pass leaves open."""

FROM_ECHOES, STRICT, TRUE = "echoes, shadow rule", "echoes, strict rule", "true outlines"


def run_limited(
    *,
    frames: int | None = None,
    spacing_m: float = 0.15,
    scatterers: int = 60_000,
    signal_to_noise_db: float = 20.0,
    seed: int = 1,
    progress: Progress = lambda _stage, _done, _total: None,
) -> Study:
    """Carve a Tiangong-like target from the echoes of one pass, and say what stays unobserved.

    Beside the shadow rule and the paper's strict rule on silhouettes from echoes stands the hull
    of the true outlines of the same frames: what no better silhouette could improve on.

    Args:
        frames: of the pass's intervals, so many; None for all.
        spacing_m: voxel spacing.
        scatterers: points on the target's surface.
        signal_to_noise_db: as in `simulate_echoes`.
        seed: of the random generator.
        progress: told of stage, steps done and steps in all.

    Raises:
        ValueError: fewer than two frames, or parameters a stage refuses.
    """
    target, seen = tiangong_like(), beijing_pass(frames=frames)
    images = radar_frames(
        seen,
        target,
        scatterers=scatterers,
        signal_to_noise_db=signal_to_noise_db,
        random=np.random.default_rng(seed),
        progress=lambda done, total: progress("echoes and images", done, total),
    )
    found = [OutlinedFrame(frame=each, silhouette=extract_silhouette(each)) for each in images]
    grid = VoxelGrid.cube(side_m=SIDE_M, spacing_m=spacing_m)
    truth = target.voxels(grid)
    voting = {
        FROM_ECHOES: radar_views(found, "shadow"),
        STRICT: radar_views(found, "strict"),
        TRUE: true_views(found, target),
    }
    hulls = {}
    for number, (name, views) in enumerate(voting.items(), start=1):
        hulls[name] = carved_hull(views, grid, truth)
        progress("hulls", number, len(voting))
    settings = {
        "target": target.name,
        **pass_settings(seen),
        "spacing_m": spacing_m,
        "scatterers": scatterers,
        "signal_to_noise_db": signal_to_noise_db,
        "seed": seed,
    }
    true_m3 = float(np.count_nonzero(truth)) * spacing_m**3
    extents_m = target.mesh().extents
    results = Results(
        name="limited",
        settings=settings,
        figures=_figures(seen, voting, hulls),
        tables=(hulls_table(hulls, true_m3, extents_m.tolist()), _directions_table(voting)),
        finding=_finding(voting[FROM_ECHOES], hulls, true_m3),
    )
    ours = hulls[FROM_ECHOES].surface
    pictures = (
        frames_picture(
            found,
            target,
            name="limited-frames",
            caption="Radar frames of the pass with the outlines found and the true ones: range "
            "down, cross-range right, 45 dB of amplitude.",
        ),
        sides_picture(ours, target, name="limited-hull", what="Hull of the pass, radar alone"),
        *error_pictures(ours, target, name="limited-errors"),
        observability_picture(
            {"lit sides, shadow rule": voting[FROM_ECHOES], TRUE: voting[TRUE]},
            name="limited-directions",
        ),
    )
    return Study(results=results, pictures=pictures, hull=ours)


def radar_views(found: Sequence[OutlinedFrame], rule: CarvingRule) -> list[View]:
    """Return radar frames' silhouettes as they vote; those without a target do not."""
    return [
        carving_view(View(silhouette=each.silhouette, projection=each.frame.projection), rule)
        for each in found
        if not each.silhouette.is_empty
    ]


def true_views(found: Sequence[OutlinedFrame], target: Target) -> list[View]:
    """Return the views of the outlines that the target truly has in some frames."""
    mesh = target.mesh()
    return [
        View(
            silhouette=true_silhouette(mesh, each.frame.projection, each.frame.shape),
            projection=each.frame.projection,
        )
        for each in found
    ]


def pass_settings(seen: BeijingPass) -> dict[str, object]:
    """Return what a report says of the pass: its time, its frames, and the spans it has."""
    azimuth, elevation = seen.station_spans_deg()
    phi, theta = seen.target_spans_deg()
    return {
        "pass": f"{seen.track.epoch_utc} over Beijing, elevation mask 10°",
        "frames": len(seen.intervals),
        "spans at the station": f"azimuth {azimuth:.2f}°, elevation {elevation:.2f}°",
        "spans in the target frame": f"φ {phi:.2f}°, θ {theta:.2f}°",
        "the paper's spans": f"{PAPER_SPANS_DEG[0]}° and {PAPER_SPANS_DEG[1]}°",
    }


def hulls_table(hulls: dict[str, CarvedHull], true_m3: float, extents_m: Sequence[float]) -> Table:
    """Return hulls and the truth as a table of IoU, coverage, volume and extents."""
    truth = ("truth", "1.000", "1.000", f"{true_m3:.1f}", *(f"{size:.2f}" for size in extents_m))
    return Table(
        title="Hulls against the truth",
        columns=COLUMNS,
        rows=(*(hull.row(name) for name, hull in hulls.items()), truth),
    )


def _figures(
    seen: BeijingPass, voting: dict[str, list[View]], hulls: dict[str, CarvedHull]
) -> tuple[Figure, ...]:
    spans = zip(("azimuth", "elevation"), seen.station_spans_deg(), strict=True)
    figures = [Figure(name=f"{axis} span at the station", value=v, unit="°") for axis, v in spans]
    for name, hull in hulls.items():
        figures += hull.figures(name)
    for name in (FROM_ECHOES, TRUE):
        figures.append(
            Figure(
                name=f"{name}: directions unobserved",
                value=unobserved_percent(voting[name]),
                unit="%",
            )
        )
    return tuple(figures)


def _directions_table(voting: dict[str, list[View]]) -> Table:
    rows = []
    for name in (FROM_ECHOES, TRUE):
        seen = observability(voting[name])
        worst = seen.worst_direction()
        cells = [
            f"{seen.grade(axis)} ({_dilution_text(seen.dilution(axis))})" for axis in np.eye(3)
        ]
        theta, phi = (float(np.rad2deg(angle)) for angle in angles_from_line_of_sight(worst))
        place = f"({worst[0]:+.2f}, {worst[1]:+.2f}, {worst[2]:+.2f}), φ {phi:.0f}°, θ {theta:.0f}°"
        rows.append((name, *cells, place, f"{unobserved_percent(voting[name]):.0f} %"))
    return Table(
        title="Directions: grade and dilution",
        columns=("outlines", "x", "y", "z", "worst direction", "unobserved"),
        rows=tuple(rows),
    )


def _dilution_text(dilution: float) -> str:
    return "∞" if np.isinf(dilution) else f"{dilution:.1f}"


def _finding(views: list[View], hulls: dict[str, CarvedHull], true_m3: float) -> str:
    ours, perfect = hulls[FROM_ECHOES], hulls[TRUE]
    bounded = [extent.name for extent in ours.extents if extent.is_bounded]
    axis = observability(views).worst_direction()
    return (
        f"Radar alone, one pass keeps {100 * ours.agreement.coverage:.0f} % of the target in a "
        f"hull of {ours.volume_m3:.0f} m³ for a body of {true_m3:.0f} m³ (IoU "
        f"{ours.agreement.intersection_over_union:.3f}; true outlines "
        f"{perfect.volume_m3:.0f} m³, {perfect.agreement.intersection_over_union:.3f}): "
        f"{', '.join(bounded) if bounded else 'no extent'} is bounded, "
        f"{unobserved_percent(views):.0f} % of all directions are unobserved, worst along "
        f"({axis[0]:+.2f}, {axis[1]:+.2f}, {axis[2]:+.2f})."
    )
