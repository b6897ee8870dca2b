"""Targets that shadow themselves, seen from all around and from narrower scopes."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import trimesh

from core.arrays import Floats
from core.experiments.frame_pictures import OutlinedFrame
from core.experiments.mro_scene import echo_frames
from core.experiments.study import Progress
from core.experiments.wide import simulated_frames
from core.geometry.grid import VoxelGrid
from core.silhouettes.extraction import extract_silhouette
from core.targets import LineFeature, Target, mro_like, tiangong_like

CONE_DEG = 60.0
BELT_DEG = 30.0
_CONE: Floats = np.array([1.0, 1.0, 1.0]) / np.sqrt(3)

SCOPES: Mapping[str, Callable[[Floats], bool]] = {
    "all around": lambda _look: True,
    "half the sphere": lambda look: bool(look[2] > 0),
    f"belt of ±{BELT_DEG:g}°": lambda look: bool(abs(look[2]) < np.sin(np.deg2rad(BELT_DEG))),
    f"cone of {CONE_DEG:g}°": lambda look: bool(look @ _CONE > np.cos(np.deg2rad(CONE_DEG))),
}
"""Which unit lines of sight (3,) belong to a scope."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Scene:
    """A target, how coarsely it is carved, and its frames from all around with silhouettes."""

    target: Target
    spacing_m: float
    found: tuple[OutlinedFrame, ...]

    def within(self, scope: str, most: int) -> list[OutlinedFrame]:
        """Return the first frames whose line of sight is in a scope."""
        inside = [each for each in self.found if SCOPES[scope](each.frame.line_of_sight)]
        return inside[:most]

    def grid(self) -> VoxelGrid:
        """Return a grid that the target fits in with 2 m to spare."""
        reach_m = 2.0 + np.abs(self.target.mesh().vertices).max(axis=0)
        return VoxelGrid.over(lower_m=-reach_m, upper_m=reach_m, spacing_m=self.spacing_m)


def winged_box() -> Target:
    """Return a box with four skew wings and a mast, which hide each other from most sides."""
    box = trimesh.creation.box(extents=(4.0, 3.0, 3.0))
    wings = []
    for number in range(4):
        wing = trimesh.creation.box(extents=(0.15, 7.5, 3.2))
        wing.apply_translation([0.0, 4.6, 0.0])
        turn = trimesh.transformations.rotation_matrix(np.deg2rad(90 * number), [1, 0, 0])
        tilt = trimesh.transformations.rotation_matrix(np.deg2rad(35), [0, 1, 0])
        wing.apply_transform(turn @ tilt)
        wings.append(wing)
    mast = trimesh.creation.cylinder(radius=0.3, height=5.0, sections=32)
    mast.apply_transform(trimesh.geometry.align_vectors([0, 0, 1], [1, 0, 0]))
    mast.apply_translation([4.0, 0.0, 0.0])
    span_m = 2 * (4.6 + 7.5 / 2)
    return Target(
        name="box with four wings",
        parts=(box, *wings, mast),
        features=(LineFeature(name="span", length_m=span_m, direction=np.array([0.0, 1.0, 0.0])),),
    )


TARGETS: Mapping[str, Callable[[], Target]] = {
    "laboratory": tiangong_like,
    "winged box": winged_box,
    "orbiter": mro_like,
}
"""By what an experiment calls them; each hides parts of itself from most sides."""


def scene(
    name: str,
    *,
    views: int,
    spacing_m: float,
    scatterers: int,
    signal_to_noise_db: float,
    seed: int,
    progress: Progress,
) -> Scene:
    """Return a target's scene.

    Args:
        name: "laboratory", "winged box" or "orbiter".
        views: from all around.
        spacing_m: voxel spacing; the orbiter, 58 m wide, has twice as much.
        scatterers: points on the surface.
        signal_to_noise_db: as in `simulate_echoes`.
        seed: of the random generator.
        progress: told of stage, steps done and steps in all.

    Raises:
        ValueError: another name, or parameters a stage refuses.
    """
    if name not in TARGETS:
        raise ValueError(f'Targets are {", ".join(TARGETS)}; got "{name}".')
    target, is_large = TARGETS[name](), name == "orbiter"

    def told(stage: str, done: int, total: int) -> None:
        progress(f"{stage} of the {name}", done, total)

    if is_large:
        images = echo_frames(
            target,
            views=views,
            scatterers=scatterers,
            signal_to_noise_db=signal_to_noise_db,
            seed=seed,
            resolution_m=0.3,
            progress=told,
        )
    else:
        images = simulated_frames(
            target,
            views=views,
            scatterers=scatterers,
            signal_to_noise_db=signal_to_noise_db,
            random=np.random.default_rng(seed),
            progress=told,
        )
    found = [OutlinedFrame(frame=each, silhouette=extract_silhouette(each)) for each in images]
    return Scene(
        target=target,
        spacing_m=2 * spacing_m if is_large else spacing_m,
        found=tuple(each for each in found if not each.silhouette.is_empty),
    )
