"""One direction in all frames in which an attitude vector is given."""

from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Literal, get_args

import numpy as np
from sgp4.api import SGP4_ERRORS, jday
from skyfield.api import EarthSatellite

from core.arrays import Floats, frozen
from core.geometry.local_orbital_frame import lvlh_axes

FrameName = Literal["target", "RTN", "TEME"]
"""The target frame; radial, transverse, normal; true equator and mean equinox of the epoch."""

FRAME_NAMES: tuple[FrameName, ...] = get_args(FrameName)

RTN_FROM_LVLH: Floats = frozen(
    [[0, 0, -1], [1, 0, 0], [0, -1, 0]], np.float64, (3, 3), "RTN from LVLH"
)
"""R points away from the geocentre (−z), T along-track (x), N along the orbit normal (−y).

Source: CCSDS 500.0-G-4, "Navigation data: definitions and conventions"."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Direction:
    """A direction in the target frame and, where an orbit is known, in RTN and TEME.

    Attributes:
        target: (3,) unit vector in the target frame.
        rtn: (3,) in radial, transverse, normal; None without an orbit.
        teme: (3,) inertial, true equator and mean equinox of `epoch_utc`, which is SGP4's own
            frame; None without an orbit.
        epoch_utc: ISO 8601 time at which `teme` holds, empty without an orbit.
        is_undirected: whether the sign means nothing, as for a line; all three flip together.
    """

    target: Floats
    rtn: Floats | None = None
    teme: Floats | None = None
    epoch_utc: str = ""
    is_undirected: bool = False

    def __post_init__(self) -> None:
        for name in ("target", "rtn", "teme"):
            vector = getattr(self, name)
            if vector is not None:
                vector = frozen(vector, np.float64, (3,), f"Direction in {name}")
                object.__setattr__(self, name, vector)

    def in_frame(self, name: FrameName) -> Floats:
        """Return the (3,) unit vector in a frame by its name.

        Raises:
            ValueError: an unknown frame, or one that needs an orbit where none is known.
        """
        if name not in FRAME_NAMES:
            raise ValueError(
                f'There is no frame "{name}"; directions are given in {", ".join(FRAME_NAMES)}.'
            )
        vector = {"target": self.target, "RTN": self.rtn, "TEME": self.teme}[name]
        if vector is None:
            raise ValueError(
                f"A direction in {name} needs the satellite's orbit and a time; this pass has no "
                "orbit. Import its elements, or read the direction in the target frame."
            )
        return vector


def direction_in_frames(
    direction: Floats,
    *,
    satellite: EarthSatellite | None = None,
    at_utc: datetime | None = None,
    is_undirected: bool = False,
) -> Direction:
    """Return a direction of the target frame in RTN and TEME too, where orbit and time are known.

    The target frame is taken to be LVLH, as of an Earth-pointing satellite.

    Args:
        direction: (3,) target frame, of any length above zero.
        satellite: its orbit, from `core.geometry.orbit`; None if unknown.
        at_utc: the time at which the target's attitude is meant, with its time zone; None if
            unknown.
        is_undirected: whether the sign means nothing.

    Raises:
        ValueError: no direction, a time without its zone, or an orbit that does not reach it.
    """
    vector = frozen(direction, np.float64, (3,), "The direction")
    length = float(np.linalg.norm(vector))
    if not length > 0:
        raise ValueError("A direction must have a length above zero.")
    unit = vector / length
    if satellite is None or at_utc is None:
        return Direction(target=unit, is_undirected=is_undirected)
    if at_utc.tzinfo is None:
        raise ValueError(f"A time needs its zone, such as UTC; got {at_utc.isoformat()}.")
    time = at_utc.astimezone(UTC)
    return Direction(
        target=unit,
        rtn=RTN_FROM_LVLH @ unit,
        teme=unit @ teme_to_lvlh(satellite, time),
        epoch_utc=time.isoformat().replace("+00:00", "Z"),
        is_undirected=is_undirected,
    )


def teme_to_lvlh(satellite: EarthSatellite, at_utc: datetime) -> Floats:
    """Return the (3, 3) rotation from TEME to LVLH at a time.

    Raises:
        ValueError: the orbit cannot be propagated to that time.

    Source: Vallado et al., "Revisiting Spacetrack report #3", 2006: SGP4's states are TEME.
    """
    time = at_utc.astimezone(UTC)
    day, share = jday(
        time.year,
        time.month,
        time.day,
        time.hour,
        time.minute,
        time.second + time.microsecond * 1e-6,
    )
    error, position_km, velocity_km_per_s = satellite.model.sgp4(day, share)
    if error:
        raise ValueError(
            f"The orbit of {satellite.name or 'the satellite'} cannot be propagated to "
            f"{time.isoformat()}: {SGP4_ERRORS[error]}."
        )
    return lvlh_axes(1e3 * np.array(position_km), 1e3 * np.array(velocity_km_per_s))
