import sys

import numpy as np
import pytest
import trimesh

from core.formats.meshes import read_mesh


def _box_file(folder, suffix):
    path = folder / f"box{suffix}"
    trimesh.creation.box(extents=(1.0, 2.0, 3.0)).export(path)
    return path


@pytest.mark.parametrize("suffix", [".glb", ".ply", ".obj", ".stl"])
def test_every_format_comes_in_metres(tmp_path, suffix):
    mesh = read_mesh(_box_file(tmp_path, suffix), unit_m=0.5)
    assert mesh.extents == pytest.approx([0.5, 1.0, 1.5])
    assert mesh.is_watertight
    assert mesh.volume == pytest.approx(0.75)


def test_a_scenes_parts_stand_in_their_places(tmp_path):
    scene = trimesh.Scene()
    for x in (-5.0, 5.0):
        transform = trimesh.transformations.translation_matrix([x, 0, 0])
        scene.add_geometry(trimesh.creation.box(), transform=transform)
    scene.export(tmp_path / "two.glb")
    assert read_mesh(tmp_path / "two.glb").extents == pytest.approx([11, 1, 1])


@pytest.mark.parametrize(
    ("name", "text", "says"),
    [
        ("a.obj", "", "0 vertices and 0 faces"),
        ("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", "triangles"),
        ("a.stl", "solid", r"a\.stl"),
        ("a.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n", "All 3 vertices .* on one point"),
        ("a.glb", "glTF but no more", "no GLB file that trimesh can read"),
        ("a.step", "", 'ends in .glb, .ply, .obj, .stl; got "a.step"'),
    ],
)
def test_a_file_without_a_mesh_says_what_was_wanted(tmp_path, name, text, says):
    (tmp_path / name).write_text(text)
    with pytest.raises(ValueError, match=says):
        read_mesh(tmp_path / name)


def test_vertices_that_are_not_numbers_are_refused(tmp_path):
    path = tmp_path / "a.obj"
    path.write_text("v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    with pytest.raises(ValueError, match=r"Vertices of a\.obj: 1 of 9 values are NaN"):
        read_mesh(path)


def test_faces_without_their_vertices_are_refused(tmp_path):
    path = tmp_path / "a.ply"
    path.write_text(
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n"
    )
    with pytest.raises(ValueError, match=r"a\.ply"):
        read_mesh(path)


@pytest.mark.parametrize("unit", [0.0, -1.0, float("nan"), float("inf")])
def test_a_unit_that_is_no_length_is_refused(tmp_path, unit):
    with pytest.raises(ValueError, match="positive length in metres"):
        read_mesh(_box_file(tmp_path, ".stl"), unit_m=unit)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(ValueError, match="There is no mesh file"):
        read_mesh(tmp_path / "absent.glb")


@pytest.mark.parametrize(
    ("name", "unit_m", "extents_m"),
    [
        ("aura", 0.34, (3.054, 6.455, 17.280)),
        ("sentinel6", 1.0, (5.133, 2.324, 4.371)),
        ("grace", 1.0, (1.894, 3.289, 1.295)),
    ],
)
def test_nasas_draco_meshes_come_in_metres(shared_data, name, unit_m, extents_m):
    mesh = read_mesh(shared_data("models") / f"{name}.glb", unit_m=unit_m)
    assert mesh.extents == pytest.approx(extents_m, abs=2e-3)
    assert np.isfinite(mesh.area)


def test_draco_without_its_decoder_is_an_error_that_names_it(shared_data, monkeypatch):
    monkeypatch.setitem(sys.modules, "DracoPy", None)
    with pytest.raises(ValueError, match="pip install DracoPy"):
        read_mesh(shared_data("models") / "grace.glb")


@pytest.mark.parametrize("vertices", [np.empty((0, 3)), np.zeros((9, 3))])
def test_an_own_draco_file_without_the_decoder_is_the_same_error(tmp_path, monkeypatch, vertices):
    """Older versions of trimesh give no vertices then, newer ones placeholders."""
    undecoded = trimesh.Trimesh(vertices, process=False)
    monkeypatch.setattr(trimesh, "load", lambda *_, **__: undecoded)
    path = tmp_path / "a.glb"
    path.write_bytes(b'{"extensionsRequired": ["KHR_draco_mesh_compression"]}')
    with pytest.raises(ValueError, match=r"1 of 1 meshes .*pip install DracoPy"):
        read_mesh(path)
