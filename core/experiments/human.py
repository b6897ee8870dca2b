"""The paper's experiment D: a person with a knife, seen in the near field from all around."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from core.experiments.hull_pictures import error_pictures
from core.experiments.human_knife import BrightPartSettings, bright_part
from core.experiments.human_measures import (
    MAY_MISS,
    PersonHull,
    PersonMeasures,
    person_hull,
    true_measures,
)
from core.experiments.human_pictures import person_frames_picture, person_sides_picture
from core.experiments.human_scene import (
    COVER_DB,
    COVER_NOISE_DB,
    KNIFE_DB,
    RANGE_M,
    Scene,
    curved_view,
    scene_frames,
    true_outlines,
)
from core.experiments.results import Figure, Results, Table
from core.experiments.study import Progress, Study
from core.frame import Frame
from core.geometry.grid import VoxelGrid
from core.hull.distance_hull import CurvedView
from core.hull.shadow import CarvingRule, carving_view
from core.hull.view import View
from core.human_body import standing_person
from core.measurement.observability import observability
from core.radar.circular_sar import NearFieldSettings
from core.silhouettes.extraction import ExtractionSettings, extract_silhouette
from core.silhouettes.silhouette import Silhouette

HALF_BOX_M = (0.32, 0.38, 1.05)
"""Half sides of the grid, which holds any person of ordinary size."""

USUAL_PIXEL_M = 0.005
"""A resolution cell has 5 × 5 of these pixels: gaps and specks have more of them than in the
usual frame."""

CLEAN, STRICT, COVERED, PLANE, TRUE = (
    "shadow rule",
    "strict rule",
    "under a cover",
    "as if waves were plane",
    "true outlines",
)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Outlined:
    """Frames with the silhouettes of the whole and of the knife, empty where it is not seen."""

    frames: Sequence[Frame]
    body: Sequence[Silhouette]
    knife: Sequence[Silhouette]

    def body_views(self, rule: CarvingRule) -> list[CurvedView]:
        """Return what votes for the body."""
        return [curved_view(f, _voting(s, f, rule).silhouette) for f, s in self._seen(self.body)]

    def knife_views(self) -> list[CurvedView]:
        """Return what votes for the knife: only frames that show it, and as they show it.

        What is as thin as a blade does not shade itself: its lit side is all of it. Filled away
        from the radar, outlines of frames from the front alone would reach into the body.
        """
        return [curved_view(f, s) for f, s in self._seen(self.knife)]

    def votes(self, outlines: Sequence[Silhouette], rule: CarvingRule) -> list[View]:
        """Return views, as if far away, that say which directions are constrained."""
        return [_voting(s, f, rule) for f, s in self._seen(outlines)]

    def _seen(self, outlines: Sequence[Silhouette]) -> list[tuple[Frame, Silhouette]]:
        pairs = zip(self.frames, outlines, strict=True)
        return [(frame, outline) for frame, outline in pairs if not outline.is_empty]


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
        figures=tuple(_figures(hulls, seen, real)),
        tables=(_table(hulls, real), _directions_table(seen[CLEAN])),
        finding=_finding(hulls, seen, real),
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


def _voting(silhouette: Silhouette, frame: Frame, rule: CarvingRule) -> View:
    return carving_view(View(silhouette=silhouette, projection=frame.projection), rule)


def _as_if_far(seen: Outlined) -> list[CurvedView]:
    """Return the body's views with the affine projection, which forgets that range is curved."""
    return [
        CurvedView(silhouette=view.silhouette, image_points=view.projection.image_points)
        for view in seen.votes(seen.body, "shadow")
    ]


def _errors(found: PersonMeasures, real: PersonMeasures) -> dict[str, tuple[float | None, str]]:
    """Return every measure's error by its name, with its unit."""

    def less(one: float | None, two: float | None) -> float | None:
        return None if one is None or two is None else 1e3 * (one - two)

    offset, true_offset = found.knife_offset_m(), real.knife_offset_m()
    off = None
    if offset is not None and true_offset is not None:
        off = 1e3 * float(np.linalg.norm(offset - true_offset))
    return {
        "height error": (less(found.height_m, real.height_m), "mm"),
        "shoulder width error": (less(found.shoulder_m, real.shoulder_m), "mm"),
        "knife length error": (less(found.knife_m, real.knife_m), "mm"),
        "knife direction error": (found.knife_angle_deg(real), "°"),
        "knife height above the feet, error": (
            less(found.knife_height_m(), real.knife_height_m()),
            "mm",
        ),
        "knife offset from the axis, error": (off, "mm"),
    }


