import numpy as np
import pytest
import shapely
import trimesh

from core.geometry.projection import Projection
from core.hull.reprojection import reprojected_mask, reprojected_rings
from core.hull.surface import Surface
from core.optical.camera import affine_camera, camera_axes, perspective_camera
from core.silhouettes.areas import area_of
from core.silhouettes.silhouette import Silhouette

SHAPE = (60, 80)
AXES = camera_axes(np.array([0.2, -0.5, 0.8]), np.array([1.0, 0.1, 0.0]))

CAMERAS = {
    "parallel": affine_camera(AXES, pixel_m=0.1, shape=SHAPE),
    "perspective": perspective_camera(AXES, range_m=12.0, pixel_m=0.1, shape=SHAPE),
}


def surface_of(mesh):
    return Surface(vertices_m=mesh.vertices, faces=mesh.faces)


def exact(surface: Surface, projection: Projection):
    """The union of all triangles, which is slow."""
    return shapely.union_all(
        shapely.polygons(projection.image_points(surface.vertices_m)[surface.faces])
    )


@pytest.mark.parametrize("camera", CAMERAS.values(), ids=CAMERAS)
@pytest.mark.parametrize("finer", [1, 3, 4])
def test_rings_are_the_union_of_the_projected_triangles(camera, finer):
    ring_body = trimesh.creation.torus(1.3, 0.4, major_sections=24, minor_sections=12)
    block = trimesh.creation.box((0.9, 0.6, 3.1))
    surface = surface_of(trimesh.util.concatenate([ring_body, block]))
    truth = exact(surface, camera)
    rings = reprojected_rings(surface, camera, SHAPE, finer=finer)
    area = area_of(rings)
    # Tips narrower than a fine pixel are lost, so that no distance between the lines would do.
    assert area.difference(truth.buffer(1 / finer)).area < 1e-9
    assert truth.buffer(-1 / finer).difference(area).area < 1e-9
    assert area.area == pytest.approx(truth.area, rel=0.01)


def test_the_rings_pixels_are_the_mask_but_for_the_edge():
    surface = surface_of(trimesh.creation.icosphere(subdivisions=3, radius=2.0))
    rings = reprojected_rings(surface, CAMERAS["parallel"], SHAPE)
    seen = Silhouette(rings=rings, image_shape=SHAPE, claim="complete").mask()
    mask = reprojected_mask(surface, CAMERAS["parallel"], SHAPE)
    assert np.count_nonzero(seen ^ mask) < 0.02 * np.count_nonzero(mask)


def test_a_hull_that_fills_the_image_ends_with_it():
    surface = surface_of(trimesh.creation.box((50.0, 50.0, 50.0)))
    (ring,) = reprojected_rings(surface, CAMERAS["parallel"], SHAPE)
    assert ring.min(axis=0) == pytest.approx([-0.5, -0.5], abs=0.1)
    assert ring.max(axis=0) == pytest.approx([59.5, 79.5], abs=0.1)


@pytest.mark.parametrize("finer", [0, 9])
def test_rasters_that_are_too_coarse_or_too_fine_are_refused(finer):
    surface = surface_of(trimesh.creation.box((1.0, 1.0, 1.0)))
    with pytest.raises(ValueError, match=f"1 to 8 times finer than the image, not {finer}"):
        reprojected_rings(surface, CAMERAS["parallel"], SHAPE, finer=finer)
