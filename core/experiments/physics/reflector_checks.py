"""Physical optics and bouncing rays held against reflectors of known cross-section."""

from dataclasses import replace

import numpy as np
import trimesh

from core.arrays import Floats
from core.experiments.physics.bounds import bounded, decibels
from core.experiments.physics.part import Part
from core.experiments.physics.scattering_pictures import (
    Sweep,
    corner_picture,
    plate_picture,
    sphere_picture,
    tube_picture,
)
from core.radar.facets import shaded_surface
from core.radar.physical_optics import physical_optics
from core.radar.reflectors import (
    dihedral,
    dihedral_section_m2,
    sphere_section_m2,
    square_plate,
    square_plate_section_m2,
    trihedral,
    trihedral_section_m2,
)
from core.radar.scattering_models import ConductingSurface
from core.radar.waveform import SPEED_OF_LIGHT_M_PER_S
from core.targets import Target

WAVELENGTH_M = 0.03
"""Of all figures but the sphere's: 10 GHz."""

SIDE_M = 1.0
"""Of plate and corners."""

RADIUS_M = 0.5
"""Of the sphere."""


def plate_part() -> Part:
    """Compare a plate's pattern about its normal with the textbook's."""
    angle = np.linspace(0, 3.95 * WAVELENGTH_M / (2 * SIDE_M), 800)
    direction = np.stack([-np.sin(angle), 0 * angle, -np.cos(angle)], axis=1)
    mirror = _mirror(square_plate(SIDE_M))
    found = np.abs(mirror.echoes(direction, _frequencies(WAVELENGTH_M))[:, 1]) ** 2
    theory = square_plate_section_m2(SIDE_M, WAVELENGTH_M, angle)
    apart = decibels(found / np.maximum(theory, 1e-30))
    # In the nulls themselves theory is −∞ dB; 20 dB below the third sidelobe is left out.
    in_lobes = theory > 10 ** (-4.1) * theory[0]
    return Part(
        figures=(
            bounded("plate at normal incidence, off 4πA²/λ²", abs(apart[0]), "<= 0.1 dB"),
            bounded(
                "plate's sinc pattern to the third sidelobe, largest error 41 dB down",
                np.abs(apart[in_lobes]).max(),
                "<= 0.5 dB",
            ),
        ),
        pictures=(plate_picture(Sweep(place=np.rad2deg(angle), found=found, theory=theory)),),
    )


def sphere_part() -> Part:
    """Compare a sphere's cross-section with its outline's area and the elementary integral."""
    mirror = _mirror(trimesh.creation.icosphere(subdivisions=5, radius=RADIUS_M))
    wide = np.linspace(10.0, 20.0, 11)
    aspects = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
    sections = [_spectrum(mirror, each, RADIUS_M / wide) for each in aspects]
    apart = decibels(np.array(sections) / (np.pi * RADIUS_M**2))
    widths = np.geomspace(1.0, 10.0, 110)
    found = _spectrum(mirror, aspects[0], RADIUS_M / widths)
    name = "sphere of 10 to 20 wavelengths' radius, off πa²"
    theory = sphere_section_m2(RADIUS_M, RADIUS_M / widths)
    sweep = Sweep(place=widths, found=found, theory=theory)
    return Part(
        figures=(bounded(name, np.abs(apart).max(), "<= 0.5 dB"),),
        pictures=(sphere_picture(sweep, np.pi * RADIUS_M**2),),
    )


def corners_part() -> Part:
    """Compare dihedral and trihedral at their maxima, and see how tubes converge."""
    two, three = dihedral(SIDE_M, SIDE_M), trihedral(SIDE_M)
    two_m2 = dihedral_section_m2(SIDE_M, SIDE_M, WAVELENGTH_M)
    three_m2 = trihedral_section_m2(SIDE_M, WAVELENGTH_M)
    to_two, to_three = -np.array([1, 1, 0]) / np.sqrt(2), -np.array([1, 1, 1]) / np.sqrt(3)
    tubes_m = np.geomspace(0.01, 0.2, 12)
    converged = [
        np.array([decibels(_section(_mirror(shape, tube), toward) / m2) for tube in tubes_m])
        for shape, toward, m2 in ((two, to_two, two_m2), (three, to_three, three_m2))
    ]
    angle = np.deg2rad(np.linspace(0.5, 89.5, 179))
    around = -np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    # Over the trihedral in the plane of its axis and z.
    level = np.sin(angle) / np.sqrt(2)
    over = -np.stack([level, level, np.cos(angle)], axis=1)
    sweeps = [
        Sweep(
            place=np.rad2deg(angle),
            found=np.array([_section(_mirror(shape, 0.03), toward) for toward in aspects]),
            theory=np.full(len(angle), m2),
        )
        for shape, aspects, m2 in ((two, around, two_m2), (three, over, three_m2))
    ]
    return Part(
        figures=(
            bounded("dihedral at its maximum, off 8πa²b²/λ²", abs(converged[0][2]), "<= 1 dB"),
            bounded("trihedral at its maximum, off 4πa⁴/3λ²", abs(converged[1][2]), "<= 1 dB"),
        ),
        pictures=(
            corner_picture(*sweeps),
            tube_picture(tubes_m / WAVELENGTH_M, *map(np.abs, converged)),
        ),
    )


def mean_power_part() -> Part:
    """Compare a box's power over all aspects with a quarter of its surface.

    Three times the wavelength makes flashes wide enough for 2000 aspects to sample them.
    """
    mirror = replace(_mirror(trimesh.creation.box((0.3, 0.4, 0.5))), most_bounces=1)
    power = [_section(mirror, each, 3 * WAVELENGTH_M) for each in _all_around(2000)]
    off = np.abs(decibels(np.mean(power) / mirror.mean_echo_power()))
    return Part(figures=(bounded("a mirror's mean power, off its surface / 4", off, "<= 0.5 dB"),))


def _mirror(mesh: trimesh.Trimesh, tube_m: float = 0.03) -> ConductingSurface:
    surface = shaded_surface(Target(name="reflector", parts=(mesh,)), longest_edge_m=0.25)
    return ConductingSurface(surface=surface, tube_m=tube_m)


def _frequencies(wavelength_m: float) -> Floats:
    """Return a narrow band about a wavelength, which is its middle sample."""
    band: Floats = SPEED_OF_LIGHT_M_PER_S / wavelength_m * np.array([0.999, 1.0, 1.001])
    return band


def _section(
    mirror: ConductingSurface, toward: Floats, wavelength_m: float = WAVELENGTH_M
) -> float:
    """Return the cross-section in m² from one direction."""
    return float(np.abs(mirror.echoes(toward[None], _frequencies(wavelength_m))[0, 1]) ** 2)


def _spectrum(mirror: ConductingSurface, toward: Floats, wavelength_m: Floats) -> Floats:
    """Return a convex body's cross-section at wavelengths far apart, (wavelengths,)."""
    lit = mirror.surface.lit_facets(toward)
    each = [physical_optics(lit, toward[None], _frequencies(at))[0, 1] for at in wavelength_m]
    return np.abs(each) ** 2


def _all_around(count: int) -> Floats:
    """Return directions spread evenly over the sphere along a spiral, (count, 3)."""
    step = np.arange(count) + 0.5
    turn, height = np.pi * (1 + np.sqrt(5)) * step, 1 - 2 * step / count
    level = np.sqrt(1 - height**2)
    return np.stack([level * np.cos(turn), level * np.sin(turn), height], axis=1)
