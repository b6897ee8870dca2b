"""Lines of sight over time, with or without an orbit behind them."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from core.arrays import Floats, frozen

STILL_RATE_PER_S = 1e-9
"""Below this |dk/dt| in rad/s the line of sight stands still: a turn of 3° would take years."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LineOfSightTrack:
    """The line of sight at every pulse, in the target frame.

    Attributes:
        time_s: (pulses,) growing, since the track's epoch.
        line_of_sight: (pulses, 3) unit vectors k from radar to target.
        line_of_sight_rate_per_s: (pulses, 3) dk/dt, perpendicular to k.
        range_m: (pulses,) from radar to the target frame's origin, None where unknown.
        azimuth_rad: (pulses,) at the station, clockwise from north, None without a station.
        elevation_rad: (pulses,) at the station, above the horizon, None without a station.
        bisector_scale: (pulses,) cos(β/2) of a bistatic pair, whose bisector the line of sight then
            is (`core.geometry.bistatic`); None for one radar that sends and receives.
        epoch_utc: ISO 8601 time of time_s = 0, empty without an orbit.
    """

    time_s: Floats
    line_of_sight: Floats
    line_of_sight_rate_per_s: Floats
    range_m: Floats | None = None
    azimuth_rad: Floats | None = None
    elevation_rad: Floats | None = None
    bisector_scale: Floats | None = None
    epoch_utc: str = ""

    def __post_init__(self) -> None:
        time_s = frozen(self.time_s, np.float64, (None,), "Pulse times")
        if len(time_s) < 2:
            raise ValueError(f"A track needs at least 2 pulses, got {len(time_s)}.")
        if not np.all(np.diff(time_s) > 0):
            late = int(np.argmin(np.diff(time_s))) + 1
            raise ValueError(
                f"Pulse times must grow; pulse {late} comes at {time_s[late]} s after "
                f"{time_s[late - 1]} s. Sort the pulses by time."
            )
        object.__setattr__(self, "time_s", time_s)
        pulses = len(time_s)
        for name in ("line_of_sight", "line_of_sight_rate_per_s"):
            value = frozen(getattr(self, name), np.float64, (pulses, 3), name.replace("_", " "))
            object.__setattr__(self, name, value)
        for name in ("range_m", "azimuth_rad", "elevation_rad", "bisector_scale"):
            value = getattr(self, name)
            if value is not None:
                object.__setattr__(self, name, frozen(value, np.float64, (pulses,), name))
        self._check_directions()

    def _check_directions(self) -> None:
        length = np.linalg.norm(self.line_of_sight, axis=1)
        if float(np.abs(length - 1).max()) > 1e-6:
            raise ValueError(
                "Lines of sight must be unit vectors; their lengths run from "
                f"{length.min():.6g} to {length.max():.6g}."
            )
        if float(self.rotation_rate_rad_per_s().max()) < STILL_RATE_PER_S:
            raise ValueError(
                "The line of sight stands still in the target frame, so the echoes hold no "
                "cross-range; a track along which it moves is needed."
            )
        scale = self.bisector_scale
        if scale is not None and not (scale.min() > 0 and scale.max() <= 1 + 1e-9):
            raise ValueError(
                "The bisector's scale cos(β/2) must lie above 0 and reach at most 1; it runs from "
                f"{scale.min():.6g} to {scale.max():.6g}."
            )

    def __len__(self) -> int:
        """Return the number of pulses."""
        return len(self.time_s)

    def rotation_rate_rad_per_s(self) -> Floats:
        """Return |dk/dt| at every pulse, (pulses,)."""
        rate: Floats = np.linalg.norm(self.line_of_sight_rate_per_s, axis=1)
        return rate

    def phase_direction(self) -> Floats:
        """Return the vectors whose product with a place is half the path beyond the origin.

        For one radar the line of sight k, for a bistatic pair cos(β/2) times the bisector, which
        is the mean of both lines of sight; (pulses, 3). A point's phase is −4π f / c times that.
        """
        if self.bisector_scale is None:
            return self.line_of_sight
        direction: Floats = self.bisector_scale[:, None] * self.line_of_sight
        return direction

    def part(self, start: int, stop: int) -> "LineOfSightTrack":
        """Return pulses start … stop − 1 as a track on the same time scale."""
        where = slice(start, stop)
        return LineOfSightTrack(
            time_s=self.time_s[where],
            line_of_sight=self.line_of_sight[where],
            line_of_sight_rate_per_s=self.line_of_sight_rate_per_s[where],
            range_m=None if self.range_m is None else self.range_m[where],
            azimuth_rad=None if self.azimuth_rad is None else self.azimuth_rad[where],
            elevation_rad=None if self.elevation_rad is None else self.elevation_rad[where],
            bisector_scale=None if self.bisector_scale is None else self.bisector_scale[where],
            epoch_utc=self.epoch_utc,
        )

    def bursts(self) -> list[tuple[int, int]]:
        """Return (start, stop) of the runs of pulses without a gap.

        A gap is a step of more than three median pulse intervals.
        """
        step = np.diff(self.time_s)
        edges = np.flatnonzero(step > 3 * np.median(step)) + 1
        bounds = [0, *edges.tolist(), len(self.time_s)]
        return list(pairwise(bounds))


