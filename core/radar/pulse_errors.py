"""Errors from pulse to pulse: what tracking and oscillators leave in echoes."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from core.arrays import Floats, frozen
from core.radar.phase_history import PhaseHistory
from core.radar.waveform import SPEED_OF_LIGHT_M_PER_S


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PulseErrors:
    """The error of every pulse.

    Attributes:
        phase_rad: (pulses,) by which all of a pulse's samples are turned ahead.
        range_m: (pulses,) by which the target seems too far away, in range and so in phase.
    """

    phase_rad: Floats
    range_m: Floats

    def __post_init__(self) -> None:
        phase = frozen(self.phase_rad, np.float64, (None,), "Phase errors")
        object.__setattr__(self, "phase_rad", phase)
        range_m = frozen(self.range_m, np.float64, (len(phase),), "Range errors")
        object.__setattr__(self, "range_m", range_m)

    def __len__(self) -> int:
        """Return the number of pulses."""
        return len(self.phase_rad)


@dataclass(frozen=True, slots=True, kw_only=True)
class PulseErrorModel:
    """How large errors are.

    Polynomials run over the pass's time, −1 at its first and 1 at its last pulse; their
    coefficients start with the constant.

    Attributes:
        phase_rms_rad: of the random part, independent from pulse to pulse.
        phase_polynomial_rad: coefficients of the smooth part, none by default.
        range_rms_m: of the random translation (trigger jitter), independent from pulse to pulse.
        range_polynomial_m: coefficients of the smooth translation (what tracking missed).
    """

    phase_rms_rad: float = 0.0
    phase_polynomial_rad: Sequence[float] = ()
    range_rms_m: float = 0.0
    range_polynomial_m: Sequence[float] = ()

    def __post_init__(self) -> None:
        for name in ("phase_rms_rad", "range_rms_m"):
            value = getattr(self, name)
            if not (np.isfinite(value) and value >= 0):
                raise ValueError(f"{name} must be finite and not negative, got {value}.")
        for name in ("phase_polynomial_rad", "range_polynomial_m"):
            if not np.all(np.isfinite(getattr(self, name))):
                raise ValueError(
                    f"{name} takes finite coefficients, constant first; got {getattr(self, name)}."
                )

    def drawn(self, time_s: Floats, random: np.random.Generator) -> PulseErrors:
        """Return one realisation for pulses at the given times, (pulses,)."""
        place = 2 * (time_s - time_s[0]) / (time_s[-1] - time_s[0]) - 1
        phase, distance = random.standard_normal((2, len(time_s)))
        return PulseErrors(
            phase_rad=self.phase_rms_rad * phase + _polynomial(self.phase_polynomial_rad, place),
            range_m=self.range_rms_m * distance + _polynomial(self.range_polynomial_m, place),
        )


def with_pulse_errors(
    history: PhaseHistory, model: PulseErrorModel, random: np.random.Generator
) -> tuple[PhaseHistory, PulseErrors]:
    """Return echoes with errors drawn at random, and the errors themselves as the truth.

    A translation ΔR turns the sample at frequency f by −4π f ΔR / c, a phase error turns all
    frequencies alike. Range is what a clock measures: of a bistatic pair, half the path.
    """
    errors = model.drawn(history.track.time_s, random)
    return _applied(history, errors, 1), errors


def without_pulse_errors(history: PhaseHistory, errors: PulseErrors) -> PhaseHistory:
    """Return echoes with known errors taken out again.

    Raises:
        ValueError: errors of another number of pulses.
    """
    return _applied(history, errors, -1)


def _applied(history: PhaseHistory, errors: PulseErrors, sign: int) -> PhaseHistory:
    if len(errors) != len(history.track):
        raise ValueError(
            f"Errors of {len(errors)} pulses do not belong to echoes of {len(history.track)}."
        )
    wavenumber = 4 * np.pi / SPEED_OF_LIGHT_M_PER_S * history.frequency_hz
    turn = errors.phase_rad[:, None] - np.outer(errors.range_m, wavenumber)
    return replace(history, samples=history.samples * np.exp(1j * sign * turn))


def _polynomial(coefficients: Sequence[float], place: Floats) -> Floats:
    values = np.polynomial.polynomial.polyval(place, [*coefficients, 0.0])
    return np.asarray(values, dtype=np.float64)
