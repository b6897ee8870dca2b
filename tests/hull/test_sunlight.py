from dataclasses import replace

import numpy as np
import pytest
import shapely
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from core.experiments.true_outline import true_silhouette
from core.frame import Frame
from core.hull.shadow import carving_view
from core.hull.sunlight import carving_frame_view, frame_view, lit_disc_fraction, unfit_to_carve
from core.optical.camera import perpendicular_partner
from core.optical.materials import Material, facet_materials
from core.optical.rendering import Light, rendered
from core.silhouettes.contours import traced_rings
from core.silhouettes.silhouette import Silhouette
from core.targets import Target

SHAPE = (96, 96)
PIXEL_M = 0.2
DEPTH_M = 13.0


def dumb_bell():
    """Two balls and a rod with round ends: smooth, and shading itself."""
    ball = trimesh.creation.icosphere(subdivisions=3, radius=2.0)
    other = trimesh.creation.icosphere(subdivisions=3, radius=3.0)
    other.apply_translation([3.5, 2.0, 3.0])
    rod = trimesh.creation.capsule(height=7.0, radius=0.8, count=[24, 24])
    rod.apply_transform(trimesh.geometry.align_vectors([0, 0, 1], [1, -1, 0.5]))
    return Target(name="dumb-bell", parts=(ball, other, rod))


TARGET = dumb_bell()
MESH = TARGET.mesh()


def lit_frame(seed, phase_rad, range_m=None):
    """Return a frame at a phase angle and the exact outline of its sunlit pixels."""
    random = np.random.default_rng(seed)
    ahead, across, other = np.linalg.qr(random.normal(size=(3, 3)))[0].T
    sun = -ahead * np.cos(phase_rad) + other * np.sin(phase_rad)
    camera = perpendicular_partner(
        line_of_sight=ahead, cross_range=across, pixel_m=PIXEL_M, shape=SHAPE, range_m=range_m
    )
    grey = facet_materials(TARGET, [Material(name="grey", diffuse=1.0)] * len(TARGET.parts))
    image = rendered(
        MESH,
        grey,
        camera,
        Light(sun_direction=sun),
        line_of_sight=ahead,
        shape=SHAPE,
        supersampling=1,
    )
    frame = Frame(
        amplitude=image,
        projection=camera,
        time_s=0.0,
        sensor="optical",
        line_of_sight=ahead,
        sun_direction=sun,
        label="trial",
    )
    lit = (image > 0).astype(np.float32)
    silhouette = Silhouette(rings=traced_rings(lit, 0.5), image_shape=SHAPE, claim="lit side")
    return frame, silhouette


def polygon(silhouette):
    return shapely.union_all([shapely.Polygon(ring).buffer(0) for ring in silhouette.rings])


phases = st.floats(0.2, 2.0)
seeds = st.integers(0, 2**32 - 1)
ranges = st.sampled_from([None, 2e3])


@settings(max_examples=5)
@given(seed=seeds, phase=phases, range_m=ranges)
def test_the_sunlit_side_never_carves_a_smooth_target(seed, phase, range_m):
    """Law: every image of a target's point lies in the outline, filled away from the sun."""
    frame, silhouette = lit_frame(seed, phase, range_m)
    view = frame_view(frame, silhouette)
    carves = carving_frame_view(frame, silhouette, "shadow", depth_m=DEPTH_M)
    filled = polygon(carves.silhouette)
    assert polygon(carving_view(view, "shadow").silhouette).buffer(1e-6).covers(filled)
    truth = true_silhouette(MESH, view.projection, view.silhouette.image_shape)
    # Facets and pixels leave a rim of about a pixel to grazing light.
    lost = polygon(truth).buffer(-1.5).difference(filled)
    assert lost.area <= 0.002 * polygon(truth).area


