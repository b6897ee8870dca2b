"""Laws of the book of measurements."""

from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.analysis.history import NothingLeft
from core.analysis.measurement_book import (
    MOST_MEASUREMENTS,
    MOST_STEPS,
    MeasurementBook,
    Referred,
)
from core.formats.measurement_fields import encoded
from core.measurement.specs import AngleBetween, ScaleFactor, Section, Volume, check_specs

NAMES = st.sampled_from(["a", "b", "c", "d"])


def told(book: MeasurementBook) -> list[object]:
    return [(encoded(entry.spec), entry.is_hidden, entry.key) for entry in book.entries]


def alike(one, other) -> bool:
    return encoded(one) == encoded(other)


STEPS = st.one_of(
    st.builds(lambda name: lambda book: book.added([Volume(name=name)]), NAMES),
    st.builds(
        lambda name, first, second: (
            lambda book: book.added([ScaleFactor(name=name, first=first, second=second)])
        ),
        *(NAMES, NAMES, NAMES),
    ),
    st.builds(lambda name, new: lambda book: book.renamed(name, new), NAMES, NAMES),
    st.builds(
        lambda name, new: lambda book: book.replaced(name, Section(name=new, normal=[0, 0, 1])),
        *(NAMES, NAMES),
    ),
    st.builds(lambda name, it: lambda book: book.hidden(name, it), NAMES, st.booleans()),
    st.builds(lambda name, note: lambda book: book.noted(name, note), NAMES, st.text("xy")),
    st.builds(lambda name, it: lambda book: book.removed(name, along=it), NAMES, st.booleans()),
    st.sampled_from([MeasurementBook.cleared, MeasurementBook.undone, MeasurementBook.redone]),
)
WAYS = (MeasurementBook.undone, MeasurementBook.redone)


def stepped(book: MeasurementBook, step: Callable) -> MeasurementBook:
    """Return the book after a step, or as it is where the step is refused."""
    try:
        return step(book)
    except ValueError:
        return book


@given(st.lists(STEPS, max_size=25))
def test_every_book_holds_together_and_every_change_can_be_taken_back_and_made_again(steps) -> None:
    book = MeasurementBook()
    for step in steps:
        after = stepped(book, step)
        check_specs(after.specs)
        keys = [entry.key for entry in after.entries]
        assert len(set(keys)) == len(keys)
        assert all(key < after.next_key for key in keys)
        if after is not book and step not in WAYS:
            assert told(after.undone()) == told(book)
            assert told(after.undone().redone()) == told(after)
        book = after
    while book.can_undo:
        book = book.undone()
    assert book.entries == ()


@given(st.lists(STEPS, max_size=12), NAMES, NAMES)
def test_renaming_leaves_what_is_measured_and_is_undone_by_renaming_back(steps, old, new) -> None:
    book = MeasurementBook()
    for step in steps:
        book = stepped(book, step)
    names = [entry.name for entry in book.entries]
    if old not in names or new in names:
        return
    renamed = book.renamed(old, new)
    assert [entry.key for entry in renamed.entries] == [entry.key for entry in book.entries]
    assert set(renamed.dependents(new)) == {n for n in book.dependents(old) if n != old} or (
        old in book.dependents(old)
    )
    assert told(renamed.renamed(new, old)) == told(book)


@pytest.fixture
def book() -> MeasurementBook:
    """Two volumes, their quotient, and an angle that refers to the quotient."""
    return MeasurementBook().added(
        [
            Volume(name="a"),
            Volume(name="b"),
            ScaleFactor(name="a/b", first="a", second="b"),
            AngleBetween(name="angle", first="a/b", second="b"),
        ]
    )


def test_what_others_are_computed_from_goes_only_with_them(book) -> None:
    assert book.dependents("a") == ("a/b", "angle")
    with pytest.raises(Referred, match='"a/b" and "angle" are computed from "a"; delete them too'):
        book.removed("a")
    assert [entry.name for entry in book.removed("a", along=True).entries] == ["b"]
    assert [entry.name for entry in book.removed("angle").entries] == ["a", "b", "a/b"]


def test_what_refers_to_a_name_follows_it(book) -> None:
    after = book.renamed("b", "beam").replaced("a", Volume(name="all"))
    factor, angle = after.specs[2:]
    assert (factor.first, factor.second, angle.second) == ("all", "beam", "beam")
    assert after.entries[0].key not in [entry.key for entry in book.entries]
    assert [entry.key for entry in after.entries[1:]] == [entry.key for entry in book.entries[1:]]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda book: book.added([Volume(name="a")]), '2 measurements are called "a"'),
        (lambda book: book.renamed("a", "b"), '2 measurements are called "b"'),
        (lambda book: book.renamed("a", " "), "needs a name"),
        (lambda book: book.renamed("z", "y"), 'no measurement "z"'),
        (lambda book: book.hidden("z", True), 'no measurement "z"'),
        (lambda book: book.removed("z"), 'no measurement "z"'),
        (
            lambda book: book.added([ScaleFactor(name="q", first="a", second="z")]),
            'refers to "z"',
        ),
        (
            lambda book: book.added([Volume(name=f"v{n}") for n in range(MOST_MEASUREMENTS)]),
            "this would make 1004",
        ),
    ],
)
def test_what_cannot_be_is_refused_in_words(book, change, words) -> None:
    with pytest.raises(ValueError, match=words):
        change(book)


def test_the_way_back_has_an_end_and_says_so(book) -> None:
    with pytest.raises(NothingLeft, match="no change of the measurements to take back"):
        MeasurementBook().undone()
    with pytest.raises(NothingLeft, match="to make again"):
        book.redone()
    for number in range(MOST_STEPS + 20):
        book = book.hidden("a", number % 2 == 0)
    assert len(book.pages) == MOST_STEPS + 1


def test_taking_in_adds_what_is_new_and_refuses_what_is_other(book) -> None:
    same = book.taken_in([Volume(name="a"), Volume(name="c")], alike)
    assert [entry.name for entry in same.entries][-1] == "c"
    assert told(same.undone()) == told(book)
    assert book.taken_in(book.specs, alike) is book
    with pytest.raises(ValueError, match=r'"b" is here already .* Nothing was imported\.'):
        book.taken_in([Volume(name="d"), Volume(name="b", note="other")], alike)


def test_several_changes_can_be_one_step(book) -> None:
    after = book.then(book.noted("a", "x").hidden("a", True).renamed("a", "c"))
    assert (after.entries[0].name, after.entries[0].is_hidden) == ("c", True)
    assert told(after.undone()) == told(book)
    assert book.then(book) is book


def test_free_names_are_numbered_from_one(book) -> None:
    assert book.free_name("length") == "length 1"
    assert book.added([Volume(name="length 1")]).free_name("length") == "length 2"
