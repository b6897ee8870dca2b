from dataclasses import replace

import numpy as np
import pytest
import trimesh

from core.frame import Frame
from core.geometry.projection import Projection
from core.optical.camera import perpendicular_partner
from core.optical.materials import Material, facet_materials
from core.optical.rendering import Light
from core.optical.simulation import OpticalSettings, optical_frame
from core.optical.telescope import Telescope, blurred
from core.silhouettes.extraction import extract_silhouette
from core.silhouettes.telescope import TelescopeSettings, telescope_silhouette, without_wings
from core.targets import Target

RANGE_M = 500e3
AHEAD, RIGHT = np.array([0.0, 1, 0]), np.array([1.0, 0, 0])
SETTINGS = OpticalSettings(shape=(160, 160), telescope=Telescope(aperture_m=1.5))
PIXEL_M = SETTINGS.pixel_rad() * RANGE_M


def photographed(*parts, sun=-AHEAD, materials=None, settings=SETTINGS):
    target = Target(name="trial", parts=parts)
    grey = (Material(name="grey", diffuse=0.5),) * len(parts)
    camera = perpendicular_partner(
        line_of_sight=AHEAD, cross_range=RIGHT, pixel_m=PIXEL_M, shape=settings.shape
    )
    return optical_frame(
        target.mesh(),
        facet_materials(target, materials or grey),
        camera,
        Light(sun_direction=np.asarray(sun) / np.linalg.norm(sun)),
        settings,
        line_of_sight=AHEAD,
        range_m=RANGE_M,
        time_s=0.0,
        random=np.random.default_rng(4),
    )


def box(width_m, height_m, at=(0, 0, 0)):
    mesh = trimesh.creation.box(extents=(width_m, 1.0, height_m))
    mesh.apply_translation(at)
    return mesh


def test_the_outline_of_a_plate_is_where_its_edges_are():
    silhouette = telescope_silhouette(photographed(box(9.0, 6.0)))
    (ring,) = silhouette.rings
    centre = np.array(SETTINGS.shape) // 2
    half = np.array([3.0, 4.5]) / PIXEL_M
    assert ring.min(axis=0) == pytest.approx(centre - half, abs=0.25)
    assert ring.max(axis=0) == pytest.approx(centre + half, abs=0.25)
    assert silhouette.area_px() == pytest.approx(4 * half[0] * half[1], rel=0.01)


def test_a_dull_panel_beside_a_bright_body_is_target_and_the_wings_are_not():
    white, dark = Material(name="white", diffuse=0.8), Material(name="cells", diffuse=0.02)
    parts = box(5.0, 5.0), box(5.0, 2.0, (5.0, 0, 0))
    silhouette = telescope_silhouette(photographed(*parts, materials=(white, dark)))
    assert silhouette.area_px() * PIXEL_M**2 == pytest.approx(35.0, rel=0.03)


def test_what_the_sun_does_not_reach_is_not_in_the_outline():
    """A ball at quadrature: half of its disc is lit."""
    ball = trimesh.creation.icosphere(subdivisions=4, radius=5)
    silhouette = telescope_silhouette(photographed(ball, sun=RIGHT))
    assert silhouette.area_px() * PIXEL_M**2 == pytest.approx(np.pi * 25 / 2, rel=0.08)
    points = np.concatenate(silhouette.rings)
    assert points[:, 1].max() - 80 == pytest.approx(5 / PIXEL_M, abs=0.7)
    assert points[:, 1].min() > 80 - 2


def test_the_claim_is_complete_only_where_the_light_is_not_known():
    frame = photographed(box(5.0, 5.0))
    assert telescope_silhouette(frame).claim == "lit side"
    unknown = replace(frame, sun_direction=None)
    assert telescope_silhouette(unknown).claim == "complete"
    assert extract_silhouette(unknown).provenance == telescope_silhouette(unknown).provenance


def test_a_body_thinner_than_the_point_spread_is_still_seen():
    silhouette = telescope_silhouette(photographed(box(9.0, 0.1)))
    columns = np.concatenate(silhouette.rings)[:, 1]
    assert np.ptp(columns) * PIXEL_M == pytest.approx(9.0, abs=0.5)


def test_the_sky_alone_has_no_outline_and_an_even_frame_is_refused():
    frame = photographed(box(5.0, 5.0), sun=AHEAD)  # lit from behind
    assert telescope_silhouette(frame).is_empty
    flat = Frame(
        amplitude=np.full((20, 20), 0.2),
        projection=Projection(matrix=[[1.0, 0, 0, 0], [0, 1, 0, 0]]),
        time_s=0.0,
        sensor="optical",
        line_of_sight=[0, 0, 1],
        label="flat",
    )
    with pytest.raises(ValueError, match='"flat" has the same brightness'):
        telescope_silhouette(flat)


def test_wings_go_and_light_stays():
    telescope = Telescope(aperture_m=1.0, wavelength_m=1e-6)
    image = np.zeros((128, 128))
    image[64, 64] = 1.0
    seen = blurred(image, telescope, 0.5e-6)
    compact = without_wings(seen, 0.5)
    assert compact.sum() == pytest.approx(seen.sum(), rel=0.01)
    far = np.hypot(*(np.indices(image.shape) - 64)) > 10
    assert np.abs(compact[far]).max() < 0.35 * seen[far].max()
    assert abs(compact[far].sum()) < 0.1 * seen[far].sum()
    assert compact[64, 64] > 0.4 * seen[64, 64]


def test_keeping_the_wings_makes_no_difference_to_a_frame_of_unknown_resolution():
    frame = replace(photographed(box(9.0, 6.0)), row_resolution_m=None)
    kept = telescope_silhouette(frame, TelescopeSettings(removes_wings=False))
    for ours, theirs in zip(telescope_silhouette(frame).rings, kept.rings, strict=True):
        np.testing.assert_array_equal(ours, theirs)
