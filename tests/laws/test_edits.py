"""After any edits the votes and the surface are what they would be from scratch, exactly."""

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from core.geometry.grid import VoxelGrid
from core.hull.mesher import SurfaceMesher
from core.hull.view import View
from core.hull.volume import VoteVolume
from core.silhouettes.silhouette import Silhouette
from tests.hull.test_votes import random_view

GRID = VoxelGrid.cube(side_m=9.0, spacing_m=0.3)

ACTIONS = ["add", "remove", "drag", "redraw", "exclude", "include", "threshold"]


def dragged(view, random):
    """Move one vertex of the outline by a few pixels."""
    outer, *holes = view.silhouette.rings
    moved = outer.copy()
    moved[random.integers(len(moved))] += random.normal(size=2) * 3
    silhouette = Silhouette(rings=(moved, *holes), image_shape=(512, 512), claim="complete")
    return View(silhouette=silhouette, projection=view.projection)


def edit(volume, action, random):
    numbers = list(volume.voters)
    number = numbers[random.integers(len(numbers))]
    view = volume.voters[number].view
    if action == "add":
        volume.add(random_view(random.integers(2**31)))
    elif action == "remove" and volume.view_count > 2:
        volume.remove(number)
    elif action == "drag":
        volume.replace(number, dragged(view, random))
    elif action == "redraw":
        volume.replace(number, random_view(random.integers(2**31)))
    elif action == "exclude" and volume.view_count > 2:
        volume.exclude(number)
    elif action == "include":
        volume.include(number)
    elif action == "threshold":
        volume.threshold = int(random.integers(1, volume.view_count + 1))


def from_scratch(volume):
    fresh = VoteVolume(volume.grid)
    fresh.add_many([voter.view for voter in volume.voters.values() if voter.votes])
    fresh.threshold = volume.threshold
    return fresh


@settings(max_examples=12, deadline=None)
@given(seed=st.integers(0, 2**31), actions=st.lists(st.sampled_from(ACTIONS), max_size=12))
def test_incremental_equals_from_scratch(seed, actions):
    random = np.random.default_rng(seed)
    volume = VoteVolume(GRID)
    volume.add_many([random_view(seed + i) for i in range(5)])
    mesher = SurfaceMesher(volume)
    for action in [*actions, "drag", "drag"]:
        edit(volume, action, random)
        if volume.threshold is not None and volume.threshold > volume.view_count:
            volume.threshold = None
        surface = mesher.surface()
        fresh = from_scratch(volume)
        again = SurfaceMesher(fresh).surface()
        assert np.array_equal(volume.votes, fresh.votes)
        assert np.array_equal(surface.vertices_m, again.vertices_m)
        assert np.array_equal(surface.faces, again.faces)


@settings(max_examples=15, deadline=None)
@given(seed=st.integers(0, 2**31), below=st.integers(0, 3))
def test_surfaces_are_closed_and_turned_outward(seed, below):
    volume = VoteVolume(GRID)
    volume.add_many([random_view(seed + i) for i in range(5)])
    volume.threshold = 5 - below
    surface = SurfaceMesher(volume).surface()
    if surface.is_empty:
        return
    mesh = trimesh.Trimesh(surface.vertices_m, surface.faces, process=False)
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    voxels_m3 = volume.hull().sum() * GRID.spacing_m**3
    assert surface.volume_m3() == pytest.approx(voxels_m3, rel=0.3, abs=0.5)
