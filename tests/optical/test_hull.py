"""Telescope frames in the reconstruction: as views like any other."""

from dataclasses import replace

import numpy as np
import pytest

from core.experiments.true_outline import true_silhouette
from core.experiments.wide import simulated_frames
from core.geometry.grid import VoxelGrid
from core.hull.view import View
from core.hull.volume import VoteVolume
from core.measurement.comparison import voxel_agreement
from core.optical.camera import camera_axes, perpendicular_partner
from core.optical.materials import facet_materials, part_materials
from core.optical.rendering import Light
from core.optical.simulation import OpticalSettings, optical_frame
from core.optical.telescope import Telescope
from core.reconstruction import ReconstructionSettings, reconstruct
from core.targets import tiangong_like

TARGET = tiangong_like()
MESH = TARGET.mesh()
COATS = facet_materials(TARGET, part_materials(TARGET))
SMALL = OpticalSettings(shape=(200, 200), telescope=Telescope(aperture_m=1.2), supersampling=2)
RANGE_M = 400e3
COARSE = ReconstructionSettings(spacing_m=0.4)


def photograph(ahead, across, random, *, phase_deg=30.0, range_m=None):
    axes = camera_axes(ahead, across, roll_rad=random.uniform(0, 6))
    phase = np.deg2rad(phase_deg)
    camera = perpendicular_partner(
        line_of_sight=ahead,
        cross_range=across,
        pixel_m=RANGE_M * SMALL.pixel_rad(),
        shape=SMALL.shape,
        range_m=range_m,
    )
    return optical_frame(
        MESH,
        COATS,
        camera,
        Light(sun_direction=np.sin(phase) * axes[0] - np.cos(phase) * ahead),
        SMALL,
        line_of_sight=ahead,
        range_m=RANGE_M,
        time_s=0.0,
        random=random,
    )


def photographs(count, **options):
    random = np.random.default_rng(8)
    frames = []
    for _ in range(count):
        ahead, across = np.linalg.qr(random.normal(size=(3, 2)))[0].T
        frames.append(photograph(ahead, across, random, **options))
    return frames


@pytest.mark.parametrize("range_m", [None, RANGE_M])
def test_sunlit_frames_carve_nearly_what_true_outlines_do(range_m):
    frames = photographs(12, range_m=range_m)
    last = list(reconstruct(frames, COARSE))[-1]
    assert last.voting == 12
    grid = VoxelGrid.cube(side_m=21.0, spacing_m=0.4)
    truth = TARGET.voxels(grid)
    true = VoteVolume(grid)
    for frame in frames:
        outline = true_silhouette(MESH, frame.projection, frame.shape)
        true.add(View(silhouette=outline, projection=frame.projection))
    assert last.surface.volume_m3() < 1.6 * true.hull().sum() * 0.4**3
    strict = list(reconstruct(frames, replace(COARSE, rule="strict")))[-1]
    assert strict.surface.volume_m3() < 0.8 * np.count_nonzero(truth) * 0.4**3
    assert last.surface.volume_m3() > np.count_nonzero(truth) * 0.4**3
    assert voxel_agreement(true.hull(), truth).coverage > 0.99


def test_a_frame_against_the_sun_is_noted_and_does_not_vote():
    first, second = photographs(1) + photographs(1, phase_deg=120.0)
    steps = list(reconstruct([first, second], COARSE))
    assert [step.voting for step in steps] == [1, 1]
    assert steps[0].note == ""
    assert steps[1].note.startswith("frame 2 has the sun 120° from behind the observer")
    every = ReconstructionSettings(spacing_m=0.4, most_phase_rad=np.pi)
    assert [step.voting for step in reconstruct([first, second], every)] == [1, 2]


def test_a_photograph_bounds_what_its_radar_frame_leaves_open():
    """Across its plane a radar frame sees nothing: the partner's rows lie along just that."""
    (radar,) = simulated_frames(
        TARGET,
        views=1,
        scatterers=10_000,
        signal_to_noise_db=20.0,
        random=np.random.default_rng(5),
    )
    across = radar.projection.matrix[1, :3]
    partner = photograph(radar.line_of_sight, across, np.random.default_rng(3))
    alone, both = reconstruct([radar, partner], COARSE)
    normal = radar.projection.viewing_direction()
    assert abs(alone.unobserved @ normal) == pytest.approx(1)
    # What is left open lies behind the first return, where neither of the two looks.
    assert abs(both.unobserved @ normal) < 0.1
    assert abs(both.unobserved @ radar.line_of_sight) > 0.9
    extent_m = [np.ptp(step.surface.vertices_m @ normal) for step in (alone, both)]
    true_m = np.ptp(np.asarray(MESH.vertices) @ normal)
    assert extent_m[0] > 1.2 * true_m  # the grid's, not the target's
    assert both.surface.volume_m3() < 0.7 * alone.surface.volume_m3()
