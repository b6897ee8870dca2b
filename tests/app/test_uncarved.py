from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest

from app.snapshot import Snapshot
from app.uncarved import UncarvedWatch
from core.analysis.analysis import Analysis
from core.hull.uncarved import uncarved_surface
from tests.app.synthetic import SETTINGS, frames


@pytest.fixture
def analysis() -> Analysis:
    analysis = Analysis(SETTINGS)
    for frame in frames(4):
        analysis.receive(frame)
    return analysis


@pytest.fixture
def shown() -> list:
    return []


@pytest.fixture
def watch(analysis, shown) -> Iterator[UncarvedWatch]:
    watch = UncarvedWatch(lambda: analysis.volume, shown.append)
    yield watch
    watch.stop()
    assert not watch._thread.is_alive()


def snapshot(analysis: Analysis) -> Snapshot:
    return Snapshot(run=1, status="paused", speed_hz=None, settings=SETTINGS, hull=analysis.hull)


def test_it_follows_the_kept_hull_while_it_is_wanted(analysis, shown, watch, wait_for) -> None:
    watch.note(snapshot(analysis))
    watch.want(True)
    wait_for(lambda: len(shown) == 1)
    np.testing.assert_array_equal(shown[0].vertices_m, uncarved_surface(analysis.volume).vertices_m)
    assert not shown[0].is_empty
    analysis.set_state(1, "excluded")
    watch.note(snapshot(analysis))
    wait_for(lambda: len(shown) == 2)
    preview = replace(analysis.hull, revision=99, is_preview=True)
    watch.note(replace(snapshot(analysis), hull=preview))
    watch.want(False)
    analysis.set_state(1, "todo")
    watch.note(snapshot(analysis))
    watch.want(True)
    wait_for(lambda: len(shown) == 3)
    np.testing.assert_array_equal(shown[2].vertices_m, shown[0].vertices_m)


def test_a_failure_is_no_end(analysis, shown, wait_for, caplog) -> None:
    failing = [True]

    def volume():
        if failing[0]:
            raise RuntimeError("no memory")
        return analysis.volume

    watch = UncarvedWatch(volume, shown.append)
    watch.note(snapshot(analysis))
    watch.want(True)
    wait_for(lambda: "could not be computed" in caplog.text)
    failing[0] = False
    watch.want(False)
    watch.want(True)
    wait_for(lambda: len(shown) == 1)
    watch.stop()
