"""A spinning target: its attitude over time, and the lines of sight that it sees."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import Rotation

from core.arrays import Floats, frozen
from core.geometry.track import LineOfSightTrack


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Spin:
    """A turn about an axis that is fixed in inertial space, at a constant rate.

    The target frame coincides with the inertial axes at time 0, which is what the phase of the
    spin means: another phase is another target frame.

    Attributes:
        axis: (3,) unit vector, inertial; the target turns about it by the right hand.
        rate_rad_per_s: of the turn.
    """

    axis: Floats
    rate_rad_per_s: float

    def __post_init__(self) -> None:
        axis = frozen(self.axis, np.float64, (3,), "The spin's axis")
        length = float(np.linalg.norm(axis))
        if not (length > 0 and np.isfinite(self.rate_rad_per_s)):
            raise ValueError(
                "A spin needs an axis with a length above zero and a finite rate in rad/s; got "
                f"{axis} and {self.rate_rad_per_s}."
            )
        object.__setattr__(self, "axis", frozen(axis / length, np.float64, (3,), "The spin's axis"))

    def attitude(self, time_s: Floats) -> Floats:
        """Return the rotations (n, 3, 3) from the target frame to inertial axes at times (n,)."""
        angle = self.rate_rad_per_s * np.asarray(time_s, dtype=np.float64)
        rotations: Floats = Rotation.from_rotvec(np.multiply.outer(angle, self.axis)).as_matrix()
        return rotations

    def lines_of_sight(
        self, time_s: Floats, line_of_sight: Floats, line_of_sight_rate_per_s: Floats
    ) -> tuple[Floats, Floats]:
        """Return lines of sight and their rates as the target sees them.

        Args:
            time_s: (pulses,).
            line_of_sight: (pulses, 3) unit vectors k, inertial.
            line_of_sight_rate_per_s: (pulses, 3) dk/dt, inertial.

        Returns:
            (pulses, 3) k and (pulses, 3) dk/dt in the target frame: the transport theorem,
            Aᵀ (dk/dt − ω × k).
        """
        attitude = self.attitude(time_s)
        turn = self.rate_rad_per_s * self.axis
        moving = line_of_sight_rate_per_s - np.cross(turn, line_of_sight)
        seen, seen_moving = (
            np.einsum("nij,ni->nj", attitude, vector) for vector in (line_of_sight, moving)
        )
        return seen, seen_moving

    def target_track(self, inertial: LineOfSightTrack) -> LineOfSightTrack:
        """Return a track in inertial axes as the spinning target sees it."""
        sight, rate = self.lines_of_sight(
            inertial.time_s, inertial.line_of_sight, inertial.line_of_sight_rate_per_s
        )
        return replace(inertial, line_of_sight=sight, line_of_sight_rate_per_s=rate)

    def changed(self, tilt_rad: Floats, rate_factor: float) -> "Spin":
        """Return the spin with its axis tilted and its rate multiplied.

        Args:
            tilt_rad: (2,) turn of the axis toward two directions perpendicular to it.
            rate_factor: 1 leaves the rate.
        """
        across = _perpendicular(self.axis)
        turn = np.array([across, np.cross(self.axis, across)]).T @ np.asarray(tilt_rad)
        angle = float(np.linalg.norm(turn))
        axis = np.cos(angle) * self.axis + np.sinc(angle / np.pi) * turn
        return Spin(axis=axis, rate_rad_per_s=self.rate_rad_per_s * rate_factor)

    def axis_angle_rad(self, other: "Spin") -> float:
        """Return the angle between two spins' axes."""
        sine = float(np.linalg.norm(np.cross(self.axis, other.axis)))
        return float(np.arctan2(sine, float(self.axis @ other.axis)))


def _perpendicular(axis: Floats) -> Floats:
    across = np.cross(axis, np.eye(3)[int(np.argmin(np.abs(axis)))])
    unit: Floats = across / np.linalg.norm(across)
    return unit
