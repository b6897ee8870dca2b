import numpy as np
import pytest
import trimesh

from core.radar.facets import shaded_surface
from core.targets import Target, tiangong_like


def area_m2(corners):
    sides = corners[:, 1:] - corners[:, :1]
    return np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1) / 2


def plates():
    """A small plate 2 m before (towards −x) a large one."""
    front = trimesh.creation.box((0.1, 1.0, 1.0))
    front.apply_translation([-2.0, 0, 0])
    return Target(name="plates", parts=(front, trimesh.creation.box((0.1, 4.0, 4.0))))


def test_pieces_are_short_and_lose_no_area():
    target = tiangong_like()
    surface = shaded_surface(target, longest_edge_m=0.5)
    corners = surface.piece_corners_m
    edges = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
    assert edges.max() <= 0.5
    pieces = np.bincount(surface.face, area_m2(corners), len(surface.mesh.faces))
    assert pieces == pytest.approx(surface.mesh.area_faces, rel=1e-9)
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (np.sum(normal * surface.mesh.face_normals[surface.face], axis=1) > 0).all()


def test_what_is_lit_is_what_no_plate_stands_before():
    surface = shaded_surface(plates(), longest_edge_m=0.2)
    lit = surface.lit_facets(np.array([1.0, 0.0, 0.0]))
    assert (lit.normal[:, 0] < -0.999).all()
    # The small plate whole, the large one less what lies behind it.
    assert (lit.share * area_m2(lit.corners_m)).sum() == pytest.approx(16, rel=0.01)
    partly = lit.corners_m[(lit.share < 1)]
    assert (np.abs(np.abs(partly[..., 1:]).max(axis=(1, 2)) - 0.5) < 0.2).all()


def test_a_triangle_lit_all_over_comes_whole():
    surface = shaded_surface(plates(), longest_edge_m=0.2)
    lit = surface.lit_facets(np.array([-1.0, 0.0, 0.0]))
    # From behind only the large plate shows: two triangles.
    assert len(lit) == 2
    assert lit.share.tolist() == [1, 1]


@pytest.mark.parametrize(
    ("edge_m", "wanted"), [(0.0, "positive metres"), (np.nan, "positive"), (1e-3, "allow longer")]
)
def test_edges_that_cannot_be_are_refused(edge_m, wanted):
    with pytest.raises(ValueError, match=wanted):
        shaded_surface(plates(), longest_edge_m=edge_m)


def test_an_empty_mesh_is_refused():
    with pytest.raises(ValueError, match="no surface"):
        shaded_surface(Target(name="nothing", parts=(trimesh.Trimesh(),)), longest_edge_m=1.0)
