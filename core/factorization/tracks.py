"""Tracks of scatterers through range-Doppler images, perfect or as glint leaves them."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree

from core.arrays import Floats, frozen


@dataclass(frozen=True, slots=True, kw_only=True)
class Glint:
    """What glint and imperfect association do to tracks.

    Attributes:
        visible: probability that a scatterer is seen in a frame, each frame on its own; where it
            is not, its track has no point.
        jump: probability that a track, where it has a point, takes that of a neighbour instead.
        neighbours: among how many of the scatterers nearest in the image it takes one, all equally
            likely.
        noise_cells: standard deviation of a point's place, in resolution cells along each axis.
        range_resolution_m: length of a resolution cell.
        cross_range_resolution_m: its width.
    """

    visible: float = 1.0
    jump: float = 0.0
    neighbours: int = 4
    noise_cells: float = 0.0
    range_resolution_m: float = 0.15
    cross_range_resolution_m: float = 0.15

    def __post_init__(self) -> None:
        for name in ("visible", "jump"):
            if not 0 <= getattr(self, name) <= 1:
                raise ValueError(f"{name} is a probability, 0 to 1; got {getattr(self, name)}.")
        if self.neighbours < 1 or not 0 <= self.noise_cells < np.inf:
            raise ValueError(
                "Glint needs at least 1 neighbour to jump to and noise of 0 cells or more; got "
                f"{self.neighbours} and {self.noise_cells}."
            )
        if not (self.range_resolution_m > 0 and self.cross_range_resolution_m > 0):
            raise ValueError("A resolution cell must have a length and a width in metres.")


def tracks_of(points_m: Floats, line_of_sight: Floats, line_of_sight_rate_per_s: Floats) -> Floats:
    """Return the tracks of scatterers under perfect association, (frames, points, 2).

    The first number is the range k·p in metres, the second the range rate dk/dt·p in m/s, which is
    the cross-range times the rotation rate: unscaled, as Doppler gives it (f_d = −(2/λ) dk/dt·p).

    Args:
        points_m: (points, 3) scatterers, target frame.
        line_of_sight: (frames, 3) unit vectors k.
        line_of_sight_rate_per_s: (frames, 3) dk/dt.
    """
    points = frozen(points_m, np.float64, (None, 3), "Scatterers")
    k = frozen(line_of_sight, np.float64, (None, 3), "Lines of sight")
    rate = frozen(line_of_sight_rate_per_s, np.float64, k.shape, "Rates of the line of sight")
    tracks: Floats = np.stack([k @ points.T, rate @ points.T], axis=-1)
    return tracks


def glinting(
    tracks: Floats, glint: Glint, *, rotation_rate_rad_per_s: Floats, random: np.random.Generator
) -> Floats:
    """Return tracks (frames, points, 2) as glint leaves them, NaN where a point is missing.

    First scatterers vanish, then tracks jump among those that are left, then noise moves them.

    Args:
        tracks: perfect ones, as from `tracks_of`.
        glint: the model.
        rotation_rate_rad_per_s: (frames,) |dk/dt|, which turns cells into unscaled cross-range.
        random: of all three.
    """
    rates = frozen(rotation_rate_rad_per_s, np.float64, (len(tracks),), "Rotation rates")
    return np.stack(
        [
            _glinting_frame(points, glint, rate, random)
            for points, rate in zip(tracks, rates.tolist(), strict=True)
        ]
    )


def _glinting_frame(
    points: Floats, glint: Glint, rate_rad_per_s: float, random: np.random.Generator
) -> Floats:
    cell = np.array([glint.range_resolution_m, glint.cross_range_resolution_m * rate_rad_per_s])
    seen = np.flatnonzero(random.random(len(points)) < glint.visible)
    found = points[seen] / cell
    jumping = np.flatnonzero(random.random(len(seen)) < glint.jump)
    choices = min(glint.neighbours, len(seen) - 1)
    if len(jumping) and choices > 0:
        _, nearest = KDTree(found).query(found[jumping], k=choices + 1)
        chosen = random.integers(1, choices + 1, len(jumping))
        found[jumping] = found[nearest[np.arange(len(jumping)), chosen]]
    found = found + glint.noise_cells * random.normal(size=found.shape)
    result = np.full(points.shape, np.nan)
    result[seen] = found * cell
    return result
