"""Figures with their bounds, and levels in decibels."""

import numpy as np
from numpy.typing import ArrayLike

from core.arrays import Floats
from core.experiments.results import Figure


def bounded(name: str, value: ArrayLike, wanted: str) -> Figure:
    """Return a figure in the unit of its target, which reads like "<= 0.1 dB"."""
    unit = " ".join(wanted.split()[2:])
    return Figure(name=name, value=float(np.asarray(value)), unit=unit, wanted=wanted)


def decibels(power: ArrayLike) -> Floats:
    """Return 10 log₁₀ of powers, in their shape."""
    level: Floats = 10 * np.log10(np.asarray(power, dtype=np.float64))
    return level
