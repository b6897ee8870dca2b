"""What one part of the physics experiment hands out."""

from collections.abc import Callable
from dataclasses import dataclass

from core.experiments.pictures import Picture
from core.experiments.results import Figure

Progress = Callable[[str, int, int], None]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Part:
    """The figures of one part, with their targets, and its pictures."""

    figures: tuple[Figure, ...]
    pictures: tuple[Picture, ...] = ()
