"""The transmitted waveform, as far as imaging cares."""

from dataclasses import dataclass

import numpy as np

from core.arrays import Floats

SPEED_OF_LIGHT_M_PER_S = 299_792_458.0
"""Exact by the definition of the metre (BIPM, SI brochure, 2019)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Waveform:
    """A pulse train after pulse compression, in the frequency domain.

    Attributes:
        carrier_frequency_hz: centre of the band.
        bandwidth_hz: width of the band.
        pulse_repetition_frequency_hz: pulses per second.
        frequency_count: samples across the band.
    """

    carrier_frequency_hz: float = 16.7e9
    bandwidth_hz: float = 1.0e9
    pulse_repetition_frequency_hz: float = 100.0
    frequency_count: int = 256

    def __post_init__(self) -> None:
        for name in ("carrier_frequency_hz", "bandwidth_hz", "pulse_repetition_frequency_hz"):
            value = getattr(self, name)
            if not (np.isfinite(value) and value > 0):
                raise ValueError(f"{name} must be a positive frequency in hertz, got {value}.")
        if self.bandwidth_hz >= 2 * self.carrier_frequency_hz:
            raise ValueError(
                f"A band of {self.bandwidth_hz} Hz around {self.carrier_frequency_hz} Hz would "
                "reach below zero."
            )
        if self.frequency_count < 2:
            raise ValueError(f"At least 2 frequency samples needed, got {self.frequency_count}.")

    @property
    def wavelength_m(self) -> float:
        """Wavelength at the carrier."""
        return SPEED_OF_LIGHT_M_PER_S / self.carrier_frequency_hz

    @property
    def range_resolution_m(self) -> float:
        """Rayleigh range resolution c / 2B."""
        return SPEED_OF_LIGHT_M_PER_S / (2 * self.bandwidth_hz)

    @property
    def unambiguous_range_m(self) -> float:
        """Range swath that the frequency samples tell apart, c / 2Δf."""
        return SPEED_OF_LIGHT_M_PER_S / (2 * self.bandwidth_hz) * self.frequency_count

    def frequencies_hz(self) -> Floats:
        """Return the sample frequencies, (frequency_count,), bin centres across the band."""
        offset = (np.arange(self.frequency_count) + 0.5) / self.frequency_count - 0.5
        frequencies: Floats = self.carrier_frequency_hz + self.bandwidth_hz * offset
        return frequencies