def _figures(
    hulls: Mapping[str, PersonHull], seen: Mapping[str, Outlined], real: PersonMeasures
) -> list[Figure]:
    figures = []
    for name, hull in hulls.items():
        agreement = hull.agreement
        figures += [
            Figure(name=f"{name}: IoU", value=agreement.intersection_over_union),
            Figure(name=f"{name}: coverage", value=agreement.coverage),
        ]
        for what, (value, unit) in _errors(hull.measures, real).items():
            if name in (CLEAN, COVERED, TRUE) or not what.startswith("knife"):
                figures.append(Figure(name=f"{name}: {what}", value=value, unit=unit))
    for name, each in seen.items():
        shown = sum(not outline.is_empty for outline in each.knife)
        figures.append(Figure(name=f"{name}: frames with a bright part", value=shown))
    return figures


def _table(hulls: Mapping[str, PersonHull], real: PersonMeasures) -> Table:
    rows = [("truth", "1.000", "1.000", *_cells(real))]
    for name, hull in hulls.items():
        shares = (hull.agreement.intersection_over_union, hull.agreement.coverage)
        rows.append((name, *(f"{share:.3f}" for share in shares), *_cells(hull.measures)))
    return Table(
        title="A person and a knife against the truth",
        columns=(
            "outlines",
            "IoU",
            "coverage",
            "height (m)",
            "shoulders (m)",
            "knife (m)",
            "its direction",
            "above the feet (m)",
            "off the axis, x and y (m)",
        ),
        rows=tuple(rows),
    )


def _cells(measures: PersonMeasures) -> tuple[str, ...]:
    lengths = (measures.height_m, measures.shoulder_m, measures.knife_m, measures.knife_height_m())
    height, shoulder, knife, above = ("" if v is None else f"{v:.3f}" for v in lengths)
    direction, offset = measures.knife_direction, measures.knife_offset_m()
    return (
        height,
        shoulder,
        knife,
        "" if direction is None else _vector(direction * (1 if direction[1] >= 0 else -1)),
        above,
        "" if offset is None else _vector(offset),
    )


def _vector(values: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> str:
    return f"({', '.join(f'{value:+.3f}' for value in values)})"


def _directions_table(seen: Outlined) -> Table:
    above = [frame.line_of_sight[2] > 0 for frame in seen.frames]
    votes = seen.votes(seen.body, "shadow")
    only_above = [view for view, is_above in zip(votes, above, strict=False) if is_above]
    rows: list[tuple[str, ...]] = []
    for name, views in (
        ("body, both circles", votes),
        ("body, circle above alone", only_above),
        ("knife, frames that show it", seen.votes(seen.knife, "strict")),
    ):
        if not views:
            rows.append((name, "no views", "no views", "no views"))
            continue
        constrained = observability(views)
        rows.append(
            (
                name,
                *(
                    f"{constrained.grade(axis)} ({constrained.dilution(axis):.2f})"
                    for axis in np.eye(3)
                ),
            )
        )
    return Table(
        title="Directions: grade and dilution",
        columns=("views", "x forward", "y right", "z down"),
        rows=tuple(rows),
    )


def _finding(
    hulls: Mapping[str, PersonHull], seen: Mapping[str, Outlined], real: PersonMeasures
) -> str:
    parts = []
    for name, title in ((CLEAN, "Bare"), (COVERED, f"Under {COVER_DB:g} dB of cover")):
        errors = _errors(hulls[name].measures, real)
        texts = [
            f"{what} {'none, it was not found' if value is None else f'{value:+.1f} {unit}'}"
            for what, (value, unit) in errors.items()
        ]
        shown = sum(not outline.is_empty for outline in seen[name].knife)
        parts.append(
            f"{title}: IoU {hulls[name].agreement.intersection_over_union:.3f}, "
            f"{', '.join(texts)}, a bright part in {shown} of {len(seen[name].frames)} frames."
        )
    strict, floor = hulls[STRICT].agreement, hulls[TRUE].agreement
    return (
        f"{' '.join(parts)} The strict rule keeps {100 * strict.coverage:.0f} % of the body; true "
        f"outlines give IoU {floor.intersection_over_union:.3f}. One circle from above leaves the "
        "soles unobserved under the shadow rule, so that a circle below is needed for a height."
    )
