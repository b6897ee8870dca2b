"""Reflectors whose radar cross-section the textbooks give, to hold the simulation against.

Source: Knott, Shaeffer and Tuley, "Radar Cross Section", 2nd edition, 2004, chapters 5 and 6.
"""

from collections.abc import Sequence

import numpy as np
import trimesh

from core.arrays import Floats


def square_plate(side_m: float) -> trimesh.Trimesh:
    """Return a square across z that looks towards +z."""
    half = side_m / 2
    corners = [[-half, -half, 0], [half, -half, 0], [half, half, 0], [-half, half, 0]]
    return _mesh(corners, [[0, 1, 2], [0, 2, 3]])


def dihedral(side_m: float, length_m: float) -> trimesh.Trimesh:
    """Return two plates that meet at a right angle along z and look towards +x and +y."""
    a, b = side_m, length_m / 2
    corners = [[0, 0, -b], [a, 0, -b], [a, 0, b], [0, 0, b], [0, a, -b], [0, a, b]]
    return _mesh(corners, [[0, 2, 1], [0, 3, 2], [0, 4, 5], [0, 5, 3]])


def trihedral(side_m: float) -> trimesh.Trimesh:
    """Return three right triangles that meet at the origin, open towards +x, +y and +z."""
    a = side_m
    return _mesh([[0, 0, 0], [a, 0, 0], [0, a, 0], [0, 0, a]], [[0, 1, 2], [0, 2, 3], [0, 3, 1]])


def square_plate_section_m2(side_m: float, wavelength_m: float, angle_rad: Floats) -> Floats:
    """Return 4π A² / λ² cos²θ sinc²(2 a sin θ / λ), θ off the normal towards a side."""
    lobes = np.sinc(2 * side_m / wavelength_m * np.sin(angle_rad))
    section: Floats = 4 * np.pi * side_m**4 / wavelength_m**2 * (np.cos(angle_rad) * lobes) ** 2
    return section


def dihedral_section_m2(side_m: float, length_m: float, wavelength_m: float) -> float:
    """Return 8π a² b² / λ², seen along the bisector of both plates."""
    return 8 * np.pi * (side_m * length_m / wavelength_m) ** 2


def trihedral_section_m2(side_m: float, wavelength_m: float) -> float:
    """Return 4π a⁴ / 3 λ², seen equally from all three plates; a are the inner edges."""
    return 4 * np.pi * side_m**4 / (3 * wavelength_m**2)


def sphere_section_m2(radius_m: float, wavelength_m: Floats) -> Floats:
    """Return physical optics' own section of a sphere; π a² where it is many wavelengths wide.

    Source: the surface integral over the lit half, elementary for a sphere: with x = 4π a / λ,
    σ = π a² |−j exp(jx) + (exp(jx) − 1) / x|².
    """
    x = 4 * np.pi * radius_m / np.asarray(wavelength_m)
    turned = np.exp(1j * x)
    section: Floats = np.pi * radius_m**2 * np.abs(-1j * turned + (turned - 1) / x) ** 2
    return section


def _mesh(corners: Sequence[Sequence[float]], faces: Sequence[Sequence[int]]) -> trimesh.Trimesh:
    return trimesh.Trimesh(np.array(corners, dtype=np.float64), faces, process=False)