def line_of_sight_from_angles(elevation_rad: Floats, azimuth_rad: Floats) -> Floats:
    """Return unit lines of sight (…, 3) from the paper's θ and φ in the target frame.

    Source: eq. 3, k = (cosθ sinφ, cosθ cosφ, sinθ).
    """
    elevation, azimuth = np.asarray(elevation_rad), np.asarray(azimuth_rad)
    line_of_sight: Floats = np.stack(
        [
            np.cos(elevation) * np.sin(azimuth),
            np.cos(elevation) * np.cos(azimuth),
            np.sin(elevation),
        ],
        axis=-1,
    )
    return line_of_sight


def angles_from_line_of_sight(line_of_sight: Floats) -> tuple[Floats, Floats]:
    """Return the paper's (θ, φ) in radians of unit lines of sight (…, 3), φ in (−π, π]."""
    x, y, z = np.moveaxis(np.asarray(line_of_sight), -1, 0)
    return np.arcsin(np.clip(z, -1, 1)), np.arctan2(x, y)


def track_from_angles(
    time_s: Floats, elevation_rad: Floats, azimuth_rad: Floats
) -> LineOfSightTrack:
    """Return the track through a table of the paper's θ and φ over time (eqs. 3 and 6).

    Args:
        time_s: (pulses,) growing.
        elevation_rad: (pulses,) θ in the target frame.
        azimuth_rad: (pulses,) φ in the target frame.

    dk/dt is the derivative of k by second-order differences, made perpendicular to k.
    """
    time = frozen(time_s, np.float64, (None,), "Pulse times")
    elevation = frozen(elevation_rad, np.float64, (len(time),), "Elevation θ")
    azimuth = frozen(azimuth_rad, np.float64, (len(time),), "Azimuth φ")
    if len(time) < 3 or not np.all(np.diff(time) > 0):
        raise ValueError("A table of angles needs at least 3 rows with growing times.")
    line_of_sight = line_of_sight_from_angles(elevation, azimuth)
    rate = np.gradient(line_of_sight, time, axis=0, edge_order=2)
    rate = rate - line_of_sight * np.sum(line_of_sight * rate, axis=1, keepdims=True)
    return LineOfSightTrack(time_s=time, line_of_sight=line_of_sight, line_of_sight_rate_per_s=rate)


def random_views_track(
    *,
    views: int,
    turn_rad: float,
    pulses_per_view: int,
    pulse_repetition_frequency_hz: float,
    random: np.random.Generator,
) -> LineOfSightTrack:
    """Return bursts of pulses from random directions all over the sphere ("wide scope").

    In each burst the line of sight turns at a constant rate about a random axis perpendicular to
    it, by `turn_rad` from half a pulse before the first to half a pulse after the last; a second
    lies between bursts.

    Raises:
        ValueError: fewer than one view, fewer than two pulses a view, or no turn.
    """
    if views < 1 or pulses_per_view < 2 or not turn_rad > 0:
        raise ValueError(
            "Random views need at least 1 view, 2 pulses a view and a turn above zero; got "
            f"{views} views of {pulses_per_view} pulses turning {turn_rad} rad."
        )
    duration_s = pulses_per_view / pulse_repetition_frequency_hz
    middle = random.normal(size=(views, 3))
    middle /= np.linalg.norm(middle, axis=1, keepdims=True)
    across = np.cross(middle, random.normal(size=(views, 3)))
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    share = (np.arange(pulses_per_view) + 0.5) / pulses_per_view
    angle = (share[None, :, None] - 0.5) * turn_rad
    line_of_sight = np.cos(angle) * middle[:, None] + np.sin(angle) * across[:, None]
    direction = np.cos(angle) * across[:, None] - np.sin(angle) * middle[:, None]
    time = np.arange(views)[:, None] * (duration_s + 1) + share * duration_s
    return LineOfSightTrack(
        time_s=time.ravel(),
        line_of_sight=line_of_sight.reshape(-1, 3),
        line_of_sight_rate_per_s=(direction * turn_rad / duration_s).reshape(-1, 3),
    )


def accumulated_turn_rad(line_of_sight: Floats) -> Floats:
    """Return the angle that unit vectors (pulses, 3) have swept up to each pulse, (pulses,)."""
    chord = np.linalg.norm(np.diff(line_of_sight, axis=0), axis=1)
    turn: Floats = np.concatenate([[0.0], np.cumsum(2 * np.arcsin(np.minimum(chord / 2, 1.0)))])
    return turn
