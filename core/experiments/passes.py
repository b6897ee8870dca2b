"""More passes, more stations, and the best next pass: how a hull comes down to its body."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from core.experiments.arcs import Arc, outlined_frames
from core.experiments.carved_hull import CarvedHull, carved_hull
from core.experiments.frame_pictures import OutlinedFrame
from core.experiments.limited import SIDE_M, radar_views, true_views
from core.experiments.next_pass import (
    ball_hull_volume,
    carved_voxels,
    compact_body,
    hull_points_m,
    predicted_aspects,
    predicted_view,
)
from core.experiments.observability_picture import unobserved_percent
from core.experiments.passes_network import Network, observing_network
from core.experiments.passes_pictures import passes_pictures
from core.experiments.passes_results import Candidate, Seen, SeenHull, passes_results
from core.experiments.study import Progress, Study
from core.geometry.grid import VoxelGrid
from core.hull.view import View
from core.hull.votes import VoteCounts
from core.measurement.observability import observability
from core.radar.scatterers import surface_scatterers
from core.targets import Target, tiangong_like

GROWTH = (1, 2, 4, 8)

PRESENT = (1, 2)
"""After so many passes the next one is chosen."""

MOST_CANDIDATES = 8

LEAST_PASSES = 6
"""The shared pass must be among them, and a rank correlation needs four candidates."""

Frames = dict[str, list[OutlinedFrame]]


def run_passes(
    *,
    passes: int = 10,
    frames: int = 12,
    spacing_m: float = 0.2,
    scatterers: int = 60_000,
    signal_to_noise_db: float = 20.0,
    seed: int = 1,
    progress: Progress = lambda _stage, _done, _total: None,
) -> Study:
    """Carve an Earth-pointing target from more and more passes, stations, and the best next pass.

    The target flies on Tiangong-1's orbit of March 2016. First Beijing's passes come one after
    another; then one pass is seen by Beijing, Shanghai and Xi'an and by the bistatic pair of
    Beijing (transmits) and Shanghai (receives); then, after one and after two passes, each later
    pass is ranked by what it is predicted to carve, and confirmed by its echoes. A prediction
    knows the present hull, how it was seen, and the candidate's lines of sight.

    Args:
        passes: over Beijing, in order, that are observed; the last ones are candidates only.
        frames: of each pass, evenly chosen.
        spacing_m: voxel spacing.
        scatterers: points on the target's surface.
        signal_to_noise_db: as in `simulate_echoes`.
        seed: of the random generator.
        progress: told of stage, steps done and steps in all.

    Raises:
        ValueError: fewer than six passes or two frames, or parameters a stage refuses.
    """
    if passes < LEAST_PASSES or frames < 2:
        raise ValueError(
            f"This experiment needs at least {LEAST_PASSES} passes of 2 frames, to rank four "
            f"candidates; got {passes} of {frames}."
        )
    target, network = tiangong_like(), observing_network(passes, frames)
    found = _observed(network, target, scatterers, signal_to_noise_db, seed, progress)
    grid = VoxelGrid.cube(side_m=SIDE_M, spacing_m=spacing_m)
    truth = target.voxels(grid)
    growth = {_passes_text(count): network.beijing[:count] for count in GROWTH if count <= passes}
    together = network.together()
    hulls = _hulls({**growth, **together}, found, target, grid, truth, progress)
    candidates = {}
    for number, count in enumerate(PRESENT, start=1):
        candidates[count] = next_passes(network.beijing, found, count, grid)
        progress("candidates", number, len(PRESENT))
    settings = {
        "target": target.name,
        **network.settings(),
        "frames per pass": frames,
        "spacing_m": spacing_m,
        "scatterers": scatterers,
        "signal_to_noise_db": signal_to_noise_db,
        "seed": seed,
    }
    seen = Seen(
        true_m3=float(np.count_nonzero(truth)) * spacing_m**3,
        true_extents_m=target.mesh().extents.tolist(),
        growth={name: hulls[name] for name in growth},
        together={name: hulls[name] for name in together},
        bistatic_deg=network.bistatic_deg(),
        candidates=candidates,
    )
    pictures = passes_pictures(
        seen,
        [each for arc in network.beijing[: max(GROWTH)] for each in found[arc.label]],
        network.sky(),
        target,
    )
    most = list(growth)[-1]
    return Study(
        results=passes_results(seen, settings),
        pictures=pictures,
        hull=hulls[most].echoes.surface,
    )


def next_passes(
    arcs: Sequence[Arc], found: Mapping[str, Sequence[OutlinedFrame]], count: int, grid: VoxelGrid
) -> tuple[Candidate, ...]:
    """Rank the passes after the first `count` by prediction, and confirm each by its echoes.

    Args:
        arcs: passes in order.
        found: outlined frames by the arc's label; a candidate's serve its confirmation alone.
        count: passes already observed.
        grid: to carve on.
    """
    views = {arc.label: radar_views(found[arc.label], "shadow") for arc in arcs}
    present = [view for arc in arcs[:count] for view in views[arc.label]]
    volume = VoteCounts(grid)
    volume.add_many(present)
    inside, voxel_m3 = volume.hull(), grid.spacing_m**3
    points_m = hull_points_m(inside, grid)
    seen = [
        aspect for arc in arcs[:count] for aspect in predicted_aspects(arc.track, arc.intervals)
    ]
    body = compact_body(points_m, seen, grid.spacing_m)
    radius_m = float(np.ptp(points_m, axis=0).min()) / 2
    now_m3 = _ball_m3(present, radius_m)
    candidates = []
    for arc in arcs[count : count + MOST_CANDIDATES]:
        aspects = predicted_aspects(arc.track, arc.intervals)
        carved = carved_voxels(points_m, body, aspects, grid.spacing_m)
        lit = [predicted_view(aspect) for aspect in aspects]
        numbers = volume.add_many(views[arc.label])
        left = np.count_nonzero(volume.hull())
        for number in numbers:
            volume.remove(number)
        candidates.append(
            Candidate(
                label=arc.label,
                elevation_deg=float(arc.highest_elevation_deg() or 0.0),
                predicted_m3=float(np.count_nonzero(carved)) * voxel_m3,
                ball_m3=now_m3 - _ball_m3([*present, *lit], radius_m),
                confirmed_m3=float(np.count_nonzero(inside) - left) * voxel_m3,
            )
        )
    return tuple(candidates)


def _observed(
    network: Network,
    target: Target,
    scatterers: int,
    signal_to_noise_db: float,
    seed: int,
    progress: Progress,
) -> Frames:
    """Return the outlined frames of every arc, from echoes, by its label."""
    arcs = network.arcs()
    of_target, *of_noise = np.random.default_rng(seed).spawn(1 + len(arcs))
    points = surface_scatterers(target, count=scatterers, random=of_target)
    found: Frames = {}
    for number, (arc, random) in enumerate(zip(arcs, of_noise, strict=True), start=1):
        found[arc.label] = outlined_frames(
            arc, points, network.waveform, signal_to_noise_db=signal_to_noise_db, random=random
        )
        progress("echoes and images", number, len(arcs))
    return found


def _hulls(
    sets: Mapping[str, Sequence[Arc]],
    found: Frames,
    target: Target,
    grid: VoxelGrid,
    truth: NDArray[np.bool_],
    progress: Progress,
) -> dict[str, SeenHull]:
    """Carve the hull of each set of arcs, from echoes and from the true outlines."""
    outlines: dict[str, list[View]] = {}
    hulls = {}
    for number, (name, arcs) in enumerate(sets.items(), start=1):
        for arc in arcs:
            if arc.label not in outlines:
                outlines[arc.label] = true_views(found[arc.label], target)
        views, true = [], []
        for arc in arcs:
            views += radar_views(found[arc.label], "shadow")
            true += outlines[arc.label]
        echoes: CarvedHull = carved_hull(views, grid, truth)
        hulls[name] = SeenHull(
            views=tuple(views),
            echoes=echoes,
            true=carved_hull(true, grid, truth),
            unobserved_percent=unobserved_percent(views),
        )
        progress("hulls", number, len(sets))
    return hulls


def _ball_m3(views: Sequence[View], radius_m: float) -> float:
    return ball_hull_volume(observability(views), radius_m=radius_m, side_m=SIDE_M)


def _passes_text(count: int) -> str:
    return "1 pass" if count == 1 else f"{count} passes"
