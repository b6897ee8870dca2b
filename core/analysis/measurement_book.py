"""The book of measurements: what is to be measured on every hull, with the way back.

Every change gives another book. Names tell measurements apart for people; an entry's key tells
whether two books measure the same, so that a new name or note leaves a number what it was.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace

from core.analysis.history import NothingLeft
from core.measurement.specs import DependentSpec, Spec, check_specs

MOST_MEASUREMENTS = 1000
"""In one book: all of them are measured on every hull."""

MOST_STEPS = 500
"""That can be taken back; older ones are forgotten."""


class Referred(ValueError):  # noqa: N818 - the state that is wrong, as a person says it
    """A measurement cannot go, because others are computed from it."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Entry:
    """A measurement in the book.

    Attributes:
        spec: how it is measured.
        is_hidden: whether it is left out of the drawing.
        key: another one for all that measures something else; a new name keeps it.
    """

    spec: Spec
    is_hidden: bool = False
    key: int = 0

    @property
    def name(self) -> str:
        """What a person calls it."""
        return self.spec.name


Page = tuple[Entry, ...]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MeasurementBook:
    """Measurements in their order, and the pages that undo and redo go through.

    Attributes:
        pages: oldest first; those past `position` have been taken back.
        position: of the present one.
        next_key: that no entry has had yet.
    """

    pages: tuple[Page, ...] = ((),)
    position: int = 0
    next_key: int = field(default=1)

    @property
    def entries(self) -> Page:
        """The measurements that there are now."""
        return self.pages[self.position]

    @property
    def specs(self) -> tuple[Spec, ...]:
        """How they are measured."""
        return tuple(entry.spec for entry in self.entries)

    @property
    def can_undo(self) -> bool:
        """Whether there is a change to take back."""
        return self.position > 0

    @property
    def can_redo(self) -> bool:
        """Whether a change that was taken back can be made again."""
        return self.position < len(self.pages) - 1

    def entry(self, name: str) -> Entry:
        """Return the measurement of a name.

        Raises:
            ValueError: there is none.
        """
        found = next((entry for entry in self.entries if entry.name == name), None)
        if found is None:
            raise ValueError(f'There is no measurement "{name}".')
        return found

    def dependents(self, name: str) -> tuple[str, ...]:
        """Return the names of all that is computed from a measurement, and from that in turn."""
        found: list[str] = [name]
        for one in found:  # grows while it is gone through
            found += [
                spec.name
                for spec in self.specs
                if isinstance(spec, DependentSpec)
                and one in (spec.first, spec.second)
                and spec.name not in found
            ]
        return tuple(found[1:])

    def free_name(self, stem: str) -> str:
        """Return the stem with the least number that makes a name which nothing has yet."""
        names = {entry.name for entry in self.entries}
        number = 1
        while f"{stem} {number}" in names:
            number += 1
        return f"{stem} {number}"

    def added(self, specs: Sequence[Spec]) -> "MeasurementBook":
        """Return the book with more measurements at its end, all in one step.

        Raises:
            ValueError: a name that is taken, a reference to none, or too many.
        """
        more = tuple(
            Entry(spec=spec, key=self.next_key + number) for number, spec in enumerate(specs)
        )
        return self._turned((*self.entries, *more))

    def taken_in(
        self, specs: Sequence[Spec], is_same: Callable[[Spec, Spec], bool]
    ) -> "MeasurementBook":
        """Return the book with those measurements at its end that it does not have yet.

        Args:
            specs: as a file has them.
            is_same: tells whether two specs of one name are the same.

        Raises:
            ValueError: another measurement has such a name already, or as `added`.
        """
        known = {entry.name: entry.spec for entry in self.entries}
        other = [s.name for s in specs if s.name in known and not is_same(s, known[s.name])]
        if other:
            raise ValueError(
                f"{_listed(other)} {'is' if len(other) == 1 else 'are'} here already and measured "
                "otherwise than in the file; rename or delete what is here, then import again. "
                "Nothing was imported."
            )
        fresh = [spec for spec in specs if spec.name not in known]
        return self.added(fresh) if fresh else self

    def replaced(self, name: str, spec: Spec) -> "MeasurementBook":
        """Return the book with another spec in a measurement's place.

        Where its name is another, what refers to it follows.

        Raises:
            ValueError: there is none of that name, the new name is taken, or a missing reference.
        """
        old = self.entry(name)
        return self._turned(
            replace(entry, spec=spec, key=self.next_key)
            if entry is old
            else _following(entry, name, spec.name)
            for entry in self.entries
        )

    def renamed(self, name: str, new: str) -> "MeasurementBook":
        """Return the book with a measurement under another name; what refers to it follows.

        Raises:
            ValueError: there is none of that name, or the new one is taken or no name.
        """
        old = self.entry(name)
        spec = replace(old.spec, name=new)
        return self._turned(
            _following(replace(entry, spec=spec) if entry is old else entry, name, new)
            for entry in self.entries
        )

    def noted(self, name: str, note: str) -> "MeasurementBook":
        """Return the book with another note to a measurement.

        Raises:
            ValueError: there is none of that name, or a note that is no text.
        """
        old = self.entry(name)
        return self._swapped(old, replace(old, spec=replace(old.spec, note=note)))

    def hidden(self, name: str, is_hidden: bool) -> "MeasurementBook":
        """Return the book with a measurement hidden, or on show.

        Raises:
            ValueError: there is none of that name.
        """
        old = self.entry(name)
        return self._swapped(old, replace(old, is_hidden=is_hidden))

    def removed(self, name: str, *, along: bool = False) -> "MeasurementBook":
        """Return the book without a measurement.

        Args:
            name: of the measurement.
            along: whether what is computed from it goes too.

        Raises:
            ValueError: there is none of that name.
            Referred: others are computed from it, and shall not go along.
        """
        self.entry(name)
        dependents = self.dependents(name)
        if dependents and not along:
            are = "is" if len(dependents) == 1 else "are"
            raise Referred(
                f'{_listed(dependents)} {are} computed from "{name}"; delete '
                f"{'it' if len(dependents) == 1 else 'them'} too, or first."
            )
        gone = {name, *dependents}
        return self._turned(entry for entry in self.entries if entry.name not in gone)

    def cleared(self) -> "MeasurementBook":
        """Return the book without any measurement; one step takes all of them back."""
        return self._turned(()) if self.entries else self

    def undone(self) -> "MeasurementBook":
        """Return the book one change back.

        Raises:
            NothingLeft: there is none.
        """
        if not self.can_undo:
            raise NothingLeft("There is no change of the measurements to take back.")
        return replace(self, position=self.position - 1)

    def redone(self) -> "MeasurementBook":
        """Return the book one change forward again.

        Raises:
            NothingLeft: there is none.
        """
        if not self.can_redo:
            raise NothingLeft("There is no change of the measurements to make again.")
        return replace(self, position=self.position + 1)

    def _swapped(self, old: Entry, new: Entry) -> "MeasurementBook":
        return self._turned(new if entry is old else entry for entry in self.entries)

    def _turned(self, entries: Iterable[Entry]) -> "MeasurementBook":
        """Return the book with one more page; what had been taken back is out of reach."""
        page = tuple(entries)
        if len(page) > MOST_MEASUREMENTS:
            raise ValueError(
                f"At most {MOST_MEASUREMENTS} measurements are kept, this would make {len(page)}; "
                "delete some first."
            )
        check_specs(tuple(entry.spec for entry in page))
        pages = (*self.pages[: self.position + 1], page)[-MOST_STEPS - 1 :]
        newest = max((entry.key for entry in page), default=0)
        return MeasurementBook(
            pages=pages,
            position=len(pages) - 1,
            next_key=max(self.next_key, newest + 1),
        )


def _following(entry: Entry, name: str, new: str) -> Entry:
    """Return an entry whose references to one name go to another."""
    spec = entry.spec
    if name == new or not isinstance(spec, DependentSpec) or name not in (spec.first, spec.second):
        return entry
    first, second = (new if each == name else each for each in (spec.first, spec.second))
    return replace(entry, spec=replace(spec, first=first, second=second))


def _listed(names: Sequence[str]) -> str:
    """Return names as people list them, the first few of many."""
    quoted = [f'"{name}"' for name in names[:4]]
    if len(names) > 4:
        quoted.append(f"{len(names) - 4} more")
    return quoted[0] if len(quoted) == 1 else f"{', '.join(quoted[:-1])} and {quoted[-1]}"
