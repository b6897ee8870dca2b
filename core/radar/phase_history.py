"""Echoes after pulse compression and motion compensation."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats, frozen
from core.geometry.track import LineOfSightTrack
from core.radar.waveform import SPEED_OF_LIGHT_M_PER_S


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PhaseHistory:
    """Complex echoes over pulses and frequencies, referred to the target frame's origin.

    A unit point at p returns exp(−j 4π f (R(p) − R(0)) / c), where R is its distance from the
    radar; far away that is exp(−j 4π f k·p / c). For a bistatic pair k is cos(β/2) times the
    bisector; its band and wavelength are given as one radar on the bisector would need them for
    the same echoes.

    Attributes:
        samples: (pulses, frequencies) complex64.
        frequency_hz: (frequencies,) evenly spaced and growing.
        track: the line of sight at every pulse; with range_m the radar stands at −range·k.
        sensor: name of the radar.
    """

    samples: NDArray[np.complex64]
    frequency_hz: Floats
    track: LineOfSightTrack
    sensor: str = "radar"

    def __post_init__(self) -> None:
        frequency = frozen(self.frequency_hz, np.float64, (None,), "Frequencies")
        step = np.diff(frequency)
        if len(frequency) < 2 or not np.all(step > 0) or float(frequency[0]) <= 0:
            raise ValueError("Frequencies must be at least two, positive, and grow.")
        if float(np.ptp(step)) > 1e-3 * float(step.mean()):
            raise ValueError(
                "Frequencies must be evenly spaced; their steps run from "
                f"{step.min():.6g} to {step.max():.6g} Hz. Resample them first."
            )
        object.__setattr__(self, "frequency_hz", frequency)
        shape = (len(self.track), len(frequency))
        object.__setattr__(self, "samples", frozen(self.samples, np.complex64, shape, "Echoes"))

    @property
    def wavelength_m(self) -> float:
        """Wavelength at the middle of the band, over cos(β/2) for a bistatic pair."""
        return SPEED_OF_LIGHT_M_PER_S / (float(self.frequency_hz.mean()) * self._scale)

    @property
    def bandwidth_hz(self) -> float:
        """Width of the band, half a step beyond the outer samples, times cos(β/2) for a pair."""
        return self.frequency_step_hz * len(self.frequency_hz) * self._scale

    @property
    def frequency_step_hz(self) -> float:
        """Distance between frequency samples."""
        return float(self.frequency_hz[-1] - self.frequency_hz[0]) / (len(self.frequency_hz) - 1)

    @property
    def _scale(self) -> float:
        scale = self.track.bisector_scale
        return 1.0 if scale is None else float(scale.mean())

    def part(self, start: int, stop: int) -> "PhaseHistory":
        """Return pulses start … stop − 1."""
        return PhaseHistory(
            samples=self.samples[start:stop],
            frequency_hz=self.frequency_hz,
            track=self.track.part(start, stop),
            sensor=self.sensor,
        )
