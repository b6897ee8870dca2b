import numpy as np
import pytest
import trimesh
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from core.radar.facets import Facets, shaded_surface
from core.radar.physical_optics import physical_optics
from core.radar.reflectors import square_plate
from core.radar.waveform import SPEED_OF_LIGHT_M_PER_S
from core.targets import Target

WAVELENGTH_M = 0.03
FREQUENCY_HZ = SPEED_OF_LIGHT_M_PER_S / WAVELENGTH_M * np.linspace(0.97, 1.03, 9)


def lit(surface):
    return Facets(
        corners_m=surface.triangles, normal=surface.face_normals, share=np.ones(len(surface.faces))
    )


def by_quadrature(corners_m, normal, direction, frequency_hz, parts):
    """The surface integral of one triangle by the midpoint rule on parts² smaller ones, slowly."""
    weights = []
    for i in range(parts):
        for j in range(parts - i):
            weights.append([(i + 1 / 3) / parts, (j + 1 / 3) / parts])
            if i + j < parts - 1:
                weights.append([(i + 2 / 3) / parts, (j + 2 / 3) / parts])
    sides = corners_m[1:] - corners_m[0]
    place = corners_m[0] + np.array(weights) @ sides
    area = np.linalg.norm(np.cross(*sides)) / 2
    wavenumber = 4 * np.pi * np.asarray(frequency_hz) / SPEED_OF_LIGHT_M_PER_S
    mean = np.exp(-1j * np.outer(wavenumber, place @ direction)).mean(axis=1)
    return -1j * wavenumber / np.sqrt(4 * np.pi) * max(-normal @ direction, 0) * area * mean


@settings(max_examples=30)
@given(
    seed=st.integers(0, 2**32 - 1),
    tilt_rad=st.one_of(st.just(0.0), st.floats(0, 0.02), st.floats(0, 1.5)),
    size_m=st.floats(0.01, 0.3),
    scale=st.floats(0.5, 1.0),
)
def test_the_closed_form_equals_the_quadrature_at_the_flash_and_away(seed, tilt_rad, size_m, scale):
    random = np.random.default_rng(seed)
    corners = random.uniform(-size_m, size_m, (3, 3)) + random.uniform(-3, 3, 3)
    facet = trimesh.Trimesh(corners, [[0, 1, 2]], process=False)
    normal = facet.face_normals[0]
    assume(facet.area > 0.05 * size_m**2)
    side = (
        corners[random.integers(3)] - corners[0] if random.random() < 0.5 else random.normal(size=3)
    )
    across = np.cross(normal, side)
    assume(np.linalg.norm(across) > 1e-6)
    across /= np.linalg.norm(across)
    direction = scale * (-np.cos(tilt_rad) * normal + np.sin(tilt_rad) * across)
    fast = physical_optics(lit(facet), direction[None], FREQUENCY_HZ)[0]
    slow = by_quadrature(corners, normal, direction, FREQUENCY_HZ, 100)
    # Of a facet's flash; the quadrature's own error is largest on large ones.
    flash = np.sqrt(4 * np.pi) * facet.area / WAVELENGTH_M
    assert np.abs(fast - slow).max() < 3e-3 * flash


def test_a_square_plate_has_the_textbook_pattern_to_the_third_sidelobe():
    side, wavelength = 1.0, WAVELENGTH_M
    angle = np.linspace(0, 3.9 * wavelength / (2 * side), 200)
    direction = np.stack([-np.sin(angle), 0 * angle, -np.cos(angle)], axis=1)
    middle = physical_optics(lit(square_plate(side)), direction, FREQUENCY_HZ)[:, 4]
    sections = np.abs(middle) ** 2
    normal = 4 * np.pi * side**4 / wavelength**2
    assert 10 * np.log10(sections[0] / normal) == pytest.approx(0, abs=0.1)
    pattern = normal * np.cos(angle) ** 2 * np.sinc(2 * side / wavelength * np.sin(angle)) ** 2
    assert np.abs(sections - pattern).max() < 1e-5 * normal
    away_from_nulls = pattern > 1e-4 * normal
    assert np.abs(10 * np.log10(sections / pattern)[away_from_nulls]).max() < 0.5


def test_two_halves_are_a_whole():
    direction = -np.array([[0.3, 0.2, 0.9], [0.0, 0.0, 1.0], [0.01, 0.0, 1.0]])
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    target = Target(name="plate", parts=(square_plate(1.0),))
    pieces = shaded_surface(target, longest_edge_m=0.2)
    cut = Facets(
        corners_m=pieces.piece_corners_m,
        normal=pieces.mesh.face_normals[pieces.face],
        share=np.ones(len(pieces.face)),
    )
    whole = physical_optics(lit(square_plate(1.0)), direction, FREQUENCY_HZ)
    again = physical_optics(cut, direction, FREQUENCY_HZ)
    assert np.abs(again - whole).max() < 2e-5 * np.abs(whole).max()


def test_a_sphere_returns_its_cross_section_and_shows_only_its_near_side():
    radius = 0.5
    ball = Target(name="ball", parts=(trimesh.creation.icosphere(subdivisions=5, radius=radius),))
    surface = shaded_surface(ball, longest_edge_m=1.0)
    for direction in np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]:
        amplitude = physical_optics(surface.lit_facets(direction), direction[None], FREQUENCY_HZ)[0]
        decibels = 10 * np.log10(np.abs(amplitude) ** 2 / (np.pi * radius**2))
        assert np.abs(decibels).max() < 0.5
        # The phase is that of the near side's point −r k.
        turn = np.polyfit(FREQUENCY_HZ, np.unwrap(np.angle(amplitude)), 1)[0]
        place = -turn * SPEED_OF_LIGHT_M_PER_S / (4 * np.pi)
        assert place == pytest.approx(-radius, abs=0.01)


def test_what_faces_away_returns_nothing():
    assert not physical_optics(
        lit(square_plate(1.0)), np.array([[0.0, 0.6, 0.8]]), FREQUENCY_HZ
    ).any()


def test_the_mean_over_all_aspects_is_a_quarter_of_the_surface():
    """As for the diffuse model, so that both can be mixed and share a noise level."""
    box = trimesh.creation.box((0.3, 0.4, 0.5))
    count = np.arange(2000) + 0.5
    turn, height = np.pi * (1 + np.sqrt(5)) * count, 1 - 2 * count / 2000
    level = np.sqrt(1 - height**2)
    direction = np.stack([level * np.cos(turn), level * np.sin(turn), height], axis=1)
    power = np.abs(physical_optics(lit(box), direction, FREQUENCY_HZ[:2] / 3)) ** 2
    assert power.mean() == pytest.approx(box.area / 4, rel=0.05)
