"""Options that several commands share, as the help shows them."""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro

from core.hull.shadow import CarvingRule
from core.reconstruction import ReconstructionSettings
from core.registration.registration import RegistrationRule

_UNSET = ""
"""What the help shows of an option that is not set: its sentence says what happens then."""

PassFile = Annotated[Path, tyro.conf.Positional, tyro.conf.arg(metavar="PASS")]
OutputFile = Annotated[Path, tyro.conf.Positional, tyro.conf.arg(metavar="OUT")]
OptionalFile = Annotated[Path | None, tyro.conf.arg(metavar="FILE", help_behavior_hint=_UNSET)]
OptionalFolder = Annotated[Path | None, tyro.conf.arg(metavar="FOLDER", help_behavior_hint=_UNSET)]
JsonTo = Annotated[str | None, tyro.conf.arg(metavar="FILE", help_behavior_hint=_UNSET)]
OptionalInt = Annotated[int | None, tyro.conf.arg(metavar="INT", help_behavior_hint=_UNSET)]
OptionalFloat = Annotated[float | None, tyro.conf.arg(metavar="FLOAT", help_behavior_hint=_UNSET)]
Gigahertz = Annotated[
    float,
    tyro.conf.arg(
        metavar="HZ", help_behavior_hint=lambda text: f"(default: {float(text) / 1e9:g}e9)"
    ),
]

LARGEST_SNR_DB = 200.0


@dataclass(frozen=True)
class Carving:
    """How the hull is carved."""

    rule: CarvingRule = "shadow"
    """shadow carves nothing behind a frame's first return; strict is the paper's rule."""
    tolerated_misses: int = 0
    """Views that may miss a voxel of the hull; 0 lets every view carve."""
    register: RegistrationRule = "none"
    """For frames with unknown offsets in range and cross-range. centroid shifts each silhouette to
    a common centroid (the paper's III.D, biased for lit sides); agreement finds the offsets on
    which all outlines agree, once all frames are there."""
    spacing_m: float = 0.15
    """Voxel spacing, metres."""
    side_m: float = 21.0
    """Side of the cubic grid, metres."""

    def settings(self) -> ReconstructionSettings:
        """Return the settings that these options mean.

        Raises:
            ValueError: fewer than no misses.
        """
        if self.tolerated_misses < 0:
            raise ValueError(
                "--tolerated-misses wants the number of views that may miss a voxel of the hull, "
                f"0 or more; got {self.tolerated_misses}."
            )
        return ReconstructionSettings(
            spacing_m=self.spacing_m,
            side_m=self.side_m,
            rule=self.rule,
            tolerated_misses=self.tolerated_misses,
            registration=self.register,
        )


CarvingOptions = Annotated[Carving, tyro.conf.arg(name="")]

DEFAULT_CARVING = Carving()


def checked_snr_db(value: float) -> float:
    """Return a signal-to-noise ratio that a simulation can use.

    Raises:
        ValueError: no finite number within ±200 dB.
    """
    if not (math.isfinite(value) and abs(value) <= LARGEST_SNR_DB):
        raise ValueError(f"--snr-db wants decibels within ±{LARGEST_SNR_DB:g}; got {value}.")
    return value


def checked_seed(value: int) -> int:
    """Return a seed that a random generator takes.

    Raises:
        ValueError: a negative number.
    """
    if value < 0:
        raise ValueError(f"--seed wants a whole number from 0 on; got {value}.")
    return value
