"""Where the frames of a live reconstruction come from."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from uuid import uuid4

from skyfield.api import EarthSatellite

from core.frame import Frame
from core.radar.course import PassCourse

NO_COURSE: Callable[[], tuple[PassCourse, ...]] = tuple
"""Of frames that come without a track."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Source:
    """Frames that the workstation plays: a demo, a pass file, or what is pushed to it.

    Attributes:
        name: what a person calls it, in the page's top bar.
        description: one sentence on what the frames show.
        frames: starts a fresh sequence of frames; it may take its time over each.
        expected_frames: how many will come, None where that is unknown.
        course: gives the course of each pass, at once but for the first time; empty without tracks.
        satellite: the target's orbit, None where it is not known.
        key: another for every source, so that a page knows when another was loaded.
    """

    name: str
    frames: Callable[[], Iterable[Frame]]
    description: str = ""
    expected_frames: int | None = None
    course: Callable[[], tuple[PassCourse, ...]] = NO_COURSE
    satellite: EarthSatellite | None = None
    key: str = field(default_factory=lambda: uuid4().hex)


NO_SOURCE = Source(name="No pass loaded", frames=tuple)
"""What a workstation plays that waits for somebody to load a pass."""
