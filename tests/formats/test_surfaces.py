import numpy as np
import pytest
import trimesh

from core.formats.surfaces import write_surface
from core.geometry.grid import VoxelGrid
from core.hull.surface import Surface, mask_surface


@pytest.mark.parametrize("suffix", [".glb", ".ply", ".stl"])
def test_another_reader_finds_the_same_size(tmp_path, suffix):
    grid = VoxelGrid.cube(side_m=4.0, spacing_m=0.5)
    inside = np.zeros(grid.shape, bool)
    inside[1:7, 2:5, 3:6] = True
    path = tmp_path / f"hull{suffix}"
    write_surface(path, mask_surface(inside, grid))
    mesh = trimesh.load(path, force="mesh")
    assert mesh.extents == pytest.approx([3.0, 1.5, 1.5])
    assert mesh.volume == pytest.approx(mask_surface(inside, grid).volume_m3(), rel=1e-5)


def test_bad_endings_and_empty_hulls_are_refused(tmp_path):
    empty = Surface(vertices_m=np.empty((0, 3)), faces=np.empty((0, 3)))
    with pytest.raises(ValueError, match=r"must end in \.glb, \.ply, \.stl; got"):
        write_surface(tmp_path / "hull.txt", empty)
    with pytest.raises(ValueError, match="no surface to write"):
        write_surface(tmp_path / "hull.glb", empty)
    assert list(tmp_path.iterdir()) == []
