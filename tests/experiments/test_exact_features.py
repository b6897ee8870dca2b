import numpy as np
import pytest

from core.experiments.exact_features import (
    accuracy,
    carved,
    exact_views,
    mro_features,
    run_exact_features,
    tiangong_features,
)
from core.hull.closed_mesh import Surface
from core.hull.surface import EMPTY_SURFACE
from core.targets import mro_like, tiangong_like


def true_surface(target):
    """Return the target's own surface, each body cut into faces of at most 0.5 m."""
    mesh = target.mesh().subdivide_to_size(0.5)
    return Surface(vertices_m=np.asarray(mesh.vertices), faces=np.asarray(mesh.faces))


@pytest.mark.parametrize(
    ("target", "features"),
    [(tiangong_like(), tiangong_features()), (mro_like(), mro_features())],
)
def test_on_the_true_surface_every_feature_reads_what_it_is(target, features):
    for figure in accuracy(target.name, features, true_surface(target)):
        # The laboratory is a prism of 96 sides, its mean radius 0.05 % below that of its corners.
        assert figure.value < 0.06, figure
        assert figure.met


def test_what_is_lost_misses_its_target():
    figures = accuracy("nothing", mro_features(), EMPTY_SURFACE)
    assert [(figure.value, figure.met) for figure in figures] == [(None, False)] * 6


def test_a_few_views_give_the_orbiters_lines_within_a_voxel():
    target = mro_like()
    surface = carved(target, exact_views(target, views=10, seed=2), spacing_m=0.3)
    errors = [f for f in accuracy("", mro_features(), surface) if f.unit == "%"]
    for figure, feature in zip(errors, mro_features(), strict=True):
        assert figure.value / 100 * feature.value < 0.3


@pytest.mark.slow
def test_every_target_is_met_at_full_size():
    results = run_exact_features()
    assert [(figure.name, figure.value) for figure in results.figures if not figure.met] == []
