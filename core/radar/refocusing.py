"""Echoes brought back into focus from themselves: range alignment, then autofocus."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

import numpy as np

from core.arrays import Floats
from core.geometry.projection import range_doppler_projection
from core.geometry.track import accumulated_turn_rad
from core.radar.autofocus import (
    centring_phase_rad,
    minimum_entropy,
    phase_corrected,
    phase_gradient,
)
from core.radar.backprojection import pulse_contributions
from core.radar.phase_history import PhaseHistory
from core.radar.range_alignment import aligned, range_offsets_m
from core.radar.waveform import SPEED_OF_LIGHT_M_PER_S

Autofocus = Literal["none", "phase-gradient", "minimum-entropy"]

LARGEST_CONTRIBUTIONS = 16_000_000
"""Pulses × pixels that autofocus looks at, 128 MB; at least `LEAST_ROWS` rows all the same."""

LEAST_ROWS = 16


@dataclass(frozen=True, slots=True, kw_only=True)
class RefocusSettings:
    """How echoes are brought into focus.

    Attributes:
        autofocus: what finds the pulses' phases; the minimum entropy goes on from the phase
            gradient's, as from zero it may end in another minimum.
        aligns: whether the pulses' ranges are aligned first.
    """

    autofocus: Autofocus = "minimum-entropy"
    aligns: bool = True

    @property
    def is_active(self) -> bool:
        """Whether anything is done at all."""
        return self.aligns or self.autofocus != "none"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PulseCorrection:
    """What one coherent interval's pulses are off by.

    Attributes:
        offset_m: (pulses,) by how much the target stands too far.
        phase_rad: (pulses,) by how much the phase is ahead besides.
    """

    offset_m: Floats
    phase_rad: Floats

    def removed_from(self, history: PhaseHistory) -> PhaseHistory:
        """Return the history of the same pulses without these errors."""
        return phase_corrected(aligned(history, self.offset_m), self.phase_rad)


def pulse_correction(history: PhaseHistory, settings: RefocusSettings) -> PulseCorrection:
    """Return what the pulses of one coherent interval are off by, from its echoes alone.

    Unknown stay a shift of the whole image and a constant phase (`range_offsets_m`,
    `autofocus`). Where the ranges are aligned, the body's middle comes to the origin.
    """
    none = np.zeros(len(history.track))
    offset_m = range_offsets_m(history) if settings.aligns else none
    level = aligned(history, offset_m)
    phase_rad = none if settings.autofocus == "none" else _phases_rad(level, settings)
    return PulseCorrection(offset_m=offset_m, phase_rad=phase_rad)


def _phases_rad(history: PhaseHistory, settings: RefocusSettings) -> Floats:
    """Return the pulses' phases, (pulses,), in two steps.

    After the first, aligned echoes can be centred, and only then walk as their place in the image
    says: what the second step sees is sharp.
    """
    contributions = pulse_contributions(history, focus_points_m(history))
    finds = {"phase-gradient": phase_gradient, "minimum-entropy": minimum_entropy}
    phase_rad = np.zeros(len(history.track))
    for find in (phase_gradient, finds[settings.autofocus]):
        more_rad = find(contributions)
        if settings.aligns:
            left = phase_corrected(history, phase_rad + more_rad)
            more_rad = more_rad + centring_phase_rad(left)
        contributions *= np.exp(-1j * more_rad).astype(np.complex64)[:, None, None]
        phase_rad = phase_rad + more_rad
    return phase_rad


def focused(history: PhaseHistory, settings: RefocusSettings | None = None) -> PhaseHistory:
    """Return the echoes of one coherent interval aligned and in focus."""
    return pulse_correction(history, settings or RefocusSettings()).removed_from(history)


def refocused(
    history: PhaseHistory,
    intervals: Sequence[tuple[int, int]],
    settings: RefocusSettings,
    progress: Callable[[int, int], None] = lambda _done, _total: None,
) -> PhaseHistory:
    """Return a whole history whose coherent intervals are each aligned and in focus.

    Args:
        history: echoes of a pass.
        intervals: (start, stop) pulses of each, in order.
        settings: what is done; pulses of no interval stay as they are.
        progress: told how many intervals are done, of how many.

    Raises:
        ValueError: two intervals share pulses, each of which can be corrected only once.
    """
    for (_, end), (start, _) in pairwise(intervals):
        if start < end:
            raise ValueError(
                "Autofocus corrects every coherent interval by itself, so intervals must not "
                f"overlap; pulse {start} is in two of them. Ask for an overlap of 0."
            )
    samples = history.samples.copy()
    for done, (start, stop) in enumerate(intervals, start=1):
        samples[start:stop] = focused(history.part(start, stop), settings).samples
        progress(done, len(intervals))
    return PhaseHistory(
        samples=samples,
        frequency_hz=history.frequency_hz,
        track=history.track,
        sensor=history.sensor,
    )


def focus_points_m(history: PhaseHistory) -> Floats:
    """Return the pixels (rows, columns, 3) that autofocus looks at, on the middle slant plane.

    Rows are the range cells with most power, up to half of the swath; the columns, one per
    pulse, cover the unambiguous cross-range, so that no phases can push energy out of sight.
    """
    track, pulses = history.track, len(history.track)
    middle = pulses // 2
    turn_rad = float(accumulated_turn_rad(track.line_of_sight)[-1])
    projection = range_doppler_projection(
        line_of_sight=track.line_of_sight[middle],
        line_of_sight_rate_per_s=track.line_of_sight_rate_per_s[middle],
        row_spacing_m=SPEED_OF_LIGHT_M_PER_S / (2 * history.bandwidth_hz),
        column_spacing_m=history.wavelength_m / (2 * turn_rad) * (pulses - 1) / pulses,
        shape=(0, pulses),
    )
    rows = _strongest_cells(history)
    pixels = np.stack(np.meshgrid(rows, np.arange(pulses), indexing="ij"), axis=-1)
    return projection.plane_points(pixels.astype(np.float64))


def _strongest_cells(history: PhaseHistory) -> Floats:
    """Return the range cells, counted from the origin, that hold most power, in order."""
    pulses, count = history.samples.shape
    power = np.square(np.abs(np.fft.ifft(history.samples, axis=1))).mean(axis=0)
    most = max(LARGEST_CONTRIBUTIONS // pulses**2, LEAST_ROWS)
    strongest = np.argsort(-power)[: max(min(most, count // 2), 1)]
    cells: Floats = np.sort(np.fft.fftfreq(count)[strongest] * count)
    return cells
