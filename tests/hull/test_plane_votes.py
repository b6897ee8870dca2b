import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from core.hull.plane_votes import PlaneVoter, Window
from core.hull.volume import VoteVolume
from core.hull.votes import Voter
from tests.hull.test_votes import GRID, random_view
from tests.laws.cameras import camera_like


@st.composite
def windows(draw):
    ends = [
        sorted(draw(st.tuples(st.integers(0, side - 1), st.integers(0, side - 1))))
        for side in GRID.shape
    ]
    low = np.array([first for first, _ in ends])
    return Window(low=low, shape=tuple(int(last - first + 1) for first, last in ends))


@settings(max_examples=60, deadline=None)
@given(seed=st.integers(0, 2**31), window=windows(), perspective=st.booleans())
def test_a_window_has_the_volumes_votes(seed, window, perspective):
    views = [random_view(seed + number) for number in range(4)]
    if perspective:
        views = [camera_like(view, 25.0) for view in views]
    volume = VoteVolume(GRID)
    volume.add_many(views)
    found = PlaneVoter.of([Voter.of(view, GRID) for view in views]).votes(window)
    inside = tuple(
        slice(low, low + count) for low, count in zip(window.low, window.shape, strict=True)
    )
    assert found.dtype == np.uint8
    assert np.array_equal(found, volume.votes[inside])
