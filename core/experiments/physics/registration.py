"""Registration from echoes with unknown offsets, held against the offsets that were put in.

Offsets enter as tracking errors of the echoes; the stages see frames whose projections know
nothing of them. The truth enters the comparison alone, after the one translation of the whole
target that no image can tell.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.experiments.demo import FRAMES_PER_PASS, demo_frames
from core.experiments.physics.bad_silhouettes import cut_in_half, streaked
from core.experiments.physics.part import Part, Progress
from core.experiments.physics.registration_pictures import (
    offsets_picture,
    passes_picture,
    residuals_picture,
)
from core.experiments.results import Figure
from core.experiments.wide import simulated_frames
from core.geometry.grid import VoxelGrid
from core.hull.shadow import carving_view
from core.hull.view import View
from core.hull.volume import VoteVolume
from core.measurement.comparison import voxel_agreement
from core.radar.imaging import ImagingSettings
from core.registration.centroid import centroid_registered
from core.registration.registration import Registration, moved, registered
from core.silhouettes.extraction import extract_silhouette
from core.targets import Target, tiangong_like

SEED = 1
REACH_PX = 20.0
BAD_SHARE = 0.1
DRIFT_PX = np.array([15.0, -10.0])
"""Over one pass of the demo, in range and cross-range."""
JUMP_PX = np.array([6.0, 4.0])
"""In the middle of each."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Trial:
    """Views with offsets that are known here and nowhere else.

    Attributes:
        views: as they came, with projections that know no offset.
        offsets_px: (views, 2) true ones.
        registration: what was found.
    """

    views: tuple[View, ...]
    offsets_px: Floats
    registration: Registration

    def left_px(self, found_px: Floats, among: NDArray[np.bool_] | None = None) -> Floats:
        """Return what offsets leave (views, 2) after the translation that is best `among` some."""
        chosen = np.ones(len(self.views), dtype=np.bool_) if among is None else among
        matrix = np.array([view.projection.matrix[:, :3] for view in self.views])
        wrong = found_px - self.offsets_px
        translation = np.linalg.lstsq(matrix[chosen].reshape(-1, 3), wrong[chosen].ravel())[0]
        left: Floats = wrong - matrix @ translation
        return left

    def centroid_offsets_px(self) -> Floats:
        """Return the offsets (views, 2) that the paper's rule gives."""
        return np.array(
            [
                centroid_registered(view.silhouette, view.projection).matrix[:, 3]
                - view.projection.matrix[:, 3]
                for view in self.views
            ]
        )


def registration_part(
    progress: Progress,
    *,
    views: int = 80,
    scatterers: int = 30_000,
    demo_scatterers: int = 15_000,
    spacing_m: float = 0.15,
) -> Part:
    """Register frames with random offsets, with bad silhouettes, and of passes that drift.

    Args:
        progress: told of stage, steps done and steps in all.
        views: random directions around the target.
        scatterers: points on its surface.
        demo_scatterers: the same for the demo's three passes; 0 leaves them out.
        spacing_m: voxel spacing of the hulls that are compared.
    """
    target = tiangong_like()
    random = np.random.default_rng(SEED)
    trial = _trial(target, views, scatterers, random, progress)
    spoilt = _spoilt(trial, random)
    progress("registration", 2, 2)
    figures = [*_offset_figures(trial), *_hull_figures(trial, target, spacing_m, progress)]
    figures += _spoilt_figures(trial, spoilt)
    pictures = [
        offsets_picture(
            trial.offsets_px,
            trial.left_px(trial.registration.offsets_px),
            trial.left_px(trial.centroid_offsets_px()),
        ),
        residuals_picture(
            trial.left_px(trial.registration.offsets_px),
            trial.left_px(trial.centroid_offsets_px()),
            spoilt.left_px(spoilt.registration.offsets_px, ~_is_spoilt(trial, spoilt)),
            _is_spoilt(trial, spoilt),
        ),
    ]
    if demo_scatterers:
        passes = _passes(demo_scatterers, progress)
        figures += _pass_figures(passes)
        left = passes.left_px(passes.registration.offsets_px)
        pictures.append(
            passes_picture(passes.offsets_px, left, passes.registration.is_bad, FRAMES_PER_PASS)
        )
    return Part(figures=tuple(figures), pictures=tuple(pictures))


def _trial(
    target: Target, views: int, scatterers: int, random: np.random.Generator, progress: Progress
) -> Trial:
    offsets_px = random.uniform(-REACH_PX, REACH_PX, (views, 2))
    images = simulated_frames(
        target,
        views=views,
        scatterers=scatterers,
        signal_to_noise_db=20.0,
        random=random,
        tracking_error_m=offsets_px * ImagingSettings().pixel_spacing_m,
        progress=progress,
    )
    seen = [
        View(silhouette=extract_silhouette(image), projection=image.projection) for image in images
    ]
    progress("registration", 0, 2)
    found = registered(seen)
    progress("registration", 1, 2)
    return Trial(views=tuple(seen), offsets_px=offsets_px, registration=found)


def _offset_figures(trial: Trial) -> list[Figure]:
    left = trial.left_px(trial.registration.offsets_px)
    extents = registered(trial.views, refinements=0)
    return [
        Figure(name="residual per axis", value=_rms(left), unit="px", wanted="<= 0.5 px"),
        Figure(name="residual per axis, centroid alone", value=_centroid_rms(trial), unit="px"),
        Figure(
            name="residual per axis, extents without the hull",
            value=_rms(trial.left_px(extents.offsets_px)),
            unit="px",
        ),
        Figure(name="residual, both axes together", value=np.sqrt(2) * _rms(left), unit="px"),
        Figure(
            name="residual of the worst frame",
            value=float(np.linalg.norm(left, axis=1).max()),
            unit="px",
        ),
    ]


