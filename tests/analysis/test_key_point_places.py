import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.analysis.key_point_marks import KeyPointBook
from core.analysis.key_point_places import expectations, placed_points
from core.measurement.key_points import located
from tests.measurement.test_key_points import CORNER_M, KINDS, around, marks

PARALLEL = around(5, 7)
SEEN = dict(enumerate(PARALLEL, start=1))


def book_of(seen, name="corner", sigma_px=1.0):
    book = KeyPointBook().with_sigma_px(sigma_px)
    for frame, place in seen.items():
        book = book.marked(name, frame, tuple(place))
    return book


def noisy(frames, sigma_px, seed):
    exact = marks([SEEN[frame] for frame in frames])
    moved = exact + np.random.default_rng(seed).normal(0.0, sigma_px, exact.shape)
    return dict(zip(frames, moved, strict=True))


@settings(max_examples=30)
@given(seed=st.integers(0, 10**6), kinds=KINDS)
def test_a_point_is_where_its_marks_say_and_is_expected_where_it_is_seen(seed, kinds):
    projections = dict(enumerate(around(5, seed, kinds), start=1))
    marked = dict(zip(projections, marks(projections.values()), strict=True))
    book = book_of({n: marked[n] for n in (1, 2, 3, 4)})
    (point,) = placed_points(book, projections)
    assert point.complaint == ""
    assert point.place.position_m == pytest.approx(CORNER_M, abs=1e-6)
    assert max(mark.residual_px for mark in point.marks) < 1e-4
    (expected,) = expectations((point,), 5, projections, reach_m=15.0)
    assert expected.place == pytest.approx(marked[5], abs=1e-4)
    assert expected.lines == ()


@given(seed=st.integers(0, 10**6), sigma_px=st.floats(0.05, 2.0))
def test_marks_err_as_judged_unless_they_show_more(seed, sigma_px):
    seen = noisy([1, 2, 3, 4, 5], 0.5, seed)
    (point,) = placed_points(book_of(seen, sigma_px=sigma_px), SEEN)
    own = located("corner", PARALLEL, np.array(list(seen.values())))
    assert point.place.sigma_px == pytest.approx(max(sigma_px, own.sigma_px))
    scale = (point.place.sigma_px / own.sigma_px) ** 2
    assert point.place.covariance_m2 == pytest.approx(scale * own.covariance_m2)
    assert point.standard_errors_m == pytest.approx(np.sqrt(np.diag(scale * own.covariance_m2)))


def test_a_mark_on_another_corner_is_suspicious_and_the_others_are_not():
    seen = noisy([1, 2, 3, 4, 5], 0.2, 3)
    seen[2] = seen[2] + [0.0, 12.0]
    (point,) = placed_points(book_of(seen), SEEN)
    worst = max(point.marks, key=lambda mark: mark.residual_px)
    assert (worst.frame, worst.is_suspicious) == (2, True)
    (right,) = placed_points(book_of(noisy([1, 2, 3, 4, 5], 0.2, 3)), SEEN)
    assert not any(mark.is_suspicious for mark in right.marks)


def test_what_frames_do_not_determine_has_a_sentence_and_no_place():
    book = book_of({2: marks([SEEN[2]])[0]})
    (point,) = placed_points(book, SEEN)
    assert (point.place, point.standard_errors_m) == (None, None)
    assert "marked in 1 frame(s)" in point.complaint
    assert point.marks[0].residual_px is None
    again = {**SEEN, 9: SEEN[2]}
    (point,) = placed_points(book.marked("corner", 9, tuple(marks([SEEN[2]])[0])), again)
    assert "nearly the same line" in point.complaint
    assert point.place is None


def test_a_mark_in_a_frame_that_has_not_come_takes_no_part():
    seen = noisy([1, 2, 3], 0.5, 4)
    (with_two,) = placed_points(book_of({n: seen[n] for n in (1, 2)}), SEEN)
    (waiting,) = placed_points(book_of(seen), {n: SEEN[n] for n in (1, 2)})
    assert waiting.place.position_m == pytest.approx(with_two.place.position_m)
    assert [mark.residual_px is None for mark in waiting.marks] == [False, False, True]


def test_a_point_of_one_mark_is_expected_on_a_line_in_every_other_frame():
    exact = marks(PARALLEL)
    points = placed_points(book_of({2: exact[1]}), SEEN)
    (expected,) = expectations(points, 4, SEEN, reach_m=15.0)
    ((start, end),) = expected.lines
    assert expected.place is None
    along = (end - start) / np.linalg.norm(end - start)
    off = exact[3] - start
    assert off[0] * along[1] - off[1] * along[0] == pytest.approx(0.0, abs=1e-9)
    assert 0 < off @ along < np.linalg.norm(end - start)
    assert expectations(points, 2, SEEN, reach_m=15.0)[0].lines == ()
