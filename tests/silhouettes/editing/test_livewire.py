import numpy as np
import pytest
from scipy.ndimage import gaussian_filter

from core.silhouettes.editing.brush import combined
from core.silhouettes.editing.livewire import Livewire, livewire
from core.silhouettes.editing.snapping import snapped
from tests.silhouettes.editing.shapes import coverage, disc, frame_of, hausdorff_px

SHAPE = (100, 120)
DISC = disc(50.0, 60.0, 30.0, vertices=400)
CENTRE = np.array([50.0, 60.0])


@pytest.fixture(scope="module", params=["optical", "radar"])
def frame(request):
    """A disc, dull on its left, with a glint in it, before noise."""
    random = np.random.default_rng(4)
    level = gaussian_filter(coverage(DISC, SHAPE, finer=4), 0.8)
    level *= np.linspace(0.2, 1.0, SHAPE[1])
    level[50:53, 60:63] = 30.0
    level += np.abs(random.normal(0, 0.004, SHAPE))
    amplitude = np.sqrt(level) if request.param == "radar" else level
    return frame_of(amplitude, sensor=request.param)


def test_the_wire_follows_the_edge_between_two_anchors_across_the_disc(frame):
    path = livewire(frame, [(50, 30), (50, 90)])
    assert path[0].tolist() == [50, 30]
    assert path[-1].tolist() == [50, 90]
    assert np.abs(np.diff(path, axis=0)).max() == 1
    error_px = np.hypot(*(path - CENTRE).T) - 30
    assert np.abs(error_px).max() < 1.5
    assert abs(np.mean(error_px)) < 0.8


def test_a_closed_wire_snapped_is_the_outline(frame):
    path = livewire(frame, [(50, 30), (20, 60), (50, 90), (80, 60)], closed=True)
    assert len(np.unique(path, axis=0)) == len(path)
    rings = snapped(combined((), path, "add"), frame, 2.0, smoothing_px=0.5)
    assert hausdorff_px(rings, DISC) < 0.5


def test_a_wire_may_be_pulled_on_from_the_same_anchor(frame):
    wire = Livewire(frame)
    first = wire.path((50, 30), (20, 60))
    wire.path((50, 30), (50, 90))
    assert np.array_equal(wire.path((50, 30), (20, 60)), first)
    assert wire.path((50, 30), (50.2, 29.8)).tolist() == [[50, 30]]
    assert np.array_equal(Livewire(frame).path((50, 30), (20, 60)), first)


@pytest.mark.parametrize(
    ("anchors", "says"),
    [
        ([(5, 5)], "at least two anchors, got 1"),
        ([(5, 5), (100, 5)], r"\(100, 5\) lies outside the image of 100 × 120"),
        ([(5, -1), (10, 5)], "outside"),
        ([(5, np.nan), (10, 5)], "NaN"),
    ],
)
def test_anchors_that_are_none_are_refused(frame, anchors, says):
    with pytest.raises(ValueError, match=says):
        livewire(frame, anchors)


def test_an_even_frame_gives_a_path_all_the_same():
    path = livewire(frame_of(np.ones((20, 20))), [(3, 3), (12, 15)])
    assert path[-1].tolist() == [12, 15]
