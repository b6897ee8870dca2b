import pytest

from tests.browser.edit_session import run_session, satellite


@pytest.mark.slow
def test_a_session_of_real_edits_ends_with_the_hull_of_each_drawn(browser) -> None:
    figures = {
        figure.name: figure.value for figure in run_session(browser, satellite(32, 6), edits=2)
    }
    assert figures["32³×6: edits made"] == 2
    assert figures["32³×6: edits that changed the hull"] >= 1
    median = figures["32³×6: pointer up to hull drawn, median"]
    assert 0 < median <= figures["32³×6: pointer up to hull drawn, p95"]
    assert figures["32³×6: previews drawn while dragging"] > 0
