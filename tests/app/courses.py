"""A pass whose line of sight first turns in a plane, then leaves it."""

from dataclasses import replace

import numpy as np

from core.geometry.track import LineOfSightTrack, track_from_angles
from core.radar.course import pass_course
from core.radar.intervals import Division


def track(*, pulses: int = 3000, station: bool = True) -> LineOfSightTrack:
    """Return 100 s of a line of sight, as a station sees it rise and set or without one."""
    share = np.linspace(0, 1, pulses)
    turned = track_from_angles(100 * share, 0.8 + 0.7 * share**16, 1.2 * (share + share**2) / 2)
    if not station:
        return turned
    return replace(
        turned, azimuth_rad=5.5 + 1.3 * share, elevation_rad=0.2 + 0.6 * np.sin(np.pi * share)
    )


COURSE = pass_course(
    track(),
    Division(
        wavelength_m=0.018, cross_range_resolution_m=0.15, target_radius_m=6.0, criterion="bending"
    ),
    label="pass 1",
)
"""With accepted, shortened and rejected intervals."""
