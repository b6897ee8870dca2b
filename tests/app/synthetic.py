"""Frames without a radar: points of an asymmetric body, projected, blurred, in Rayleigh noise."""

from collections.abc import Iterator
from dataclasses import replace

import cv2
import numpy as np

from app.source import Source
from core.frame import Frame
from core.geometry.projection import range_doppler_projection
from core.reconstruction import ReconstructionSettings

SETTINGS = ReconstructionSettings(spacing_m=0.4, side_m=24.0)
SHAPE = (160, 160)
SPACING_M = 0.2


def body_points(random: np.random.Generator) -> np.ndarray:
    """Points on a 10 m fuselage along x, a 16 m panel along y ahead of it, and a boom to +z."""
    fuselage = random.uniform([-5, -1.6, -1.6], [5, 1.6, 1.6], (6000, 3))
    panel = random.uniform([1, -8, -0.2], [3.5, 8, 0.2], (6000, 3))
    boom = random.uniform([-4.6, -0.3, 0], [-4, 0.3, 5], (1200, 3))
    return np.concatenate([fuselage, panel, boom])


def frames(count: int = 12, *, one_pass: bool = False) -> Iterator[Frame]:
    """Yield `count` frames from all around, or from one pass overhead."""
    random = np.random.default_rng(7)
    points = body_points(random)
    for number in range(count):
        angle = np.pi * (number + 0.5) / count
        if one_pass:
            sight = np.array([-np.cos(angle), 0.0, -np.sin(angle)])
            rate = np.array([np.sin(angle), 0.0, -np.cos(angle)])
        else:
            sight = random.normal(size=3)
            rate = np.cross(sight, random.normal(size=3))
        yield frame(points, sight, rate, time_s=6.0 * number, random=random)


def frame(
    points: np.ndarray,
    sight: np.ndarray,
    rate: np.ndarray,
    *,
    time_s: float,
    random: np.random.Generator,
) -> Frame:
    """Return the image of points from one line of sight."""
    sight = sight / np.linalg.norm(sight)
    projection = range_doppler_projection(
        line_of_sight=sight,
        line_of_sight_rate_per_s=rate,
        row_spacing_m=SPACING_M,
        column_spacing_m=SPACING_M,
        shape=SHAPE,
    )
    row, column = np.round(projection.image_points(points)).astype(int).T
    image = np.zeros(SHAPE)
    np.add.at(image, (row, column), random.rayleigh(1.0, len(row)))
    image = cv2.GaussianBlur(image, (0, 0), 1.0)
    noise = random.rayleigh(0.004 * image.max(), SHAPE)
    return Frame(
        amplitude=np.hypot(image, noise),
        projection=projection,
        time_s=time_s,
        sensor="radar",
        line_of_sight=sight,
        row_spacing_m=SPACING_M,
        column_spacing_m=SPACING_M,
        row_resolution_m=0.24,
        column_resolution_m=0.26,
        label=f"synthetic view at {time_s:.0f} s",
    )


def empty_frame(*, time_s: float = 0.0) -> Frame:
    """Return a frame of noise only."""
    random = np.random.default_rng(11)
    shown = next(frames(1))
    return replace(shown, amplitude=random.rayleigh(0.004, SHAPE), time_s=time_s, label="pass 2")


def source(count: int = 12, *, one_pass: bool = False) -> Source:
    """Return the frames as a source."""
    return Source(
        name="synthetic body",
        description="Projected points of a body with a fuselage, a panel and a boom.",
        frames=lambda: frames(count, one_pass=one_pass),
        expected_frames=count,
    )
