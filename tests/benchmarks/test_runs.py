import itertools

import numpy as np
import pytest

from core.benchmarks.carve import run_carve
from core.benchmarks.edit import equality_figures, rival_is_installed, run_edit
from core.benchmarks.edits import drags, redrawn
from core.benchmarks.growth import run_growth
from core.benchmarks.measuring import fitted_exponent, peak_bytes
from core.benchmarks.peers import PEERS
from core.benchmarks.workload import satellite_task, satellite_views
from core.hull.outline import outline_of


def test_carve_races_every_installed_peer_and_finds_no_wrong_vote() -> None:
    results = run_carve(sizes=((24, 5),), repeats=1, budget_s=0.05)
    values = {figure.name: figure for figure in results.figures}
    wrong = [figure for name, figure in values.items() if "differ from the reference" in name]
    assert [figure.met for figure in wrong] == [True, True]
    for peer in PEERS:
        assert (peer.version is not None) == any(
            name.startswith(f"24³×5: {peer.name}") for name in values
        )


def test_a_slow_peer_is_measured_on_a_stated_part() -> None:
    results = run_carve(sizes=((32, 6),), repeats=1, budget_s=1e-4)
    names = [figure.name for figure in results.figures]
    assert any("shapely, scaled from 1/16 of the slices" in name for name in names)


def test_edits_are_exact_and_timed() -> None:
    results = run_edit(sizes=((24, 6),), repeats=3, equality_edits=4)
    values = {figure.name: figure for figure in results.figures}
    assert values["24³×6: drag, radarhull, p95"].unit == "ms"
    assert any("OpenCV" in name for name in values) == rival_is_installed()


def test_many_edits_leave_what_from_scratch_gives() -> None:
    assert [figure.value for figure in equality_figures(60, size=24, views=8)] == [0, 0]


def test_the_rival_sees_the_same_edits() -> None:
    pytest.importorskip("vtkmodules")
    from core.benchmarks.peers.opencv_fill import votes
    from core.benchmarks.rival import Rival

    task = satellite_task(32, 8)
    rival = Rival(task)
    views = list(task.views)
    script = itertools.chain(
        itertools.islice(drags(task.views, np.random.default_rng(3)), 12),
        itertools.islice(redrawn(task.views, np.random.default_rng(3)), 12),
    )
    for number, view in script:
        rival.replace(number, view)
        rival.surface()
        views[number] = view
    fresh = votes(type(task).of(views, task.grid), task.all_planes())
    np.testing.assert_array_equal(rival._votes, fresh)
    assert len(rival.surface().faces) > 100


def test_dragged_outlines_stay_valid() -> None:
    for _, view in itertools.islice(drags(satellite_views(3), np.random.default_rng(5)), 40):
        assert not outline_of(view.silhouette).repair


def test_growth_fits_powers(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("core.benchmarks.growth.MOST_STORED_VOXELS", 24**3)
    results, curves = run_growth(
        sizes=((16, 4), (24, 4), (32, 5)), repeats=1, view_counts=(2, 4), segments=(8, 16)
    )
    assert [curve.of for curve in curves] == ["voxels", "views", "vertices"]
    assert sum(figure.name.endswith("^") for figure in results.figures) == 15
    assert [point.size for point in curves[0].beyond] == ["32³×5"]
    values = {figure.name: figure.value for figure in results.figures}
    assert values["32³×5: the mesh itself"] > 1e-6
    assert fitted_exponent([1, 2, 4], [3, 12, 48]) == pytest.approx(2)


def test_memory_is_the_peak_of_the_run() -> None:
    # Again and again: what an earlier run freed must not hide a later one's need.
    for count in (2**26, 2**23, 2**23):
        found, _ = peak_bytes(lambda count=count: np.ones(count, dtype=np.uint8).sum())
        assert 0.9 * count <= found <= 1.5 * count
