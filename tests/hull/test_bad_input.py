"""What a hull cannot be carved from is refused in one sentence, or repaired and said."""

import itertools

import numpy as np
import pytest

from core.geometry.projection import Projection, range_doppler_projection
from core.hull.outline import outline_of
from core.hull.polygon_test import votes_of
from core.hull.surface import hull_surface
from core.hull.view import View
from core.hull.volume import VoteVolume
from core.silhouettes.silhouette import Silhouette
from tests.hull.test_mesher import GRID, box_view, box_volume

SQUARE = np.array([[20.0, 20.0], [20.0, 60.0], [60.0, 60.0], [60.0, 20.0]])


def silhouette(ring):
    return Silhouette(rings=(np.asarray(ring, float),), image_shape=(80, 80), claim="complete")


def repaired(ring):
    """Return the note on a ring, and how many voxels then vote."""
    volume = VoteVolume(GRID)
    number = volume.add(View(silhouette=silhouette(ring), projection=box_view(0).projection))
    return volume.repair_note(number), int(volume.votes.sum())


def test_a_bow_tie_is_repaired_and_said_in_square_pixels():
    note, votes = repaired(SQUARE[[0, 2, 1, 3]])
    assert note == (
        "The outline crossed itself; it was split where it does, and what it encloses changed "
        "from 0.0 to 800.0 square pixels."
    )
    whole_note, whole = repaired(SQUARE)
    assert whole_note == ""
    assert votes == pytest.approx(whole / 2, rel=0.2)


def test_an_outline_that_runs_twice_is_repaired_and_said():
    note, votes = repaired(np.concatenate([SQUARE, SQUARE]))
    assert "crossed itself" in note
    assert votes == repaired(SQUARE)[1]


@pytest.mark.parametrize("count", [0, 1, 2])
def test_fewer_than_three_vertices_are_refused(count):
    with pytest.raises(ValueError, match=f"Ring 0 .* has {count} vertices; at least 3 needed"):
        silhouette(SQUARE[:count])


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_vertices_and_projections_that_are_no_numbers_are_refused(bad):
    ring = SQUARE.copy()
    ring[1, 1] = bad
    with pytest.raises(ValueError, match="Ring 0 of the silhouette: 1 of 8 values are NaN"):
        silhouette(ring)
    matrix = box_view(0).projection.matrix.copy()
    matrix[0, 0] = bad
    with pytest.raises(ValueError, match="Projection matrix: 1 of 8 values are NaN"):
        Projection(matrix=matrix)


@pytest.mark.parametrize("size_m", [0.0, -0.1, np.nan])
@pytest.mark.parametrize("name", ["row_spacing_m", "column_spacing_m"])
def test_pixels_without_size_are_refused(name, size_m):
    spacings = {"row_spacing_m": 0.1, "column_spacing_m": 0.1, name: size_m}
    word = name.split("_", maxsplit=1)[0].capitalize()
    with pytest.raises(ValueError, match=f"{word} spacing of an image must be positive metres"):
        range_doppler_projection(
            line_of_sight=np.array([0.0, 1.0, 0.0]),
            line_of_sight_rate_per_s=np.array([0.01, 0.0, 0.0]),
            shape=(80, 80),
            **spacings,
        )


@pytest.mark.parametrize("method", ["snapped", "dual"])
@pytest.mark.parametrize("threshold", [0, -1, 4, 300])
def test_thresholds_that_no_voxel_or_every_voxel_meets_are_refused(method, threshold):
    volume, _ = box_volume()
    with pytest.raises(ValueError, match=f"between 1 and the number of views, 3; got {threshold}"):
        hull_surface(volume, threshold, method=method)
    with pytest.raises(ValueError, match=f"got {threshold}"):
        volume.threshold = threshold


def test_an_edge_on_view_is_refused_in_one_sentence():
    with pytest.raises(ValueError, match="maps the target onto a line"):
        Projection(matrix=np.array([[1.0, 0, 0, 5], [2.0, 0, 0, 5]]))


def test_a_refused_view_leaves_the_volume_as_it_was():
    volume, _ = box_volume()
    before, revision = volume.votes.copy(), volume.revision
    flat = View(silhouette=silhouette(SQUARE[[0, 1, 0, 1]]), projection=box_view(0).projection)
    with pytest.raises(ValueError, match="encloses no area"):
        volume.add_many([box_view(0), flat])
    with pytest.raises(ValueError, match="encloses no area"):
        volume.replace(0, flat)
    assert np.array_equal(volume.votes, before)
    assert volume.revision == revision
    assert volume.view_count == 3


def test_a_part_within_a_hole_that_touches_its_ring_still_votes():
    hole = np.array([[0.0, 5.0], [8.0, 2.0], [8.0, 8.0]])  # touches the ring at (0, 5)
    ring = np.array([[0.0, 0.0], [0.0, 10.0], [10.0, 10.0], [10.0, 0.0]])
    island = np.array([[5.0, 4.0], [5.0, 6.0], [7.0, 5.0]])
    rings = (ring, hole, island)
    outline = outline_of(Silhouette(rings=rings, image_shape=(20, 20), claim="complete"))
    closed = [outline.points[a:b] for a, b in itertools.pairwise(outline.offsets)]
    inside = votes_of(np.array([[6.0, 5.0], [4.0, 5.0], [9.0, 5.0]]), tuple(closed))
    assert inside.tolist() == [True, False, True]
