"""A person with a knife before an antenna that goes round: echoes, frames, true outlines."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np
import trimesh

from core.arrays import Floats
from core.experiments.study import Progress
from core.frame import Frame
from core.hull.distance_hull import CurvedView
from core.radar.circular_sar import (
    NearFieldSettings,
    body_waveform,
    circular_track,
    simulate_near_field,
    sub_apertures,
)
from core.radar.scatterers import Scatterers, surface_scatterers
from core.radar.upright import near_image_points, upright_frames
from core.silhouettes.contours import traced_rings
from core.silhouettes.silhouette import Silhouette
from core.targets import Target

RANGE_M = 6.0
"""From the antenna to the body's middle."""

ELEVATION_DEG = 60.0
"""Of the circle above and of the one below. Heights are told apart by range times sin θ alone: a
length along z is diluted by 1 / sin θ, 2 at 30° and 1.15 here. Two circles, because a lit side
bounds the body only towards the radar: from above alone nothing bounds the soles."""

PULSES = 720
"""Per circle: 1.2 m across are told apart, and a body with its arms is 0.55 m wide."""

KNIFE_DB = 15.0
"""Power of the knife's surface over that of skin. Skin, of relative permittivity 17 − 17j, reflects
0.47 of the power at 27 GHz (Gabriel, Lau and Gabriel, 1996, by Fresnel's formula), metal all of it:
3.3 dB. The rest stands for the edges and for the corner between blade and body, which a diffuse
surface lacks; it is assumed, not measured."""

COVER_DB = 6.0
"""What a protective cover takes from echoes on their way through it and back. Under 15 dB instead,
in the same noise, CFAR finds a body in pieces: nothing is left of the hull (IoU 0.01), and the
knife is seen in 2 frames of 54."""

COVER_NOISE_DB = 3.0
"""By how much the receiver is noisier in the degraded variant."""

FINER = 4
"""Samples per pixel along each axis when a true outline is drawn."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Scene:
    """How a person is looked at.

    Attributes:
        person: body first, then what it carries.
        imaging: of the frames.
        pulses: per circle.
        scatterers: on the body; the knife has a tenth as many.
        signal_to_noise_db: as in `simulate_near_field`, without a cover.
        elevations_deg: one circle each.
    """

    person: Target
    imaging: NearFieldSettings
    pulses: int
    scatterers: int
    signal_to_noise_db: float
    elevations_deg: tuple[float, ...] = (ELEVATION_DEG, -ELEVATION_DEG)

    def knife(self) -> trimesh.Trimesh:
        """Return blade and handle as one mesh."""
        return trimesh.util.concatenate(list(self.person.parts[1:]))


def scene_frames(
    scene: Scene, *, loss_db: float, seed: int, what: str, progress: Progress
) -> list[Frame]:
    """Return the frames of all circles, one circle after the other, from simulated echoes.

    Args:
        scene: what is seen, and how.
        loss_db: by which a cover and a noisier receiver lower the signal-to-noise ratio.
        seed: of places, phases and noise; the same body for the same seed.
        what: is being done, for the progress.
        progress: told of stage, steps done and steps in all.
    """
    random = np.random.default_rng(seed)
    points = person_scatterers(scene.person, count=scene.scatterers, random=random)
    found: list[Frame] = []
    for number, elevation_deg in enumerate(scene.elevations_deg, start=1):
        history = simulate_near_field(
            points,
            circular_track(
                range_m=RANGE_M,
                elevation_rad=np.deg2rad(elevation_deg),
                azimuth_span_rad=2 * np.pi,
                pulses=scene.pulses,
                duration_s=30.0,
            ),
            body_waveform(),
            signal_to_noise_db=scene.signal_to_noise_db - loss_db,
            random=random,
        )
        label = f"{elevation_deg:+.0f}°"
        count = len(sub_apertures(history, scene.imaging))
        for done, frame in enumerate(upright_frames(history, scene.imaging), start=1):
            found.append(replace(frame, label=label))
            progress(f"{what}, circle {number}", done, count)
    return found


def person_scatterers(person: Target, *, count: int, random: np.random.Generator) -> Scatterers:
    """Return scatterers of skin and, `KNIFE_DB` brighter, of the knife, shaded by the whole."""
    skin, knife = (
        surface_scatterers(Target(name=name, parts=parts), count=number, random=random)
        for name, parts, number in (
            ("body", person.parts[:1], count),
            ("knife", person.parts[1:], max(count // 10, 1)),
        )
    )
    both = (skin, knife.scaled(10 ** (KNIFE_DB / 20)))
    return Scatterers(
        position_m=np.concatenate([part.position_m for part in both]),
        normal=np.concatenate([part.normal for part in both]),
        reflectivity=np.concatenate([part.reflectivity for part in both]),
        mesh=person.mesh(),
    )


def curved_view(frame: Frame, silhouette: Silhouette) -> CurvedView:
    """Return a frame's outline with where points truly appear in it."""
    return CurvedView(
        silhouette=silhouette,
        image_points=lambda points_m: near_image_points(frame, RANGE_M, points_m),
    )


def true_outlines(frames: Sequence[Frame], mesh: trimesh.Trimesh) -> list[Silhouette]:
    """Return the whole outlines that a mesh truly has in near-field frames, to 0.2 pixels."""
    return [_true_outline(frame, mesh) for frame in frames]


def _true_outline(frame: Frame, mesh: trimesh.Trimesh) -> Silhouette:
    corners = near_image_points(frame, RANGE_M, np.asarray(mesh.vertices))[np.asarray(mesh.faces)]
    # The facets that face one way cover what a closed body covers.
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    facing = first[:, 0] * second[:, 1] > first[:, 1] * second[:, 0]
    raster = np.zeros([FINER * size for size in frame.shape], dtype=np.uint8)
    for triangle in _fixed(corners[facing]):
        cv2.fillConvexPoly(raster, triangle, 1, shift=6)
    rings = traced_rings(raster.astype(np.float32), 0.5, simplification_px=0.5)
    return Silhouette(
        rings=tuple((ring + 0.5) / FINER - 0.5 for ring in rings),
        image_shape=frame.shape,
        claim="complete",
        provenance="the truth",
    )


def _fixed(corners: Floats) -> np.ndarray[tuple[int, ...], np.dtype[np.int32]]:
    samples = (corners[..., ::-1] + 0.5) * FINER - 0.5
    return np.round(samples * 2**6).astype(np.int32)
