import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.hull.blame import gained_without_m3, removed_alone_m3
from core.hull.casting import Cancelled, Watch
from core.hull.volume import VoteVolume
from tests.hull.test_mesher import box_view, box_volume
from tests.laws.outlines import LATTICE, lattice_views


@settings(max_examples=20, deadline=None)
@given(views=st.lists(lattice_views(), min_size=2, max_size=5), misses=st.integers(0, 2))
def test_what_a_hull_gains_is_the_hull_carved_without_the_view_less_the_hull(views, misses):
    volume = VoteVolume(LATTICE)
    numbers = volume.add_many(views)
    volume.threshold = max(1, len(views) - misses)
    gained = gained_without_m3(volume)
    assert list(gained) == numbers
    for number in numbers:
        others = VoteVolume(LATTICE)
        others.add_many([view for n, view in zip(numbers, views, strict=True) if n != number])
        grown = others.hull(max(1, volume.threshold - 1)) & ~volume.hull()
        assert gained[number] == (np.count_nonzero(grown) if volume.threshold > 1 else 0)
    if misses == 0:
        assert gained == pytest.approx(removed_alone_m3(volume))


def test_an_excluded_view_gains_nothing_for_the_hull():
    volume, numbers = box_volume()
    volume.exclude(numbers[1])
    assert numbers[1] not in gained_without_m3(volume)
    assert gained_without_m3(VoteVolume(LATTICE)) == {}


def test_a_count_is_cancelled_from_outside_and_by_a_change():
    volume, numbers = box_volume()
    with pytest.raises(Cancelled, match="after 0 of 3 views"):
        gained_without_m3(volume, Watch(cancel=lambda: True))
    asked = iter([False, False, True])
    told = []
    watch = Watch(progress=lambda *parts: told.append(parts), cancel=lambda: next(asked, True))
    with pytest.raises(Cancelled):
        gained_without_m3(volume, watch)
    expected = removed_alone_m3(volume)
    assert gained_without_m3(volume) == pytest.approx(expected)
    volume.replace(numbers[0], box_view(0, [2.0, 1.0, 0.5]))
    assert gained_without_m3(volume)[numbers[0]] > expected[numbers[0]]
