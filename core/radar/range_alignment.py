"""Range alignment: taking a target's unknown translation out of its echoes, to part of a cell."""

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.radar.phase_history import PhaseHistory
from core.radar.waveform import SPEED_OF_LIGHT_M_PER_S
from core.radar.window import HAMMING

OVERSAMPLING = 4
"""Samples of an envelope per Rayleigh cell; a parabola through three of them finds the peak."""

FLOOR_DB = -40.0
"""Levels of an envelope below its history's peak that count as this."""

MEMORY = 0.95
"""Share of the running average that stays when a pulse is added: about 20 pulses speak."""


def range_offsets_m(history: PhaseHistory) -> Floats:
    """Return how much farther the target stands at each pulse, (pulses,), from profiles alone.

    Each pulse's envelope, in decibels, is correlated with the running average of the aligned
    ones before it. Decibels make the whole body's extent count: a correlation of amplitudes
    follows the brightest glints, whose speckle comes and goes, and strays by 0.6 cells rms where
    this one strays by 0.15 (diffuse target, 20 dB).

    Made for one coherent interval. The offsets are those from the first pulse, modulo the
    unambiguous range. What k·d of a fixed point d adds to them is a shift of the image by d and
    cannot be observed: the body's own middle is held still.

    Source: Chen and Andrews, "Target-motion-induced radar imaging", 1980, for the correlation
    of neighbouring envelopes; Delisle and Wu, "Moving target imaging and trajectory computation
    using ISAR", 1994, for the running average.
    """
    level_db = _levels_db(history)
    spectrum = np.fft.rfft(level_db, axis=1)
    cells = level_db.shape[1]
    frequency = np.fft.rfftfreq(cells)
    offset = np.zeros(len(spectrum))
    average = spectrum[0]
    for pulse in range(1, len(spectrum)):
        correlation = np.fft.irfft(spectrum[pulse] * np.conj(average), cells)
        offset[pulse] = _peak_place(correlation)
        there = spectrum[pulse] * np.exp(2j * np.pi * frequency * offset[pulse])
        average = MEMORY * average + (1 - MEMORY) * there
    swath_m = SPEED_OF_LIGHT_M_PER_S / (2 * history.frequency_step_hz)
    offsets_m: Floats = offset * swath_m / cells
    return offsets_m


def aligned(history: PhaseHistory, offset_m: Floats) -> PhaseHistory:
    """Return the history with each pulse's target moved nearer by offset_m (pulses,), in metres.

    A farther target turns the echo at frequency f by −4πf/c per metre; this turns it back, range
    and phase together.
    """
    wavenumber = 4 * np.pi / SPEED_OF_LIGHT_M_PER_S * history.frequency_hz
    back = np.exp(1j * np.outer(offset_m, wavenumber)).astype(np.complex64)
    return PhaseHistory(
        samples=history.samples * back,
        frequency_hz=history.frequency_hz,
        track=history.track,
        sensor=history.sensor,
    )


def _levels_db(history: PhaseHistory) -> NDArray[np.float32]:
    """Return range envelopes (pulses, cells) above a floor, in dB, range 0 in the first cell."""
    count = len(history.frequency_hz)
    window = HAMMING.weights((np.arange(count) + 0.5) / count).astype(np.float32)
    envelope = np.abs(np.fft.ifft(history.samples * window, OVERSAMPLING * count, axis=1))
    peak = float(envelope.max())
    relative = envelope / (peak if peak > 0 else 1.0)
    level: NDArray[np.float32] = 20 * np.log10(np.maximum(relative, 10 ** (FLOOR_DB / 20)))
    return (level - FLOOR_DB).astype(np.float32)


def _peak_place(correlation: Floats) -> float:
    """Return where a circular correlation peaks, in cells from −half to half its length."""
    length = len(correlation)
    top = int(np.argmax(correlation))
    before, peak, after = (float(correlation[(top + step) % length]) for step in (-1, 0, 1))
    bend = before - 2 * peak + after
    place = top + (0.5 * (before - after) / bend if bend < 0 else 0.0)
    return place - length if place > length / 2 else place