@settings(max_examples=5)
@given(seed=seeds, phase=phases, range_m=ranges)
def test_rows_grow_away_from_the_sun(seed, phase, range_m):
    frame, silhouette = lit_frame(seed, phase, range_m)
    view = frame_view(frame, silhouette)
    points = np.random.default_rng(seed).uniform(-3, 3, (6, 3))
    before = view.projection.image_points(points)
    after = view.projection.image_points(points + 2.0 * frame.sun_direction)
    assert after[:, 1] == pytest.approx(before[:, 1], abs=1e-6)
    assert np.all(after[:, 0] < before[:, 0])


@settings(max_examples=3)
@given(seed=seeds, phase=phases, range_m=ranges)
def test_turning_moves_the_outline_with_the_target(seed, phase, range_m):
    """The turned outline is to the turned projection what the first was to the first."""
    frame, _ = lit_frame(seed, phase, range_m)
    truth = replace(true_silhouette(MESH, frame.projection, SHAPE), claim="lit side")
    view = frame_view(frame, truth)
    again = true_silhouette(MESH, view.projection, view.silhouette.image_shape)
    apart = polygon(view.silhouette).symmetric_difference(polygon(again)).area
    assert apart < 1e-3 * again.area_px()
    assert view.silhouette.area_px() > 0  # outer rings still run clockwise


def test_the_outline_as_it_stands_would_carve_the_target():
    frame, silhouette = lit_frame(3, 1.2)
    carves = carving_frame_view(frame, silhouette, "strict", depth_m=DEPTH_M)
    strict = polygon(carves.silhouette)
    assert strict.area < 0.8 * true_silhouette(MESH, frame.projection, SHAPE).area_px()


def test_only_a_sunlit_side_is_turned():
    frame, silhouette = lit_frame(1, 0.5)
    whole = replace(silhouette, claim="complete")
    for each, outline in ((frame, whole), (replace(frame, sun_direction=None), silhouette)):
        view = frame_view(each, outline)
        assert view.silhouette is outline
        assert view.projection is frame.projection
    behind = replace(frame, sun_direction=-frame.line_of_sight)
    assert frame_view(behind, silhouette).silhouette.claim == "complete"
    with pytest.raises(ValueError, match="straight into the sun"):
        frame_view(replace(frame, sun_direction=frame.line_of_sight), silhouette)


def test_the_sun_within_a_perspective_picture_is_refused():
    frame, silhouette = lit_frame(1, 0.5, range_m=15.0)
    across = frame.projection.matrix[1, :3] / np.linalg.norm(frame.projection.matrix[1, :3])
    sun = -frame.line_of_sight + 0.02 * across
    low = replace(frame, sun_direction=sun / np.linalg.norm(sun))
    with pytest.raises(ValueError, match="points into this perspective picture"):
        frame_view(low, silhouette)


def test_a_frame_against_the_sun_is_unfit():
    frame, silhouette = lit_frame(2, np.deg2rad(100))
    assert "100° from behind the observer, so that only 41 %" in unfit_to_carve(frame, silhouette)
    assert unfit_to_carve(frame, silhouette, np.pi) == ""
    assert unfit_to_carve(frame, replace(silhouette, claim="complete")) == ""
    assert unfit_to_carve(frame, replace(silhouette, rings=())) == "shows no target"
    gentle, outline = lit_frame(2, np.deg2rad(50))
    assert unfit_to_carve(gentle, outline) == ""


def test_a_spheres_disc_is_half_lit_at_quadrature():
    assert [lit_disc_fraction(phase) for phase in (0, np.pi / 2, np.pi)] == pytest.approx(
        [1, 0.5, 0]
    )


def test_the_nearer_the_sun_stands_behind_the_observer_the_less_is_left_open():
    areas = []
    for phase in (0.05, 0.3, 0.8):
        frame, silhouette = lit_frame(4, phase)
        carves = carving_frame_view(frame, silhouette, "shadow", depth_m=DEPTH_M)
        areas.append(carves.silhouette.area_px())
    truth = true_silhouette(MESH, frame.projection, SHAPE).area_px()
    assert areas == sorted(areas)
    assert areas[0] < 1.25 * truth
