"""Silhouettes wrong as they are in practice, each extracted from a frame that went wrong."""

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
import trimesh
from scipy.ndimage import gaussian_filter

from core.experiments.frame_pictures import OutlinedFrame
from core.frame import Frame
from core.silhouettes.extraction import ExtractionSettings, extract_silhouette
from core.targets import Target

SMALL, LARGE, SHIFTED, FOREIGN = "too small", "too large", "shifted", "foreign"

MOST_LOST = 0.5
"""Share of the outline's area that a too-high threshold leaves at most."""

CLUTTER_M = 2.0
"""Radius of the clutter that joins the target."""

SHIFT_M = 1.5
"""In range and in cross-range, of a mis-centred frame."""

Fault = Callable[[OutlinedFrame, np.random.Generator], OutlinedFrame]


def too_small(right: OutlinedFrame, _random: np.random.Generator) -> OutlinedFrame:
    """Return the frame as a threshold outlines it that loses half of the target's area."""
    wanted, factor = MOST_LOST * right.silhouette.area_px(), 5.0
    outline = right.silhouette
    while outline.area_px() > wanted:
        factor *= 1.5
        higher = extract_silhouette(right.frame, ExtractionSettings(detection_factor=factor))
        if higher.is_empty:
            break
        outline = higher
    return OutlinedFrame(frame=right.frame, silhouette=outline)


def too_large(right: OutlinedFrame, random: np.random.Generator) -> OutlinedFrame:
    """Return the frame with clutter at the target's edge, as bright as the target, outlined."""
    frame = right.frame
    ring = max(right.silhouette.rings, key=len)
    row, column = ring[random.integers(len(ring))]
    rows, columns = np.indices(frame.shape)
    radius_px = CLUTTER_M / (frame.row_spacing_m or 1.0)
    where = np.hypot(rows - row, columns - column) <= radius_px
    level = float(np.sqrt(np.mean(frame.amplitude[right.silhouette.mask()] ** 2.0)))
    # As wide as the point response, so that it passes for speckle of the target.
    speckle = [gaussian_filter(random.normal(size=frame.shape), 1.2) for _ in range(2)]
    power = np.hypot(*speckle)
    clutter = np.where(where, level * power / np.sqrt(np.mean(power**2)), 0.0)
    return _outlined(replace(frame, amplitude=np.hypot(frame.amplitude, clutter)))


def shifted(right: OutlinedFrame, random: np.random.Generator) -> OutlinedFrame:
    """Return the frame with the target off where its projection says, as tracking errors do."""
    pixels = round(SHIFT_M / (right.frame.row_spacing_m or 1.0))
    signs = random.choice([-1, 1], 2)
    moved = np.roll(right.frame.amplitude, tuple(int(pixels * sign) for sign in signs), (0, 1))
    return _outlined(replace(right.frame, amplitude=moved))


def foreign(strangers: Mapping[float, Frame]) -> Fault:
    """Return the fault that shows another body in a frame's place.

    Args:
        strangers: frames of the other body by time, one for each frame that may go wrong.
    """

    def fault(right: OutlinedFrame, _random: np.random.Generator) -> OutlinedFrame:
        return _outlined(strangers[right.frame.time_s])

    return fault


def spent_stage() -> Target:
    """Return what a radar may track instead of the target: a spent rocket stage, tumbling."""
    stage = trimesh.creation.cylinder(radius=1.3, height=7.5, sections=48)
    stage.apply_transform(trimesh.geometry.align_vectors([0, 0, 1], [0.36, 0.48, 0.8]))
    return Target(name="spent stage", parts=(stage,))


def _outlined(frame: Frame) -> OutlinedFrame:
    return OutlinedFrame(frame=frame, silhouette=extract_silhouette(frame))
