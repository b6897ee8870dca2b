"""Measurements as files hold them: how each is measured, and what it last read."""

from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np

from core.arrays import Floats, frozen
from core.geometry.directions import FRAME_NAMES, Direction, FrameName
from core.measurement.results import Measurement
from core.measurement.specs import Spec

UNITS = ("m", "m²", "m³", "rad", "")

HullKind = Literal["hull extent", "hull line", "hull volume"]
HULL_KINDS: tuple[HullKind, ...] = get_args(HullKind)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Reading:
    """What a measurement read when it was written.

    Attributes:
        value: in `unit`.
        unit: "m", "m²", "m³", "rad" or empty.
        low, high: ends of its interval, in `unit`; both None where there is none.
        direction: (3,) attitude vector in `frame`, None where there is none.
        frame: in which the direction is given.
        epoch_utc: ISO 8601 time at which an inertial direction holds, empty for other frames.
        is_undirected: whether the direction's sign means nothing.
        revision: of the hull.
        threshold: votes that a voxel of that hull has at least.
    """

    value: float
    unit: str
    low: float | None = None
    high: float | None = None
    direction: Floats | None = None
    frame: FrameName = "target"
    epoch_utc: str = ""
    is_undirected: bool = False
    revision: int = 0
    threshold: int = 0

    def __post_init__(self) -> None:
        for name in ("value", "low", "high"):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, float(getattr(self, name)))
        if not np.isfinite(self.value):
            raise ValueError(f"the value must be a finite number, got {self.value}")
        if self.unit not in UNITS:
            raise ValueError(f'the unit must be one of {", ".join(UNITS[:-1])}, got "{self.unit}"')
        if self.frame not in FRAME_NAMES:
            raise ValueError(
                f'the frame must be one of {", ".join(FRAME_NAMES)}, got "{self.frame}"'
            )
        if (self.frame == "TEME") != bool(self.epoch_utc):
            raise ValueError("a direction in TEME, and no other, has an epoch")
        self._check_interval()
        if self.direction is not None:
            direction = frozen(self.direction, np.float64, (3,), "the direction")
            object.__setattr__(self, "direction", direction)

    def _check_interval(self) -> None:
        if (self.low is None) != (self.high is None):
            raise ValueError("an interval has both its ends or none")
        if self.low is not None and self.high is not None and not self.low <= self.high:
            raise ValueError(f"an interval's low end {self.low} lies below its high {self.high}")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Entry:
    """A measurement as files hold it.

    Attributes:
        spec: how it is measured.
        reading: what it last read, None if it has not been measured or is lost.
    """

    spec: Spec
    reading: Reading | None = None


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class HullNumber:
    """A number that a hull has by itself, as CSV files hold it beside the measurements.

    Attributes:
        kind: what it is of.
        name: what a person calls it.
        reading: None where the views do not bound it.
    """

    kind: HullKind
    name: str
    reading: Reading | None


def reading_of(
    measurement: Measurement,
    *,
    low: float | None = None,
    high: float | None = None,
    direction: Direction | None = None,
    frame: FrameName = "target",
) -> Reading:
    """Return a measurement's reading, its direction in a frame of choice.

    Args:
        measurement: what was measured.
        low: its interval's lower end.
        high: its interval's upper end.
        direction: the measurement's, in all frames; needed for others than the target's.
        frame: in which to give it.

    Raises:
        ValueError: a frame that needs an orbit where none is known.
    """
    vector = measurement.direction
    if vector is not None and frame != "target":
        vector = (direction or Direction(target=vector)).in_frame(frame)
    return Reading(
        value=measurement.value,
        unit=measurement.unit,
        low=low,
        high=high,
        direction=vector,
        frame=frame,
        epoch_utc=direction.epoch_utc if direction and frame == "TEME" else "",
        is_undirected=measurement.is_undirected,
        revision=measurement.revision,
        threshold=measurement.threshold,
    )
