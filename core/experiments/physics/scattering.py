"""Scattering held against theory: plate, sphere, corners, flashes, noise and a bistatic pair."""

from core.experiments.physics.echo_checks import (
    bistatic_part,
    glint_part,
    noise_part,
    speed_part,
)
from core.experiments.physics.part import Part, Progress
from core.experiments.physics.reflector_checks import (
    corners_part,
    mean_power_part,
    plate_part,
    sphere_part,
)

CHECKS = (
    plate_part,
    sphere_part,
    corners_part,
    mean_power_part,
    noise_part,
    bistatic_part,
    glint_part,
    speed_part,
)


def scattering_part(progress: Progress) -> Part:
    """Measure every claim about echoes against theory, and draw it.

    Args:
        progress: told of stage, steps done and steps in all.
    """
    parts = []
    for number, check in enumerate(CHECKS, start=1):
        parts.append(check())
        progress("scattering", number, len(CHECKS))
    return Part(
        figures=tuple(figure for part in parts for figure in part.figures),
        pictures=tuple(picture for part in parts for picture in part.pictures),
    )
