from dataclasses import replace

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.ndimage import map_coordinates

from core.energy_accumulation.accumulation import (
    accumulated_energy,
    energy_body,
)
from core.frame import Frame
from core.geometry.grid import VoxelGrid
from core.geometry.projection import Projection
from core.measurement.comparison import voxel_agreement
from core.targets import Target
from tests.energy_accumulation.scenes import frames_of_points

GRID = VoxelGrid.cube(side_m=8.0, spacing_m=0.25)


def random_frame(random, *, along_axis):
    """A noisy image of odd shape through a random projection, or one that an axis vanishes in."""
    matrix = random.normal(size=(2, 4)) * [4, 4, 4, 10]
    if along_axis is not None:
        matrix[:, along_axis] = 0
    shape = tuple(random.integers(2, 40, 2).tolist())
    return Frame(
        amplitude=random.random(shape),
        projection=Projection(matrix=matrix),
        time_s=0.0,
        sensor="radar",
        line_of_sight=np.array([1.0, 0, 0]),
    )


def slow_map(frames, grid, power):
    """The definition, by SciPy's interpolation."""
    total = np.zeros(grid.shape)
    for frame in frames:
        amplitude = frame.amplitude.astype(np.float64)
        image = amplitude**power / np.sum(amplitude**2) ** (power / 2)
        places = np.moveaxis(frame.projection.image_points(grid.centres_m()), -1, 0)
        total += map_coordinates(image, places, order=1, mode="grid-constant", cval=0.0)
    return total


@settings(max_examples=40)
@given(
    seed=st.integers(0, 2**32 - 1),
    count=st.integers(1, 4),
    along_axis=st.sampled_from([None, 0, 1, 2]),
    measure=st.sampled_from(["amplitude", "energy"]),
)
def test_the_kernel_is_the_definition(seed, count, along_axis, measure):
    random = np.random.default_rng(seed)
    frames = [random_frame(random, along_axis=along_axis) for _ in range(count)]
    grid = VoxelGrid(origin_m=random.normal(size=3), spacing_m=0.3, shape=(5, 9, 14))
    expected = slow_map(frames, grid, 1 if measure == "amplitude" else 2)
    found = accumulated_energy(frames, grid, measure=measure)
    assert found == pytest.approx(expected, abs=3e-6)


@settings(max_examples=10)
@given(seed=st.integers(0, 2**32 - 1), gain=st.floats(1e-3, 1e3))
def test_frames_weigh_alike_whatever_their_gain(seed, gain):
    frames = [
        random_frame(np.random.default_rng(seed + number), along_axis=None) for number in (0, 1)
    ]
    louder = [replace(frames[0], amplitude=gain * frames[0].amplitude), frames[1]]
    expected = accumulated_energy(frames, GRID)
    assert accumulated_energy(louder[::-1], GRID) == pytest.approx(expected, abs=1e-5)


def test_the_brightest_voxel_is_where_the_point_is():
    point = np.array([1.125, -0.875, 0.375])
    frames = frames_of_points([point], views=12, random=np.random.default_rng(2))
    energy = accumulated_energy(frames, GRID)
    brightest = np.unravel_index(energy.argmax(), energy.shape)
    assert GRID.origin_m + 0.25 * np.array(brightest) == pytest.approx(point)


def test_the_body_of_a_ball_full_of_points():
    random = np.random.default_rng(3)
    points = random.normal(size=(300, 3))
    points *= 2.0 * random.random((300, 1)) ** (1 / 3) / np.linalg.norm(points, axis=1)[:, None]
    frames = frames_of_points(points, views=40, random=random)
    body = energy_body(accumulated_energy(frames, GRID), GRID)
    ball = Target(name="ball", parts=(trimesh.creation.icosphere(radius=2.0),))
    assert voxel_agreement(body.inside, ball.voxels(GRID)).intersection_over_union > 0.6
    assert body.extents_m() == pytest.approx([4, 4, 4], abs=0.8)
    assert len(body.points_m()) == np.count_nonzero(body.inside)
    assert np.ptp(body.surface().vertices_m, axis=0) == pytest.approx(body.extents_m(), abs=1e-9)


def test_a_threshold_above_everything_leaves_nothing():
    energy = np.arange(64, dtype=np.float32).reshape(4, 4, 4)
    grid = VoxelGrid.cube(side_m=4.0, spacing_m=1.0)
    body = energy_body(energy, grid, threshold=100.0)
    assert not body.inside.any()
    assert body.extents_m() == pytest.approx([0, 0, 0])
    assert body.surface().is_empty


def test_what_cannot_be_accumulated_is_refused():
    frame = frames_of_points([[0, 0, 0]], views=1, random=np.random.default_rng(1))[0]
    perspective = Projection(matrix=np.vstack([frame.projection.matrix, [0, 0, 0.1, 1]]))
    with pytest.raises(ValueError, match="at least one frame"):
        accumulated_energy([], GRID)
    with pytest.raises(ValueError, match="perspective"):
        accumulated_energy([replace(frame, projection=perspective)], GRID)
    with pytest.raises(ValueError, match="dark"):
        accumulated_energy([replace(frame, amplitude=0 * frame.amplitude)], GRID)
    with pytest.raises(ValueError, match="loudness"):
        accumulated_energy([frame], GRID, measure="loudness")
    huge = VoxelGrid(origin_m=np.zeros(3), spacing_m=0.1, shape=(2048, 2048, 2048))
    with pytest.raises(ValueError, match="larger spacing"):
        accumulated_energy([frame], huge)
    with pytest.raises(ValueError, match="one value"):
        energy_body(np.zeros(GRID.shape, np.float32), GRID)
    with pytest.raises(ValueError, match="not of a grid"):
        energy_body(np.zeros((2, 2, 2), np.float32), GRID)
