"""The paper's experiment D: a person with a knife, seen in the near field from all around."""

import numpy as np

from core.experiments.hull_pictures import error_pictures
from core.experiments.human_knife import BrightPartSettings, bright_part
from core.experiments.human_measures import (
    MAY_MISS,
    person_hull,
    true_measures,
)
from core.experiments.human_outlined import Outlined
from core.experiments.human_pictures import person_frames_picture, person_sides_picture
from core.experiments.human_results import (
    CLEAN,
    COVERED,
    PLANE,
    STRICT,
    TRUE,
    directions_table,
    figures_of,
    finding_of,
    people_table,
)
from core.experiments.human_scene import (
    COVER_DB,
    COVER_NOISE_DB,
    KNIFE_DB,
    RANGE_M,
    Scene,
    scene_frames,
    true_outlines,
)
from core.experiments.results import Results
from core.experiments.study import Progress, Study
from core.frame import Frame
from core.geometry.grid import VoxelGrid
from core.hull.distance_hull import CurvedView
from core.human_body import standing_person
from core.radar.circular_sar import NearFieldSettings
from core.silhouettes.extraction import ExtractionSettings, extract_silhouette

HALF_BOX_M = (0.32, 0.38, 1.05)
"""Half sides of the grid, which holds any person of ordinary size."""

USUAL_PIXEL_M = 0.005
"""A resolution cell has 5 × 5 of these pixels: gaps and specks have more of them than in the
usual frame."""


def run_human(
    *,
    spacing_m: float = 0.01,
    scatterers: int = 30_000,
    signal_to_noise_db: float = 20.0,
    pulses: int = 720,
    imaging: NearFieldSettings | None = None,
    seed: int = 1,
    progress: Progress = lambda _stage, _done, _total: None,
) -> Study:
    """Carve a person and the knife on them from near-field echoes, bare and under a cover.

    The knife is found in every frame by its brightness over the body; its own hull is carved from
    those outlines. True outlines of the same frames are the floor.

    Args:
        spacing_m: voxel spacing of the body's hull.
        scatterers: points on the body; a tenth as many on the knife.
        signal_to_noise_db: as in `simulate_near_field`, before a cover takes its share.
        pulses: per circle.
        imaging: of the frames; the usual, half overlapping, unless given.
        seed: of the random generator.
        progress: told of stage, steps done and steps in all.

    Raises:
        ValueError: parameters a stage refuses.
    """
    person = standing_person()
    scene = Scene(
        person=person,
        imaging=imaging or NearFieldSettings(overlap=0.5),
        pulses=pulses,
        scatterers=scatterers,
        signal_to_noise_db=signal_to_noise_db,
    )
    losses_db = {CLEAN: 0.0, COVERED: COVER_DB + COVER_NOISE_DB}
    seen = {
        name: _outlined(
            scene_frames(scene, loss_db=loss_db, seed=seed, what=name, progress=progress),
            scene.imaging.pixel_spacing_m,
        )
        for name, loss_db in losses_db.items()
    }
    bare = seen[CLEAN]
    exact = Outlined(
        frames=bare.frames,
        body=true_outlines(bare.frames, person.mesh()),
        knife=true_outlines(bare.frames, scene.knife()),
    )
    half = np.array(HALF_BOX_M)
    grid = VoxelGrid.over(lower_m=-half, upper_m=half, spacing_m=spacing_m)
    truth = person.voxels(grid)
    voting: dict[str, tuple[list[CurvedView], list[CurvedView], float]] = {
        CLEAN: (bare.body_views("shadow"), bare.knife_views(), MAY_MISS),
        STRICT: (bare.body_views("strict"), [], MAY_MISS),
        PLANE: (_as_if_far(bare), [], MAY_MISS),
        COVERED: (seen[COVERED].body_views("shadow"), seen[COVERED].knife_views(), MAY_MISS),
        TRUE: (exact.body_views("strict"), exact.knife_views(), 0.0),
    }
    hulls = {}
    for number, (name, (body, knife, may_miss)) in enumerate(voting.items(), start=1):
        hulls[name] = person_hull(body, knife, grid, truth, may_miss=may_miss)
        progress("hulls", number, len(voting))
    real = true_measures(person)
    ours = hulls[CLEAN]
    results = Results(
        name="human",
        settings={
            "target": person.name,
            "range_m": RANGE_M,
            "circles": ", ".join(f"{each:+g}°" for each in scene.elevations_deg),
            "frames": len(bare.frames),
            "pulses per circle": pulses,
            "knife over skin (dB, assumed)": KNIFE_DB,
            "cover (dB, two-way) and added noise (dB)": f"{COVER_DB:g}, {COVER_NOISE_DB:g}",
            "spacing_m": spacing_m,
            "scatterers": scatterers,
            "signal_to_noise_db": signal_to_noise_db,
            "seed": seed,
        },
        figures=tuple(figures_of(hulls, seen, real)),
        tables=(people_table(hulls, real), directions_table(seen[CLEAN])),
        finding=finding_of(hulls, seen, real),
    )
    pictures = (
        person_frames_picture(
            {"bare": bare, "cover": seen[COVERED]}, exact.body, exact.knife, name="human-frames"
        ),
        person_sides_picture(ours, person, name="human-hull"),
        *error_pictures(ours.body, person, name="human-errors", most_m=0.1),
    )
    return Study(results=results, pictures=pictures, hull=ours.body)


def _outlined(frames: list[Frame], pixel_m: float) -> Outlined:
    finer = USUAL_PIXEL_M / pixel_m
    extraction = ExtractionSettings(
        closing_px=round(11 * finer), smallest_part_px=round(200 * finer**2)
    )
    bright = BrightPartSettings.at(finer)
    body = [extract_silhouette(frame, extraction) for frame in frames]
    knife = [bright_part(frame, whole, bright) for frame, whole in zip(frames, body, strict=True)]
    return Outlined(frames=frames, body=body, knife=knife)


def _as_if_far(seen: Outlined) -> list[CurvedView]:
    """Return the body's views with the affine projection, which forgets that range is curved."""
    return [
        CurvedView(silhouette=view.silhouette, image_points=view.projection.image_points)
        for view in seen.votes(seen.body, "shadow")
    ]
