import numpy as np

from core.experiments.threshold.repair import exclude_causers
from core.geometry.grid import VoxelGrid
from core.geometry.projection import Projection
from core.hull.view import View
from core.hull.votes import VoteCounts
from core.silhouettes.silhouette import Silhouette

GRID = VoxelGrid.cube(side_m=4.0, spacing_m=0.2)


def square(turn_rad, half_px):
    """Return a view from the side whose square is `half_px` decimetres from its middle."""
    ring = 20 + half_px * np.array([[-1.0, -1], [-1, 1], [1, 1], [1, -1]])
    row, column = np.array([np.cos(turn_rad), np.sin(turn_rad), 0]), np.array([0, 0, 1.0])
    matrix = np.column_stack([10 * np.array([row, column]), [20.0, 20.0]])
    outline = Silhouette(rings=(ring,), image_shape=(40, 40), claim="complete")
    return View(silhouette=outline, projection=Projection(matrix=matrix))


def volume_of(small):
    volume = VoteCounts(GRID)
    turns = np.linspace(0, np.pi, 24, endpoint=False)
    volume.add_many(square(turn, 5 if n in small else 10) for n, turn in enumerate(turns))
    return volume


def test_nobody_is_accused_where_all_agree():
    assert exclude_causers(volume_of(())) == []


def test_views_that_alone_cut_are_excluded_and_the_hull_comes_back():
    volume, right = volume_of((3,)), volume_of(())
    cut = np.count_nonzero(volume.hull())
    assert exclude_causers(volume) == [3]
    assert volume.view_count == 23
    assert np.count_nonzero(volume.hull()) >= np.count_nonzero(right.hull()) > 1.5 * cut


def test_two_that_cut_the_same_are_found_one_after_the_other():
    assert set(exclude_causers(volume_of((3, 15)))) == {3, 15}
