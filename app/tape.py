"""The frames of a source, remembered so that playing them again costs nothing."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

from core.frame import Frame
from core.silhouettes.extraction import ExtractionSettings, extract_silhouette
from core.silhouettes.silhouette import Silhouette


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Take:
    """A frame, and the outline that extraction by some settings found in it."""

    frame: Frame
    silhouette: Silhouette
    extraction: ExtractionSettings

    def outline_by(self, extraction: ExtractionSettings) -> Silhouette | None:
        """Return the outline if it was found by these settings, else None."""
        return self.silhouette if extraction == self.extraction else None


class Tape:
    """Asks a source for each frame once.

    A source's failure is remembered too: a generator that has raised looks finished afterwards.
    """

    def __init__(
        self, factory: Callable[[], Iterable[Frame]], extraction: ExtractionSettings
    ) -> None:
        """Remember what `factory` gives; nothing is asked for yet."""
        self._factory = factory
        self._extraction = extraction
        self._recorded: list[Take] = []
        self._rest: Iterator[Frame] | None = None
        self._failure: Exception | None = None

    def takes(self) -> Iterator[Take]:
        """Yield the recorded frames, then what the source has left."""
        yield from self._recorded
        while (take := self._next()) is not None:
            self._recorded.append(take)
            yield take

    def _next(self) -> Take | None:
        if self._failure is not None:
            raise self._failure
        try:
            if self._rest is None:
                self._rest = iter(self._factory())
            frame = next(self._rest, None)
            if frame is None:
                return None
            silhouette = extract_silhouette(frame, self._extraction)
            return Take(frame=frame, silhouette=silhouette, extraction=self._extraction)
        except Exception as failure:
            self._failure = failure
            raise
