import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from core.radar.bouncing_rays import bounce_points
from core.radar.reflectors import dihedral, square_plate, trihedral

WAVELENGTH_M = 0.03


def summed(points, line_of_sight, wavelength_m=WAVELENGTH_M):
    phase = 4 * np.pi / wavelength_m * (points.position_m @ line_of_sight)
    return np.sum(points.amplitude * np.exp(-1j * phase))


def unit(*vector):
    return np.array(vector) / np.linalg.norm(vector)


@pytest.mark.parametrize(("side_m", "length_m"), [(1.0, 1.0), (0.6, 1.5)])
def test_a_dihedral_returns_the_textbook_section(side_m, length_m):
    shape, toward = dihedral(side_m, length_m), unit(-1, -1, 0)
    points = bounce_points(shape, toward, wavelength_m=WAVELENGTH_M, tube_m=0.02)
    assert set(points.bounces) == {2}
    section = 8 * np.pi * side_m**2 * length_m**2 / WAVELENGTH_M**2
    assert 10 * np.log10(abs(summed(points, toward)) ** 2 / section) == pytest.approx(0, abs=0.2)
    # Every path is as long as one to the seam.
    assert np.abs(points.position_m[:, :2] @ toward[:2]).max() < 1e-9


def test_a_trihedral_returns_the_textbook_section_after_three_bounces():
    shape, toward = trihedral(1.0), unit(-1, -1, -1)
    points = bounce_points(shape, toward, wavelength_m=WAVELENGTH_M, tube_m=0.02)
    section = 4 * np.pi / (3 * WAVELENGTH_M**2)
    assert 10 * np.log10(abs(summed(points, toward)) ** 2 / section) == pytest.approx(0, abs=0.2)
    two = bounce_points(shape, toward, wavelength_m=WAVELENGTH_M, tube_m=0.02, most_bounces=2)
    assert abs(summed(two, toward)) ** 2 < 1e-4 * section


@settings(max_examples=20)
@given(seed=st.integers(0, 2**32 - 1))
def test_paths_are_as_long_from_anywhere_near_as_rays_traced_from_there(seed):
    """The phase is linear in k: points traced from one aspect give the flash seen from another."""
    random = np.random.default_rng(seed)
    toward = unit(*(-1 + random.uniform(-0.1, 0.1, 3)))
    other = unit(*(toward + random.normal(size=3) * 0.003))
    here = bounce_points(trihedral(1.0), toward, wavelength_m=WAVELENGTH_M, tube_m=0.02)
    there = bounce_points(trihedral(1.0), other, wavelength_m=WAVELENGTH_M, tube_m=0.02)
    three = [summed(points, other) for points in (here, there)]
    assert abs(three[0] - three[1]) < 0.05 * abs(three[1])


def test_the_polarisation_turns_over_in_a_dihedral_at_half_a_right_angle():
    shape, toward = dihedral(1.0, 1.0), unit(-1, -1, 0)
    amplitude = [
        summed(
            bounce_points(
                shape,
                toward,
                wavelength_m=WAVELENGTH_M,
                tube_m=0.03,
                polarisation=np.cos(turn) * np.array([0, 0, 1.0]) + np.sin(turn) * unit(1, -1, 0),
            ),
            toward,
        )
        for turn in (0.0, np.pi / 4, np.pi / 2)
    ]
    assert amplitude[2] == pytest.approx(-amplitude[0], rel=0.02)
    assert abs(amplitude[1]) < 0.02 * abs(amplitude[0])


def test_a_convex_body_has_no_second_bounce():
    for shape in (trimesh.creation.icosphere(subdivisions=3), square_plate(1.0)):
        points = bounce_points(shape, unit(1, 2, -3), wavelength_m=WAVELENGTH_M, tube_m=0.03)
        assert len(points.amplitude) == 0


def test_what_a_wall_hides_from_the_radar_returns_nothing():
    """A dihedral behind a wall with a slit: rays get in at one mirror only, out by none."""
    open_points = bounce_points(dihedral(1.0, 1.0), unit(-1, -1, 0), wavelength_m=0.03, tube_m=0.02)
    wall = trimesh.creation.box((0.02, 0.45, 1.2))
    wall.apply_translation([0, 0.45, 0])
    wall.apply_transform(trimesh.geometry.align_vectors([1, 0, 0], [1, 1, 0]))
    wall.apply_translation([1.2, 1.2, 0])
    both = trimesh.util.concatenate([dihedral(1.0, 1.0), wall])
    points = bounce_points(both, unit(-1, -1, 0), wavelength_m=0.03, tube_m=0.02)
    first = points.position_m[points.bounces == 2]
    assert 0 < len(first) < 0.6 * len(open_points.amplitude)


def test_each_reflection_keeps_its_share():
    whole, half = (
        bounce_points(
            trihedral(1.0), unit(-1, -1, -1), wavelength_m=0.03, tube_m=0.05, reflection=share
        )
        for share in (1.0, 0.5)
    )
    assert np.allclose(half.amplitude, whole.amplitude * 0.5**whole.bounces)


@pytest.mark.parametrize(
    ("options", "wanted"),
    [
        ({"wavelength_m": 0.0}, "positive metres"),
        ({"tube_m": -1.0}, "positive metres"),
        ({"most_bounces": 1}, "at least 2 bounces"),
        ({"tube_m": 1e-5}, "use wider ones"),
    ],
)
def test_what_cannot_be_traced_is_refused(options, wanted):
    chosen = {"wavelength_m": 0.03, "tube_m": 0.05, **options}
    with pytest.raises(ValueError, match=wanted):
        bounce_points(trihedral(1.0), unit(-1, -1, -1), **chosen)
