import numpy as np
import pytest
import trimesh

from core.radar.scatterers import lit_amplitudes, surface_scatterers
from core.targets import Target


def plates():
    """A small plate 2 m before (towards −x) a large one."""
    front = trimesh.creation.box((0.1, 1.0, 1.0))
    front.apply_translation([-2.0, 0, 0])
    back = trimesh.creation.box((0.1, 4.0, 4.0))
    return Target(name="plates", parts=(front, back))


def test_what_stands_behind_is_dark_and_what_faces_away_too():
    points = surface_scatterers(plates(), count=20_000, random=np.random.default_rng(0))
    amplitude = lit_amplitudes(points, np.array([1.0, 0.0, 0.0]))
    x, y, z = points.position_m.T
    behind = (np.abs(x + 0.05) < 1e-6) & (np.abs(y) < 0.49) & (np.abs(z) < 0.49)
    beside = (np.abs(x + 0.05) < 1e-6) & (np.abs(y) > 0.51)
    away = np.abs(x - 0.05) < 1e-6
    assert behind.sum() > 100
    assert not amplitude[behind].any()
    assert not amplitude[away].any()
    assert amplitude[beside].all()


def test_power_is_the_projected_area():
    points = surface_scatterers(plates(), count=50_000, random=np.random.default_rng(0))
    tilt = np.array([np.cos(0.4), np.sin(0.4), 0.0])
    back_only = Target(name="back", parts=(plates().parts[1],))
    lone = surface_scatterers(back_only, count=50_000, random=np.random.default_rng(0))
    power = np.sum(np.abs(lit_amplitudes(lone, tilt)) ** 2)
    assert power == pytest.approx(16 * np.cos(0.4) + 0.4 * np.sin(0.4), rel=0.02)
    front = np.sum(np.abs(lit_amplitudes(points, np.array([1.0, 0, 0]))) ** 2)
    assert front == pytest.approx(16, rel=0.03)


def test_an_empty_mesh_is_refused():
    with pytest.raises(ValueError, match="no surface"):
        surface_scatterers(
            Target(name="nothing", parts=(trimesh.Trimesh(),)),
            count=10,
            random=np.random.default_rng(0),
        )