def _rms(values: Floats) -> float:
    return float(np.sqrt(np.mean(values**2)))


def _centroid_rms(trial: Trial) -> float:
    return _rms(trial.left_px(trial.centroid_offsets_px()))


def _hull_figures(
    trial: Trial, target: Target, spacing_m: float, progress: Progress
) -> list[Figure]:
    grid = VoxelGrid.cube(side_m=21.0, spacing_m=spacing_m)
    truth = target.voxels(grid)
    votes = ~trial.registration.is_bad
    shifts = {
        "with true offsets": np.zeros_like(trial.offsets_px),
        "by agreement": trial.left_px(trial.registration.offsets_px),
        "by centroid alone": trial.left_px(trial.centroid_offsets_px()),
    }
    overlap = {}
    for number, (name, left) in enumerate(shifts.items(), start=1):
        volume = VoteVolume(grid)
        placed = _carving(trial, left)
        volume.add_many([placed[view] for view in np.flatnonzero(votes)])
        overlap[name] = voxel_agreement(volume.hull(), truth).intersection_over_union
        progress("hulls", number, len(shifts))
    lost = abs(overlap["with true offsets"] - overlap["by agreement"])
    return [
        Figure(name="hull IoU, difference to the registered one", value=lost, wanted="<= 0.02"),
        *(Figure(name=f"hull IoU, {name}", value=value) for name, value in overlap.items()),
    ]


def _carving(trial: Trial, left_px: Floats) -> list[View]:
    """Return the views where they stand but for what registration left."""
    places = zip(trial.views, trial.offsets_px + left_px, strict=True)
    return [
        carving_view(replace(view, projection=moved(view.projection, place)), "shadow")
        for view, place in places
    ]


def _spoilt(trial: Trial, random: np.random.Generator) -> Trial:
    """Return the trial with a tenth of its silhouettes cut in half or crossed by a streak."""
    count = round(BAD_SHARE * len(trial.views))
    views = list(trial.views)
    for number, view in enumerate(random.choice(len(views), count, replace=False)):
        spoil = (cut_in_half, streaked)[number % 2]
        views[view] = spoil(views[view])
    return replace(trial, views=tuple(views), registration=registered(views))


def _is_spoilt(trial: Trial, spoilt: Trial) -> NDArray[np.bool_]:
    pairs = zip(trial.views, spoilt.views, strict=True)
    return np.array([before is not after for before, after in pairs])


def _spoilt_figures(trial: Trial, spoilt: Trial) -> list[Figure]:
    bad = _is_spoilt(trial, spoilt)
    left = spoilt.left_px(spoilt.registration.offsets_px, ~bad)
    told = spoilt.registration.is_bad
    return [
        Figure(
            name="residual per axis of good frames, 10 % bad silhouettes",
            value=_rms(left[~bad]),
            unit="px",
            wanted="<= 0.5 px",
        ),
        Figure(
            name="residual per axis of good frames, 10 % bad, centroid alone",
            value=_rms(spoilt.left_px(spoilt.centroid_offsets_px(), ~bad)[~bad]),
            unit="px",
        ),
        Figure(name="bad silhouettes found", value=100 * float(np.mean(told[bad])), unit="%"),
        Figure(name="good ones taken for bad", value=100 * float(np.mean(told[~bad])), unit="%"),
    ]


def _passes(scatterers: int, progress: Progress) -> Trial:
    """Return the demo's three passes, each drifting from its start and jumping in its middle."""
    views = []
    for number, frame in enumerate(demo_frames(scatterers=scatterers), start=1):
        views.append(View(silhouette=extract_silhouette(frame), projection=frame.projection))
        progress("passes", number, 3 * FRAMES_PER_PASS)
    share = (np.arange(len(views)) % FRAMES_PER_PASS) / (FRAMES_PER_PASS - 1)
    offsets = share[:, None] * DRIFT_PX + (share > 0.5)[:, None] * JUMP_PX
    # The tracking errors that echoes would have had: the image is moved, the projection is not.
    seen = [
        replace(view, projection=moved(view.projection, -offset))
        for view, offset in zip(views, offsets, strict=True)
    ]
    return Trial(views=tuple(seen), offsets_px=offsets, registration=registered(seen))


def _pass_figures(passes: Trial) -> list[Figure]:
    figures = []
    left = passes.left_px(passes.registration.offsets_px)
    for axis, name in enumerate(("range", "cross-range")):
        figures.append(
            Figure(name=f"three passes, residual in {name}", value=_rms(left[:, axis]), unit="px")
        )
    for number in range(3):
        one = slice(number * FRAMES_PER_PASS, (number + 1) * FRAMES_PER_PASS)
        alone = Trial(
            views=passes.views[one],
            offsets_px=passes.offsets_px[one],
            registration=registered(passes.views[one]),
        )
        left = alone.left_px(alone.registration.offsets_px)
        name = f"pass {number + 1} alone"
        figures += [
            Figure(name=f"{name}, widest angle of planes", value=_widest_deg(alone), unit="°"),
            Figure(name=f"{name}, residual in range", value=_rms(left[:, 0]), unit="px"),
            Figure(name=f"{name}, residual in cross-range", value=_rms(left[:, 1]), unit="px"),
        ]
    return figures


def _widest_deg(trial: Trial) -> float:
    """Return the widest angle between two image planes; at 0° nothing ties cross-ranges exactly."""
    normals = np.array([view.projection.viewing_direction() for view in trial.views])
    cosine = np.abs(normals @ normals.T).min()
    return float(np.rad2deg(np.arccos(min(cosine, 1.0))))
