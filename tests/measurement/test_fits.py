from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.measurement.fits import Cloud, cloud_of, fit_cylinder, fit_line, fit_plane
from core.measurement.lines import angle_between_lines_rad
from core.measurement.regions import Patch, faces_of
from tests.measurement.bodies import SHIFTS, TURNS, X, Z, box, cylinder, moved

SEEDS = st.integers(0, 2**31)


def cloud(points):
    return Cloud(
        points_m=points,
        weights=np.full(len(points), 1 / len(points)),
        normal_m2=np.zeros(3),
        area_m2=1.0,
        moments_m2=np.eye(3),
    )


def grid(*axes):
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(axes))


def on_plane(random, noise_m):
    flat = grid(np.linspace(-3, 3, 25), np.linspace(-1, 1, 9))
    return np.column_stack([flat, noise_m * random.normal(size=len(flat))])


@given(SEEDS, TURNS, SHIFTS)
@settings(max_examples=20)
def test_a_plane_is_found_exactly_and_with_noise_as_well_as_theory_allows(seed, turn, shift):
    random = np.random.default_rng(seed)
    normal = turn.apply(Z)
    exact = fit_plane(cloud(turn.apply(on_plane(random, 0)) + shift))
    assert angle_between_lines_rad(exact.direction, normal) < 1e-7
    assert exact.residual_m < 1e-9
    noisy = fit_plane(cloud(turn.apply(on_plane(random, 0.01)) + shift))
    # The standard deviation of a tilt about the long axis is 0.01 / sqrt(Σ y²), here 1.1 mrad.
    assert angle_between_lines_rad(noisy.direction, normal) < 6 * 0.0011
    assert noisy.residual_m == pytest.approx(0.01, rel=0.3)


@given(SEEDS, TURNS, SHIFTS)
@settings(max_examples=20)
def test_outliers_hardly_move_a_plane(seed, turn, shift):
    random = np.random.default_rng(seed)
    points = on_plane(random, 0.002)
    points[:20, 2] += 1.0
    robust = fit_plane(cloud(turn.apply(points) + shift))
    off = angle_between_lines_rad(robust.direction, turn.apply(Z))
    _, _, plain = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)
    assert off < 0.02 < angle_between_lines_rad(plain[2], Z)


@given(SEEDS, TURNS, SHIFTS)
@settings(max_examples=20)
def test_a_line_is_found_exactly_and_with_noise(seed, turn, shift):
    random = np.random.default_rng(seed)
    along = np.outer(np.linspace(-4, 4, 81), X)
    exact = fit_line(cloud(turn.apply(along) + shift))
    assert angle_between_lines_rad(exact.direction, turn.apply(X)) < 1e-7
    assert exact.length_m == pytest.approx(8)
    noisy = fit_line(cloud(turn.apply(along + 0.01 * random.normal(size=(81, 3))) + shift))
    # 0.01 / sqrt(Σ x²) is 0.48 mrad.
    assert angle_between_lines_rad(noisy.direction, turn.apply(X)) < 6 * 0.00048
    assert noisy.is_undirected


@given(SEEDS, TURNS, SHIFTS)
@settings(max_examples=12)
def test_a_cylinder_is_found_exactly_and_with_noise(seed, turn, shift):
    random = np.random.default_rng(seed)
    body = moved(cylinder(radius=1.2, sections=48), turn, shift)
    side = Patch(near_m=turn.apply([0.1, 0, 1.2]) + shift, angle_rad=0.3, growth="smooth")
    of_side = cloud_of(body, faces_of(side, body))
    exact = fit_cylinder(of_side)
    assert angle_between_lines_rad(exact.direction, turn.apply(X)) < 1e-6
    assert exact.radius_m == pytest.approx(1.2, abs=1e-6)
    assert exact.residual_m < 1e-6
    shaken = of_side.points_m + 0.01 * random.normal(size=of_side.points_m.shape)
    noisy = fit_cylinder(replace(of_side, points_m=shaken))
    # 0.01 / sqrt(n/2 · <x²>) with about 1000 points up to 3 m from the middle is 0.25 mrad.
    assert angle_between_lines_rad(noisy.direction, turn.apply(X)) < 6 * 0.00025
    assert noisy.radius_m == pytest.approx(1.2, abs=0.003)


def test_the_normal_of_one_side_points_out_and_that_of_two_sides_has_no_sign():
    body = box(fineness=2)
    one = fit_plane(cloud_of(body, faces_of(Patch(near_m=[0, 0, -0.5], angle_rad=0.4), body)))
    np.testing.assert_allclose(one.direction, -Z, atol=1e-9)
    assert not one.is_undirected
    both = fit_plane(cloud_of(body, np.arange(len(body.faces))))
    assert both.is_undirected


def test_what_defines_no_line_plane_or_cylinder_is_refused():
    line = np.outer(np.linspace(0, 1, 9), [1.0, 2, 3])
    with pytest.raises(ValueError, match="lie on one straight line"):
        fit_plane(cloud(line))
    with pytest.raises(ValueError, match="times as long as wide"):
        fit_line(cloud(grid(*[np.linspace(0, 1, 4)] * 3)))
    with pytest.raises(ValueError, match="at least 3"):
        fit_plane(cloud(line[:2]))
    with pytest.raises(ValueError, match="no cylinder"):
        fit_cylinder(cloud(line))
