import numpy as np
import pytest

pytest.importorskip("manifold3d")

from core.benchmarks.distances import distances_m, sampled_points
from core.benchmarks.surface import run_surface
from core.benchmarks.truth import true_hull
from core.benchmarks.workload import ATTITUDE, PANEL_SPAN_M, satellite, satellite_views


def test_the_true_hull_holds_the_body_and_fits_its_panels() -> None:
    hull = true_hull(satellite_views(12))
    panels = ATTITUDE.apply([0.0, 1.0, 0.0])
    body = np.concatenate(satellite()) @ panels
    found = hull.vertices_m @ panels
    assert found.max() >= body.max() - 1e-6
    assert np.ptp(found) == pytest.approx(PANEL_SPAN_M, abs=0.2)
    assert distances_m(sampled_points(hull, 50), hull).max() < 1e-6


def test_the_exact_surfaces_are_nearer_than_the_binary_one() -> None:
    results = run_surface(sizes=((64, 10),), samples=200)
    figures = {figure.name: figure.value for figure in results.figures}
    for method in ("dual", "snapped"):
        assert figures[f"64³×10, {method}: times better than binary marching cubes"] > 1.2
    assert [row[1] for row in results.tables[0].rows] == ["binary", "dual", "snapped"]
