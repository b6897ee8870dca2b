from contextlib import suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.analysis.history import NothingLeft
from core.analysis.key_point_marks import MOST_POINTS, MOST_STEPS, KeyPointBook, checked_name

names = st.sampled_from(["tip", "root", "hinge"])
numbers = st.integers(1, 4)
places = st.tuples(st.floats(-10, 200), st.floats(-10, 200))
changes = st.lists(
    st.one_of(
        st.tuples(st.just("marked"), names, numbers, places),
        st.tuples(st.just("without_mark"), names, numbers),
        st.tuples(st.just("without"), names),
        st.tuples(st.just("renamed"), names, names),
    ),
    max_size=12,
)


def made(steps, book=None):
    """Return the books, each after one more of the changes that are possible and change it."""
    books = [book or KeyPointBook()]
    for method, *arguments in steps:
        with suppress(ValueError):
            after = getattr(books[-1], method)(*arguments)
            books += [] if after is books[-1] else [after]
    return books


@given(steps=changes)
def test_the_marks_are_those_of_a_plain_dictionary(steps):
    plain = {}
    for method, name, *rest in steps:
        if method == "marked":
            plain.setdefault(name, {})[rest[0]] = rest[1]
        elif method == "renamed" and name in plain and rest[0] not in plain:
            plain = {(rest[0] if key == name else key): value for key, value in plain.items()}
        elif method == "without":
            plain.pop(name, None)
        elif method == "without_mark":
            plain.get(name, {}).pop(rest[0], None)
            plain = {key: value for key, value in plain.items() if value}
    last = made(steps)[-1]
    assert {name: dict(marks) for name, marks in last.marks.items()} == plain
    assert list(last.marks) == list(plain)
    assert all(list(marks) == sorted(marks) for marks in last.marks.values())


@given(steps=changes)
def test_undo_takes_every_change_back_and_redo_makes_it_again(steps):
    changed = made(steps)
    back, seen = changed[-1], []
    while back.can_undo:
        back = back.undone()
        seen.append(back.marks)
    assert seen == [book.marks for book in changed[-2::-1]]
    with pytest.raises(NothingLeft, match="take back"):
        back.undone()
    while back.can_redo:
        back = back.redone()
    assert back.marks == changed[-1].marks
    with pytest.raises(NothingLeft, match="make again"):
        back.redone()


@given(steps=changes, more=changes)
def test_every_change_has_a_revision_of_its_own_and_older_books_stay(steps, more):
    books = made(steps)
    before = {name: dict(marks) for name, marks in books[-1].marks.items()}
    first = books[-1].revision
    assert [book.revision - first for book in made(more, books[-1])] == list(
        range(len(made(more, books[-1])))
    )
    assert {name: dict(marks) for name, marks in books[-1].marks.items()} == before


def test_a_change_after_undo_forgets_what_was_taken_back():
    book = KeyPointBook().marked("tip", 1, (2.0, 3.0)).marked("tip", 2, (4.0, 5.0)).undone()
    book = book.marked("root", 3, (1.0, 1.0))
    assert not book.can_redo
    assert {name: dict(marks) for name, marks in book.marks.items()} == {
        "tip": {1: (2.0, 3.0)},
        "root": {3: (1.0, 1.0)},
    }


def test_the_history_forgets_its_beginning_and_no_more():
    book = KeyPointBook()
    for step in range(MOST_STEPS + 5):
        book = book.marked("tip", 1, (float(step), 0.0))
    for _ in range(MOST_STEPS):
        book = book.undone()
    assert not book.can_undo
    assert book.marks["tip"][1] == (4.0, 0.0)


def test_what_is_no_mark_is_refused_with_a_sentence():
    book = KeyPointBook().marked(" left   tip ", 1, (2.0, 3.0))
    assert list(book.marks) == ["left tip"]
    with pytest.raises(ValueError, match="name has 1 to 40 printable characters"):
        checked_name(" \n ")
    with pytest.raises(ValueError, match="has 41"):
        book.marked("x" * 41, 1, (0.0, 0.0))
    with pytest.raises(ValueError, match="printable"):
        book.renamed("left tip", "a\u200bb")
    with pytest.raises(ValueError, match="numbered from 1"):
        book.marked("left tip", 0, (0.0, 0.0))
    with pytest.raises(ValueError, match="finite row and column"):
        book.marked("left tip", 1, (float("nan"), 0.0))
    with pytest.raises(ValueError, match="not marked in frame 2"):
        book.without_mark("left tip", 2)
    with pytest.raises(ValueError, match='no key point "root"'):
        book.without("root")
    with pytest.raises(ValueError, match='"root" already'):
        book.marked("root", 1, (0.0, 0.0)).renamed("left tip", "root")
    with pytest.raises(ValueError, match=r"between 0\.01 and 100 px; got 0"):
        book.with_sigma_px(0.0)
    for number in range(MOST_POINTS - 1):
        book = book.marked(f"point {number}", 1, (0.0, 0.0))
    with pytest.raises(ValueError, match="200 key points"):
        book.marked("one more", 1, (0.0, 0.0))
