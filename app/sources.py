"""The sources that commands play and carve: the demo, and pass files."""

from collections.abc import Sequence
from functools import cache
from itertools import chain
from pathlib import Path

from app.source import NO_COURSE, Source
from core.experiments.demo import (
    DEMO_ORBIT,
    DEMO_PASSES,
    FRAMES_PER_PASS,
    demo_courses,
    demo_frames,
)
from core.formats.pass_file import read_pass
from core.geometry.orbit import satellite_from_elements
from core.radar.course import course_of_echoes, undivided_course
from core.radar.imaging import frame_count, frames

MIN_VIEWS = 2


def demo_source() -> Source:
    """Return the built-in demo."""
    return Source(
        name="Demo: Tiangong-1-like, three passes over Beijing",
        description="Echoes simulated at 16.7 GHz, 1 GHz bandwidth, 100 pulses per second.",
        frames=demo_frames,
        expected_frames=FRAMES_PER_PASS * len(DEMO_PASSES),
        course=cache(demo_courses),
        satellite=satellite_from_elements(DEMO_ORBIT),
    )


def pass_source(path: Path) -> Source:
    """Return a pass file's frames, and the images of its echoes where it holds no radar frames.

    Raises:
        ValueError: no readable pass file, or echoes that cannot be imaged.
    """
    recorded = read_pass(path)
    received, history = recorded.frames, recorded.history
    if history is None or any(frame.sensor == "radar" for frame in received):
        return Source(
            name=path.name,
            frames=lambda: received,
            expected_frames=len(received),
            course=NO_COURSE
            if history is None
            else cache(lambda: (undivided_course(history.track),)),
        )
    return Source(
        name=path.name,
        frames=lambda: chain(frames(history), received),
        expected_frames=frame_count(history) + len(received),
        course=cache(lambda: (course_of_echoes(history),)),
    )


def pass_sources(paths: Sequence[Path]) -> list[Source]:
    """Return one source per pass file; together they make a hull.

    Raises:
        ValueError: a file that `pass_source` refuses, or fewer than two frames in all.
    """
    sources = [pass_source(path) for path in paths]
    views = sum(source.expected_frames or 0 for source in sources)
    if views < MIN_VIEWS:
        names = ", ".join(str(path) for path in paths)
        raise ValueError(f"A hull needs at least {MIN_VIEWS} views; {names} gives {views}.")
    return sources
