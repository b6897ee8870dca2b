"""Estimates of a target's spin from its echoes, beside the truth."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from core.experiments.results import Table
from core.experiments.spin_scene import (
    STATIONS,
    SpinningEchoes,
    SpunFrame,
    spun_frames,
    true_spin,
)
from core.experiments.study import Progress
from core.geometry.spin import Spin
from core.registration.spin import estimate_spin

STARTS = (((6.0, -4.0), 4.0), ((-7.0, 5.0), -5.0), ((0.0, 9.0), 2.0), ((-4.0, -3.0), -3.0))
"""Errors of the rough motion: tilt of the axis in degrees, and the rate in per cent."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Trial:
    """One estimate beside the truth.

    Attributes:
        rate_deg_per_s: of the true spin.
        stations: how many.
        start, found: the spins before and after.
        truth: the true spin.
        start_miss_px, miss_px: how far extents disagree before and after.
    """

    rate_deg_per_s: float
    stations: int
    start: Spin
    found: Spin
    truth: Spin
    start_miss_px: float
    miss_px: float

    def row(self) -> tuple[str, ...]:
        """Return the cells of the table of estimates."""
        return (
            f"{self.rate_deg_per_s:g}°/s, {stations_text(self.stations)}",
            *(f"{axis_error_deg(spin, self.truth):.2f}°" for spin in (self.start, self.found)),
            *(
                f"{rate_error_percent(spin, self.truth):+.3f} %"
                for spin in (self.start, self.found)
            ),
            f"{self.start_miss_px:.2f}",
            f"{self.miss_px:.2f}",
        )


def axis_error_deg(spin: Spin, truth: Spin) -> float:
    """Return the angle between two spins' axes in degrees."""
    return float(np.rad2deg(spin.axis_angle_rad(truth)))


def rate_error_percent(spin: Spin, truth: Spin) -> float:
    """Return by how much a spin is faster than the true one, in per cent."""
    return 100 * (spin.rate_rad_per_s / truth.rate_rad_per_s - 1)


def stations_text(count: int) -> str:
    """Return how many stations there are, in words."""
    return f"{count} station{'s' if count > 1 else ''}"


def seen_by(spun: Sequence[SpunFrame], stations: int) -> list[SpunFrame]:
    """Return the frames of the first stations."""
    return [each for each in spun if each.station < stations]


def rough_start(number: int, truth: Spin) -> Spin:
    """Return a rough motion, by its number in `STARTS`."""
    tilt_deg, percent = STARTS[number]
    return truth.changed(np.deg2rad(tilt_deg), 1 + percent / 100)


def spin_trials(
    received: Mapping[float, Sequence[SpinningEchoes]], starts: int, progress: Progress
) -> list[Trial]:
    """Estimate the spin of echoes of several rates from rough starts, by more and more stations.

    Args:
        received: echoes by the true rate in degrees per second.
        starts: of the rough motions, so many.
        progress: told of estimates done and in all.
    """
    trials: list[Trial] = []
    total = len(received) * starts * len(STATIONS)
    for rate, echoes in received.items():
        truth = true_spin(rate)
        for number in range(starts):
            start = rough_start(number, truth)
            spun = spun_frames(echoes, start)
            for stations in range(1, len(STATIONS) + 1):
                estimate = estimate_spin([x.outline for x in seen_by(spun, stations)], start)
                trials.append(
                    Trial(
                        rate_deg_per_s=rate,
                        stations=stations,
                        start=start,
                        found=estimate.spin,
                        truth=truth,
                        start_miss_px=estimate.start_miss_px,
                        miss_px=estimate.miss_px,
                    )
                )
                progress("spins", len(trials), total)
    return trials


def trials_table(trials: Sequence[Trial]) -> Table:
    """Return estimates as a table."""
    return Table(
        title="Spin from echoes, from rough starts",
        columns=(
            "rate, stations",
            "axis error, start",
            "found",
            "rate error, start",
            "found",
            "extents' miss, start (px)",
            "found (px)",
        ),
        rows=tuple(trial.row() for trial in trials),
    )


def spin_errors(trials: Sequence[Trial], stations: int) -> tuple[list[float], list[float]]:
    """Return the axis errors (°) and the sizes of the rate errors (%) with so many stations."""
    chosen = [trial for trial in trials if trial.stations == stations]
    return (
        [axis_error_deg(trial.found, trial.truth) for trial in chosen],
        [abs(rate_error_percent(trial.found, trial.truth)) for trial in chosen],
    )
