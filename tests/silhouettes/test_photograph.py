import numpy as np
import pytest

from core.frame import Frame
from core.geometry.projection import Projection
from core.silhouettes.photograph import Photograph, photograph_silhouette, threshold_silhouette

CAMERA = Projection(matrix=np.array([[0.0, 100, 0, 40], [100, 0, 0, 60], [0, 0, 1, 1]]))


def _photograph(amplitude, sensor="optical"):
    frame = Frame(
        amplitude=amplitude,
        projection=CAMERA,
        time_s=0.0,
        sensor=sensor,
        line_of_sight=np.array([0.0, 0, 1]),
        label="trial",
    )
    colours = np.repeat(np.round(255 * np.asarray(amplitude))[..., None], 3, axis=2)
    return Photograph(frame=frame, colours=colours)


@pytest.fixture
def still_life():
    """A round block whose sides turn into shade, on a dim cloth, with a window through it."""
    random = np.random.default_rng(5)
    amplitude = np.full((120, 160), 0.01)
    amplitude[80:] = 0.07
    block = np.zeros(amplitude.shape, dtype=bool)
    block[30:90, 50:110] = True
    block[45:65, 85:100] = False
    shading = 0.12 + 0.5 * np.sin(np.linspace(0.0, np.pi, 60))
    amplitude[30:90, 50:110] = np.where(block[30:90, 50:110], shading, 0.01)
    amplitude *= random.uniform(0.8, 1.2, size=amplitude.shape)
    amplitude[5, 5] = 1.0  # a glint, not part of the object
    return _photograph(amplitude), block


def test_shade_belongs_to_the_object_and_the_cloth_does_not(still_life):
    photograph, block = still_life
    silhouette = photograph_silhouette(photograph)
    assert silhouette.claim == "complete"
    assert silhouette.area_px() == pytest.approx(np.count_nonzero(block), rel=0.01)
    points = np.concatenate(silhouette.rings)
    assert points.min(axis=0) == pytest.approx([29.5, 49.5], abs=0.6)
    assert points.max(axis=0) == pytest.approx([89.5, 109.5], abs=0.6)
    assert len(silhouette.rings) == 2  # the outline and the window
    otsu = threshold_silhouette(photograph.frame, 0.3)
    assert otsu.area_px() < 0.85 * silhouette.area_px()


def test_the_same_photograph_gives_the_same_outline(still_life):
    photograph, _ = still_life
    first, second = photograph_silhouette(photograph), photograph_silhouette(photograph)
    for a, b in zip(first.rings, second.rings, strict=True):
        np.testing.assert_array_equal(a, b)


def test_a_threshold_takes_whatever_is_brighter():
    amplitude = np.zeros((20, 20))
    amplitude[5:10, 5:15] = 1.0
    assert threshold_silhouette(_photograph(amplitude).frame, 0.5).area_px() == pytest.approx(
        50, rel=0.02
    )


@pytest.mark.parametrize(
    ("amplitude", "sensor", "says"),
    [
        (np.full((20, 20), 0.3), "optical", "same brightness, 0.3"),
        (np.eye(20), "radar", "comes from a radar"),
        (np.pad([[1.0]], 10), "optical", "single bright pixels"),
        (np.pad(np.ones((4, 4)), 10), "optical", "no object of at least 60 pixels"),
    ],
)
def test_a_photograph_without_an_object_is_refused(amplitude, sensor, says):
    with pytest.raises(ValueError, match=says):
        photograph_silhouette(_photograph(amplitude, sensor))
