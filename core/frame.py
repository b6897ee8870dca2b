"""A frame: one image of the target with the projection that made it."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats, frozen
from core.geometry.projection import Projection

Sensor = Literal["radar", "optical"]

LENGTHS = ("row_spacing_m", "column_spacing_m", "row_resolution_m", "column_resolution_m")
"""The fields of a frame that are lengths on the target, each positive or None."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Frame:
    """One image of the target.

    Attributes:
        amplitude: (rows, columns) float32, linear and not negative. Radar: row 0 is nearest the
            radar, columns grow with cross-range.
        projection: from target metres to (row, column) of this image.
        time_s: time of the image since the pass began.
        sensor: what took it.
        row_spacing_m, column_spacing_m: size of a pixel on the target; None in perspective.
        line_of_sight: (3,) unit vector from sensor to target, target frame.
        row_resolution_m, column_resolution_m: −3 dB widths of the point response, None where
            unknown.
        label: what the frame is called where a person sees it.
        window: what weighed both axes, as `core.radar.window.window_named` reads it; it shapes
            the point response.
        sun_direction: (3,) unit vector from target to sun, target frame, where that is what lights
            the image: it shows the sunlit side only. None for radar, and where the light is not
            known.
    """

    amplitude: NDArray[np.float32]
    projection: Projection
    time_s: float
    sensor: Sensor
    line_of_sight: Floats
    row_spacing_m: float | None = None
    column_spacing_m: float | None = None
    row_resolution_m: float | None = None
    column_resolution_m: float | None = None
    label: str = ""
    window: str = "hamming"
    sun_direction: Floats | None = None

    def __post_init__(self) -> None:
        amplitude = frozen(self.amplitude, np.float32, (None, None), "Frame amplitude")
        if min(amplitude.shape, default=0) < 2:
            raise ValueError(f"A frame needs at least 2 × 2 pixels, got {amplitude.shape}.")
        if float(amplitude.min()) < 0:
            raise ValueError("A frame holds amplitudes, which are not negative; take the modulus.")
        object.__setattr__(self, "amplitude", amplitude)
        _freeze_unit(self, "line_of_sight", "line of sight")
        if self.sun_direction is not None:
            _freeze_unit(self, "sun_direction", "sun's direction")
        if not np.isfinite(self.time_s):
            raise ValueError(f"A frame's time must be finite seconds, got {self.time_s}.")
        for name in LENGTHS:
            length_m = getattr(self, name)
            if length_m is not None and not (np.isfinite(length_m) and length_m > 0):
                raise ValueError(f"{name} must be positive metres or unknown, got {length_m}.")

    @property
    def shape(self) -> tuple[int, int]:
        """(rows, columns)."""
        rows, columns = self.amplitude.shape
        return rows, columns

    def decibels(self, *, floor_db: float = -200.0) -> NDArray[np.float32]:
        """Return 20·log10 of the amplitude relative to the frame's peak, not below `floor_db`."""
        peak = float(self.amplitude.max())
        floor = 10 ** (floor_db / 20)
        relative = self.amplitude / np.float32(peak if peak > 0 else 1.0)
        level: NDArray[np.float32] = 20 * np.log10(np.maximum(relative, np.float32(floor)))
        return level


def _freeze_unit(frame: Frame, name: str, title: str) -> None:
    vector = frozen(getattr(frame, name), np.float64, (3,), f"The {title}")
    if abs(float(np.linalg.norm(vector)) - 1) > 1e-6:
        raise ValueError(f"The {title} must be a unit vector, got {vector}.")
    object.__setattr__(frame, name, vector)
