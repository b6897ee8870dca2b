from dataclasses import replace

import numpy as np
import pytest
import trimesh

from core.geometry.grid import VoxelGrid
from core.geometry.projection import Projection
from core.hull.blame import removed_alone_m3
from core.hull.mesher import SurfaceMesher
from core.hull.reprojection import reprojected_mask
from core.hull.surface import hull_surface
from core.hull.view import View
from core.hull.volume import VoteVolume
from core.silhouettes.silhouette import Silhouette

GRID = VoxelGrid.cube(side_m=8.0, spacing_m=0.25)
HALF_M = np.array([2.03, 1.41, 0.77])


def box_view(axis, half_m=HALF_M, rows_px=40.0):
    """The outline of a box seen along an axis, 10 pixels per metre."""
    others = [other for other in range(3) if other != axis]
    reach = 10 * np.asarray(half_m)[others]
    ring = rows_px + reach * np.array([[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]])
    matrix = np.zeros((2, 4))
    matrix[[0, 1], others] = 10
    matrix[:, 3] = rows_px
    silhouette = Silhouette(rings=(ring,), image_shape=(80, 80), claim="complete")
    return View(silhouette=silhouette, projection=Projection(matrix=matrix))


def box_volume():
    volume = VoteVolume(GRID)
    numbers = volume.add_many([box_view(axis) for axis in range(3)])
    return volume, numbers


def test_vertices_lie_on_the_true_hull_between_voxels():
    surface = hull_surface(box_volume()[0])
    beyond = np.abs(surface.vertices_m) - HALF_M
    assert np.abs(beyond.max(axis=1)).max() < 1e-6
    assert surface.vertices_m.max(axis=0) == pytest.approx(HALF_M, abs=1e-6)
    mesh = trimesh.Trimesh(surface.vertices_m, surface.faces)
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    # Between exact vertices marching cubes cuts edges and corners off.
    assert surface.volume_m3() == pytest.approx(8 * HALF_M.prod(), rel=0.02)


def test_a_view_alone_is_blamed_for_what_it_alone_removes():
    volume, numbers = box_volume()
    narrow = [1.0, *HALF_M[1:]]
    volume.replace(numbers[2], box_view(2, narrow))
    blamed = removed_alone_m3(volume)
    kept = VoteVolume(GRID)
    kept.add_many([box_view(0), box_view(1)])
    removed = (kept.hull().sum() - volume.hull().sum()) * GRID.spacing_m**3
    assert blamed[numbers[2]] == pytest.approx(removed)


def test_a_view_goes_whose_last_change_touched_nothing():
    volume, _ = box_volume()
    wide = volume.add(box_view(0, HALF_M + 1.5))
    volume.surface()
    volume.replace(wide, box_view(0, HALF_M + 1.6))
    volume.surface()
    volume.replace(wide, replace(box_view(0), projection=box_view(1).projection))
    expected = hull_surface(volume)
    assert np.array_equal(volume.surface().vertices_m, expected.vertices_m)


def test_a_hull_reprojects_into_its_silhouette():
    volume, _ = box_volume()
    view = box_view(1)
    mask = reprojected_mask(hull_surface(volume), view.projection, view.silhouette.image_shape)
    assert not np.any(mask & ~view.silhouette.mask())
    assert mask.sum() > 0.95 * view.silhouette.mask().sum()


def test_a_self_crossing_outline_is_repaired_and_said():
    view = box_view(0)
    crossed = view.silhouette.rings[0][[0, 2, 1, 3]]
    silhouette = Silhouette(rings=(crossed,), image_shape=(80, 80), claim="complete")
    volume = VoteVolume(GRID)
    number = volume.add(View(silhouette=silhouette, projection=view.projection))
    assert "crossed itself" in volume.repair_note(number)
    assert volume.votes.max() == 1


def test_an_outline_on_a_line_is_refused():
    line = np.array([[0.0, 0.0], [5.0, 5.0], [9.0, 9.0]])
    silhouette = Silhouette(rings=(line,), image_shape=(80, 80), claim="complete")
    with pytest.raises(ValueError, match="encloses no area"):
        VoteVolume(GRID).add(View(silhouette=silhouette, projection=box_view(0).projection))


def test_an_unknown_view_is_refused_with_those_there_are():
    volume, _ = box_volume()
    with pytest.raises(ValueError, match="no view number 7 in this volume; it has 0, 1, 2"):
        volume.remove(7)


def test_more_than_255_views_vote_exactly():
    volume = VoteVolume(GRID)
    volume.add_many([box_view(0)] * 300)
    assert volume.votes.max() == 300
    assert volume.votes.dtype == np.uint16


def plate_view(end_m):
    """The outline of a plate 2.82 m wide seen along z, from x = −3.4 m to `end_m`.

    Vertices at x = 2.4 m keep what changes at its end away from the rest.
    """
    x, y = np.array([-3.4, -3.4, 2.4, end_m, end_m, 2.4]), 1.41 * np.array([-1, 1, 1, 1, -1, -1])
    ring = 40 + 10 * np.column_stack([x, y])
    silhouette = Silhouette(rings=(ring,), image_shape=(80, 80), claim="complete")
    return View(silhouette=silhouette, projection=box_view(2).projection)


def test_an_edit_without_effect_is_remembered_when_it_gets_one():
    """View 2 ends earlier, but behind view 1's edge; then view 1 gives way and view 2 bounds."""
    volume = VoteVolume(GRID)
    numbers = volume.add_many([box_view(0), box_view(1), plate_view(3.4)])
    mesher = SurfaceMesher(volume)
    before = mesher.surface()
    volume.replace(numbers[2], plate_view(2.8))
    assert np.array_equal(mesher.surface().vertices_m, before.vertices_m)
    volume.replace(numbers[1], box_view(1, [3.6, 1.41, 0.77]))
    surface = mesher.surface()
    assert surface.vertices_m[:, 0].max() == pytest.approx(2.8, abs=1e-6)
    assert np.array_equal(surface.vertices_m, hull_surface(volume).vertices_m)
