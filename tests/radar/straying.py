"""Targets whose translation nobody told the radar."""

import numpy as np

from core.geometry.track import random_views_track
from core.radar.echoes import point_echoes, simulate_echoes
from core.radar.phase_history import PhaseHistory
from core.radar.scatterers import surface_scatterers
from core.radar.waveform import Waveform
from core.targets import tiangong_like

WAVEFORM = Waveform(frequency_count=128)
CELL_M = WAVEFORM.range_resolution_m
TURN_RAD = WAVEFORM.wavelength_m / (2 * 0.15)


def track(*, pulses=128, seed=0, turn_rad=TURN_RAD):
    return random_views_track(
        views=1,
        turn_rad=turn_rad,
        pulses_per_view=pulses,
        pulse_repetition_frequency_hz=100.0,
        random=np.random.default_rng(seed),
    )


def points_history(
    positions_m=((2.0, 1.0, -0.5), (-1.5, 0.5, 1.0), (0.5, -2.5, 0.3)), amplitude=1.0
):
    """Three points that turn, without noise."""
    line = track()
    frequency_hz = WAVEFORM.frequencies_hz()
    samples = point_echoes(
        np.array(positions_m),
        np.full(len(positions_m), amplitude, dtype=complex),
        line.line_of_sight,
        frequency_hz,
    )
    return PhaseHistory(samples=samples, frequency_hz=frequency_hz, track=line)


def body_history(*, seed, pulses=192):
    """A smaller laboratory at 20 dB, and a way of 2 m and a cell at random, (pulses,)."""
    random = np.random.default_rng(seed)
    body = tiangong_like(length_m=6.0, diameter_m=2.0, span_m=9.0, panel_width_m=1.6)
    history = simulate_echoes(
        surface_scatterers(body, count=2500, random=random),
        track(pulses=pulses, seed=seed),
        WAVEFORM,
        signal_to_noise_db=20.0,
        random=random,
    )
    time = np.linspace(-1, 1, pulses)
    smooth = np.polynomial.Polynomial([0, *random.uniform(-1, 1, 3)])(time)
    way_m = 2 * smooth / np.ptp(smooth) + random.uniform(-0.5, 0.5, pulses) * CELL_M
    return history, way_m
