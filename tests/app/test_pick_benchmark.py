from app.pick_benchmark import run_picks
from app.picking import SNAPS


def test_every_snap_is_timed_on_a_hull() -> None:
    results = run_picks(sizes=((24, 8),), picks=4)
    figures = {figure.name: figure for figure in results.figures}
    assert figures["24³×8: faces"].value > 500
    for snap in SNAPS:
        assert 0 < figures[f"24³×8: {snap}, median"].value <= figures[f"24³×8: {snap}, p95"].value
