import numpy as np
import pytest

from core.radar.reflectors import (
    dihedral,
    dihedral_section_m2,
    sphere_section_m2,
    square_plate,
    square_plate_section_m2,
    trihedral,
    trihedral_section_m2,
)


def test_they_have_the_size_asked_for_and_look_where_they_say():
    assert square_plate(0.5).area == pytest.approx(0.25)
    assert square_plate(0.5).face_normals == pytest.approx(np.array([[0, 0, 1.0]] * 2))
    assert dihedral(0.5, 2.0).area == pytest.approx(2 * 0.5 * 2.0)
    assert dihedral(0.5, 2.0).face_normals.min() > -1e-9
    assert trihedral(0.5).area == pytest.approx(3 * 0.125)
    assert trihedral(0.5).face_normals.min() > -1e-9


def test_a_corner_returns_as_a_plate_of_its_open_area():
    """Seen along the bisector every ray comes back in step: 4π A² / λ² of what is open to it."""
    assert square_plate_section_m2(0.5, 0.03, np.zeros(1)) == pytest.approx(
        4 * np.pi * 0.25**2 / 0.03**2
    )
    open_area = np.sqrt(2) * 0.5 * 2.0
    assert dihedral_section_m2(0.5, 2.0, 0.03) == pytest.approx(4 * np.pi * open_area**2 / 0.03**2)
    # Of a triangle only the hexagon returns, two thirds of the √3/2 a².
    hexagon = np.sqrt(3) / 2 * 0.5**2 * 2 / 3
    assert trihedral_section_m2(0.5, 0.03) == pytest.approx(4 * np.pi * hexagon**2 / 0.03**2)


def test_a_wide_sphere_returns_its_outline():
    assert sphere_section_m2(0.5, np.array([1e-4])) == pytest.approx(np.pi * 0.25, rel=1e-3)
    # By numbers: the same integral over the polar angle.
    angle = (np.arange(200_000) + 0.5) / 200_000 * np.pi / 2
    wavenumber = 4 * np.pi / 0.2
    lit = np.cos(angle) * np.exp(1j * wavenumber * 0.5 * np.cos(angle)) * np.sin(angle)
    integral = 2 * np.pi * 0.25 * lit.mean() * np.pi / 2
    wanted = wavenumber**2 / (4 * np.pi) * abs(integral) ** 2
    assert sphere_section_m2(0.5, np.array([0.2])) == pytest.approx(wanted, rel=1e-6)
