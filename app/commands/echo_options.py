"""Options of simulated echoes: how a surface scatters, and what goes wrong from pulse to pulse."""

from dataclasses import dataclass

import numpy as np

from core.radar.echoes import ScatteringModel
from core.radar.pulse_errors import PulseErrorModel
from core.radar.scattering_models import ModelName, scattering_model
from core.targets import Target


@dataclass(frozen=True)
class Surface:
    """How the target's surface scatters."""

    model: ModelName = "diffuse"
    """diffuse scatters from random points; physical-optics is a mirror, with bounces between its
    parts; mixed is a mirror that scatters a share of the power."""
    scatterers: int = 60_000
    """Points on the target's surface (diffuse and mixed)."""
    roughness: float = 0.5
    """Share of the power that mixed scatters, 0 to 1."""
    bounces: int = 3
    """Reflections that mirrors are followed through (physical-optics and mixed)."""

    def scattering(self, target: Target, random: np.random.Generator) -> ScatteringModel:
        """Return what these options mean for a target.

        Raises:
            ValueError: a roughness outside 0 to 1, no bounce or no scatterer, no surface.
        """
        return scattering_model(
            target,
            self.model,
            random=random,
            scatterers=self.scatterers,
            roughness=self.roughness,
            most_bounces=self.bounces,
        )


@dataclass(frozen=True)
class Errors:
    """What goes wrong from pulse to pulse."""

    phase_error_rad: float = 0.0
    """Random phase of every pulse, rms radians."""
    range_error_m: float = 0.0
    """Random translation of every pulse, rms metres."""
    range_drift_m: float = 0.0
    """Translation that tracking misses, a parabola from 0 mid-pass to this at its ends, metres."""

    def pulse_errors(self) -> PulseErrorModel:
        """Return what these options mean.

        Raises:
            ValueError: a size that is negative or not finite.
        """
        for option, value in (
            ("--phase-error-rad", self.phase_error_rad),
            ("--range-error-m", self.range_error_m),
        ):
            if not (np.isfinite(value) and value >= 0):
                raise ValueError(f"{option} wants an rms error, 0 or more; got {value}.")
        if not np.isfinite(self.range_drift_m):
            raise ValueError(f"--range-drift-m wants metres; got {self.range_drift_m}.")
        return PulseErrorModel(
            phase_rms_rad=self.phase_error_rad,
            range_rms_m=self.range_error_m,
            range_polynomial_m=(0.0, 0.0, self.range_drift_m),
        )


DEFAULT_SURFACE = Surface()
DEFAULT_ERRORS = Errors()
