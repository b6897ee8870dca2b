from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.energy_accumulation import extraction
from core.energy_accumulation.accumulation import add_images, padded_image
from core.energy_accumulation.extraction import extract_scatterers
from core.geometry.grid import VoxelGrid
from tests.energy_accumulation.scenes import frames_of_points

GRID = VoxelGrid.cube(side_m=8.0, spacing_m=0.25)
SEEDS = st.integers(0, 2**32 - 1)


@settings(max_examples=5)
@given(seed=SEEDS)
def test_scattered_points_are_found_one_by_one(seed):
    random = np.random.default_rng(seed)
    lattice = np.stack(np.meshgrid(*[[-2.375, 0.125, 2.375]] * 3, indexing="ij"), -1).reshape(-1, 3)
    points = random.permutation(lattice)[:6]
    found = extract_scatterers(
        frames_of_points(points, views=24, random=random), GRID, most=6, measure="amplitude"
    )
    distance = np.linalg.norm(points[:, None] - found.position_m, axis=2)
    assert distance.min(axis=1) == pytest.approx(np.zeros(6), abs=0.45)
    assert found.voxels(GRID).sum() == 6


@settings(max_examples=6)
@given(seed=SEEDS)
def test_the_map_follows_what_is_taken_out(seed):
    random = np.random.default_rng(seed)
    frames = frames_of_points(random.normal(size=(9, 3)) * 2, views=3, random=random, size=24)
    images = [padded_image(frame, GRID) for frame in frames]
    energy = np.zeros(GRID.shape, dtype=np.float32)
    add_images(energy, images, [image.window for image in images])
    before = sum(image.values.sum(dtype=float) for image in images)
    held = 0.0
    for _ in range(4):
        places = [random.uniform(-3, 29, 2) for _ in images]
        held += extraction._take_out(energy, images, places, [(2.4, 1.0)] * 3)
    afresh = np.zeros(GRID.shape, dtype=np.float32)
    add_images(afresh, images, [image.window for image in images])
    assert energy == pytest.approx(afresh, abs=3e-6)
    after = sum(image.values.sum(dtype=float) for image in images)
    assert before - after == pytest.approx(held, abs=1e-5)


def test_energies_fall_and_the_search_ends_with_the_images():
    random = np.random.default_rng(6)
    frames = frames_of_points(random.normal(size=(8, 3)), views=10, random=random)
    told = []
    found = extract_scatterers(frames, GRID, progress=lambda *news: told.append(news))
    assert np.all(np.diff(found.energy) <= 1e-6)
    assert found.left_over <= 0.05
    assert told[-1] == ("scatterers", len(found), 1000)
    assert found.frames.max() == 10
    assert found.extents_m() == pytest.approx(np.ptp(found.position_m, axis=0))
    fewer = extract_scatterers(frames, GRID, least_share=0.5)
    assert len(fewer) < len(found)
    assert fewer.energy.min() >= 0.5 * fewer.energy[0]


def test_scatterers_that_few_frames_show_are_put_aside():
    random = np.random.default_rng(7)
    found = extract_scatterers(
        frames_of_points(random.normal(size=(8, 3)), views=10, random=random), GRID
    )
    often = found.seen_in(8)
    assert 0 < len(often) < len(found)
    assert often.frames.min() >= 8
    assert often.energy[0] == found.energy[np.argmax(found.frames >= 8)]


def test_unknown_resolution_is_refused():
    frame = frames_of_points([[0, 0, 0]], views=1, random=np.random.default_rng(1))[0]
    with pytest.raises(ValueError, match="row resolution"):
        extract_scatterers([replace(frame, row_resolution_m=None)], GRID)


@pytest.mark.parametrize("limits", [{"most": 0}, {"least_share": 2.0}, {"stop_left_over": -0.1}])
def test_impossible_limits_are_refused(limits):
    with pytest.raises(ValueError, match="at least 1 scatterer"):
        extract_scatterers([], GRID, **limits)
