import numpy as np
import pytest
import trimesh

from core.geometry.grid import VoxelGrid
from core.hull.surface import hull_surface, mask_surface
from tests.hull.test_mesher import box_volume

GRID = VoxelGrid.cube(side_m=8.0, spacing_m=0.25)


def ball(radius_m):
    return np.linalg.norm(GRID.centres_m(), axis=-1) < radius_m


def test_the_surface_encloses_the_body_at_true_scale_and_faces_outward():
    surface = mask_surface(ball(3.0), GRID)
    assert surface.volume_m3() == pytest.approx(4 / 3 * np.pi * 27, rel=0.02)
    assert np.linalg.norm(surface.vertices_m, axis=1) == pytest.approx(
        np.full(len(surface.vertices_m), 3.0), abs=0.25
    )
    mesh = trimesh.Trimesh(surface.vertices_m, surface.faces)
    assert mesh.is_watertight
    assert mesh.is_winding_consistent


def test_a_hull_that_fills_the_grid_is_closed_at_its_boundary():
    surface = mask_surface(np.ones(GRID.shape, bool), GRID)
    assert trimesh.Trimesh(surface.vertices_m, surface.faces).is_watertight
    reach = 0.5 * GRID.spacing_m
    assert surface.vertices_m.max(axis=0) == pytest.approx(GRID.upper_m + reach)


def test_an_empty_hull_has_an_empty_surface():
    surface = mask_surface(np.zeros(GRID.shape, bool), GRID)
    assert surface.is_empty
    assert surface.volume_m3() == 0


def test_both_exact_meshers_can_be_asked_for():
    volume, _ = box_volume()
    snapped, dual = (hull_surface(volume, method=method) for method in ("snapped", "dual"))
    assert np.array_equal(snapped.vertices_m, hull_surface(volume).vertices_m)
    assert len(dual.vertices_m) != len(snapped.vertices_m)
    with pytest.raises(ValueError, match='"snapped" or "dual", not "cubes"'):
        hull_surface(volume, method="cubes")
