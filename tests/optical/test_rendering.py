import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from core.hull.reprojection import reprojected_mask
from core.hull.surface import Surface
from core.optical.camera import affine_camera, camera_axes, perspective_camera
from core.optical.materials import Material, facet_materials
from core.optical.rendering import EARTH_ALBEDO, Light, earthshine, first_hits, rays, rendered
from core.optical.sun import EARTH_RADIUS_M
from core.targets import Target, tiangong_like

GREY = Material(name="grey", diffuse=0.5)
AHEAD, RIGHT = np.array([0.0, 1, 0]), np.array([1.0, 0, 0])
SHAPE = (128, 128)


def picture(target, light, *, line_of_sight=AHEAD, across=RIGHT, pixel_m=0.2, range_m=None):
    axes = camera_axes(line_of_sight, across)
    camera = (
        affine_camera(axes, pixel_m=pixel_m, shape=SHAPE)
        if range_m is None
        else perspective_camera(axes, range_m=range_m, pixel_m=pixel_m, shape=SHAPE)
    )
    materials = facet_materials(target, [GREY] * len(target.parts))
    image = rendered(
        target.mesh(), materials, camera, light, line_of_sight=line_of_sight, shape=SHAPE
    )
    return image.reshape(SHAPE[0], 3, SHAPE[1], 3).mean(axis=(1, 3)), camera


@pytest.mark.parametrize("phase_deg", [0, 30, 60, 90, 120, 150])
def test_a_lambertian_sphere_follows_its_phase_law(phase_deg):
    """Lambert, 1760; Russell, 1916: Φ = (sin α + (π − α) cos α) / π."""
    sphere = Target(name="ball", parts=(trimesh.creation.icosphere(subdivisions=5, radius=10),))
    phase = np.deg2rad(phase_deg)
    sun = np.array([np.sin(phase), -np.cos(phase), 0])
    image, _ = picture(sphere, Light(sun_direction=sun))
    law = (np.sin(phase) + (np.pi - phase) * np.cos(phase)) / np.pi
    flux_m2 = image.sum() * 0.2**2
    assert flux_m2 / (2 / 3 * np.pi * 10**2 * 0.5) == pytest.approx(law, abs=0.003)
    lit = image.sum(axis=0)
    assert lit[64:].sum() >= 0.49 * lit.sum()  # columns grow toward the sun


def test_a_body_shades_what_lies_behind_it_from_the_sun():
    """A block above a plate, the sun 45° over it to the right: a shadow as wide as the block."""
    plate = trimesh.creation.box(extents=(20, 1, 20))
    block = trimesh.creation.box(extents=(4, 1, 4))
    block.apply_translation([0, -5, 0])
    scene = Target(name="scene", parts=(plate, block))
    image, camera = picture(scene, Light(sun_direction=np.array([1.0, -1, 0]) / np.sqrt(2)))
    along = np.arange(-9, 9, 0.2)

    def brightness(z):
        points = np.column_stack([along, np.zeros_like(along), np.full_like(along, z)])
        row, column = np.round(camera.image_points(points)).astype(int).T
        return image[row, column]

    assert brightness(5.0) == pytest.approx(0.5 / np.sqrt(2), rel=1e-6)
    dark = along[brightness(0.0) < 0.01]
    # The block's faces stand 4 to 5 m before the plate's, so that the shadow lies 4 to 5 m left
    # of the block's left edge at −2 m; the block itself hides what lies right of −2 m.
    assert dark.min() == pytest.approx(-7.0, abs=0.3)
    assert dark.max() == pytest.approx(-2.0, abs=0.3)


