"""Tracking errors: what puts a frame off its place in range and cross-range."""

import numpy as np

from core.radar.phase_history import PhaseHistory
from core.radar.waveform import SPEED_OF_LIGHT_M_PER_S


def displaced(history: PhaseHistory, *, range_m: float, cross_range_m: float) -> PhaseHistory:
    """Return the echoes of the target as far off as a wrong track says.

    The target stands `range_m` farther and `cross_range_m` further along dk/dt, both at the
    middle pulse, than where motion compensation puts the target frame's origin: its image is
    moved by as much, and loses no focus over one coherent interval.

    Args:
        history: of one coherent interval.
        range_m: along k of the middle pulse.
        cross_range_m: along dk/dt of the middle pulse.
    """
    track = history.track
    middle = len(track) // 2
    along = track.line_of_sight[middle]
    rate = track.line_of_sight_rate_per_s[middle]
    across = rate - along * (along @ rate)
    error_m = range_m * along + cross_range_m * across / np.linalg.norm(across)
    wavenumber = 4 * np.pi / SPEED_OF_LIGHT_M_PER_S * history.frequency_hz
    turn = np.exp(-1j * np.outer(track.line_of_sight @ error_m, wavenumber))
    return PhaseHistory(
        samples=(history.samples * turn).astype(np.complex64),
        frequency_hz=history.frequency_hz,
        track=track,
        sensor=history.sensor,
    )
