import numpy as np
import pytest

from core.experiments.outline_noise import NoisyOutline, OutlineNoise, drawn_views
from core.geometry.projection import Projection
from core.hull.view import View
from core.silhouettes.areas import area_of
from core.silhouettes.silhouette import Silhouette

SQUARE = np.array([[20.0, 20.0], [20.0, 60.0], [60.0, 60.0], [60.0, 20.0]])
VIEW = View(
    silhouette=Silhouette(rings=(SQUARE,), image_shape=(80, 80), claim="complete"),
    projection=Projection(matrix=np.eye(2, 4)),
)


def only(**sizes):
    return OutlineNoise(**{"common_px": 0, "size_px": 0, "offset_px": 0, "ripple_px": 0, **sizes})


def drawn(noise, count, seed=1):
    outline, random = NoisyOutline.of(VIEW, noise), np.random.default_rng(seed)
    pairs = [drawn_views([outline, outline], noise, random) for _ in range(count)]
    return [[area_of(view.silhouette.rings) for view in pair] for pair in pairs]


def test_each_error_is_what_it_says():
    for noise, alike in ((only(common_px=0.5), True), (only(size_px=0.5), False)):
        widths = np.array([[a.bounds[2] - a.bounds[0] for a in pair] for pair in drawn(noise, 200)])
        assert widths.mean() == pytest.approx(40, abs=0.2)
        assert widths.std() == pytest.approx(1.0, rel=0.15)
        assert np.allclose(widths[:, 0], widths[:, 1]) == alike
    moved = drawn(only(offset_px=0.5), 200)
    centres = np.array([[a.centroid.x - 40, a.centroid.y - 40] for a, _ in moved])
    assert centres.std(axis=0) == pytest.approx([0.5, 0.5], rel=0.15)
    assert moved[0][0].area == pytest.approx(1600)


def test_ripple_has_its_size_and_its_correlation():
    noise = only(ripple_px=0.3, correlation_px=5.0)
    outline, random = NoisyOutline.of(VIEW, noise), np.random.default_rng(1)
    views = [drawn_views([outline], noise, random)[0] for _ in range(400)]
    moved = np.array([view.silhouette.rings[0] - outline.points for view in views])
    top = np.flatnonzero(outline.points[:, 0] == 20)[1:-1]
    across = moved[:, top, 0]
    assert across.std() == pytest.approx(0.3, rel=0.1)
    step = outline.points[top[1], 1] - outline.points[top[0], 1]
    wanted = np.exp(-0.5 * (2 * step / 5.0) ** 2)
    assert np.corrcoef(across[:, 4], across[:, 6])[0, 1] == pytest.approx(wanted, abs=0.1)