@settings(max_examples=5)
@given(seed=st.integers(0, 2**32 - 1), is_far=st.booleans())
def test_rays_meet_what_projects_to_their_pixel(seed, is_far):
    """Every hit projects back to its pixel, and hits cover what the mesh's image covers."""
    random = np.random.default_rng(seed)
    ahead, across = np.linalg.qr(random.normal(size=(3, 2)))[0].T
    target = tiangong_like()
    mesh = target.mesh()
    axes = camera_axes(ahead, across)
    camera = (
        perspective_camera(axes, range_m=450e3, pixel_m=0.2, shape=SHAPE)
        if is_far
        else affine_camera(axes, pixel_m=0.2, shape=SHAPE)
    )
    pixels = np.stack(np.meshgrid(*map(np.arange, SHAPE), indexing="ij"), -1).reshape(-1, 2)
    origins, directions = rays(camera, pixels, ahead, reach_m=20.0)
    facet, points = first_hits(mesh, origins, directions)
    hit = facet >= 0
    assert camera.image_points(points[hit]) == pytest.approx(pixels[hit], abs=1e-3)
    surface = Surface(
        vertices_m=np.asarray(mesh.vertices), faces=np.asarray(mesh.faces, dtype=np.int32)
    )
    covered = reprojected_mask(surface, camera, SHAPE).ravel()
    assert np.count_nonzero(covered != hit) <= 3
    # Nothing of the mesh lies nearer along the ray.
    slow = trimesh.ray.ray_triangle.RayMeshIntersector(mesh)
    some = np.flatnonzero(hit)[:: max(1, hit.sum() // 20)]
    where, index, _ = slow.intersects_location(origins[some], directions[some], multiple_hits=True)
    depth = np.full(len(some), np.inf)
    np.minimum.at(depth, index, np.sum((where - origins[some][index]) * directions[some][index], 1))
    ours = np.sum((points[some] - origins[some]) * directions[some], axis=1)
    assert np.abs(depth - ours).max() < 1e-3


def test_a_far_camera_sees_what_a_parallel_one_does():
    light = Light(sun_direction=np.array([0.6, -0.8, 0]))
    ahead = np.array([0.48, 0.6, -0.64])
    parallel, _ = picture(tiangong_like(), light, line_of_sight=ahead)
    far, _ = picture(tiangong_like(), light, line_of_sight=ahead, range_m=450e3)
    assert np.abs(parallel - far).max() < 0.1
    assert far.sum() == pytest.approx(parallel.sum(), rel=1e-3)


def test_in_the_umbra_it_is_dark_and_penumbra_dims():
    sun = np.array([0.6, -0.8, 0])
    full, half, none = (
        picture(tiangong_like(), Light(sun_direction=sun, sun=share))[0] for share in (1.0, 0.5, 0)
    )
    assert np.all(none == 0)
    assert half == pytest.approx(0.5 * full)


def test_a_target_outside_the_picture_leaves_it_dark():
    ball = trimesh.creation.icosphere(radius=1)
    ball.apply_translation([100, 0, 0])
    image, _ = picture(Target(name="ball", parts=(ball,)), Light(sun_direction=-AHEAD))
    assert np.all(image == 0)


def test_earthshine_of_the_full_earth_is_albedo_times_view_factor():
    """With the sun overhead and close to the ground, the ground is a plane lit squarely.

    From height h it fills (R/r)² of what a horizontal plate sees; only near the horizon does the
    sun stand lower, which takes a few per cent.
    """
    distance = EARTH_RADIUS_M + 50e3
    light = Light(sun_direction=np.array([0, 0, -1.0]), earth_distance_m=distance)
    down, up, side = earthshine(np.array([[0.0, 0, 1], [0, 0, -1], [1, 0, 0]]), light)
    assert down == pytest.approx(EARTH_ALBEDO * (EARTH_RADIUS_M / distance) ** 2, rel=0.02)
    assert up == 0
    assert side == pytest.approx(down / 2, rel=0.2)
    night = Light(sun_direction=np.array([0, 0, 1.0]), earth_distance_m=distance)
    assert np.all(earthshine(np.eye(3), night) == 0)
    alone = Light(sun_direction=np.array([0, 0, -1.0]))
    assert np.all(earthshine(np.eye(3), alone) == 0)
