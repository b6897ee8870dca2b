"""What an experiment of the paper hands out: its numbers, its pictures and its hull."""

from collections.abc import Callable
from dataclasses import dataclass

from core.experiments.pictures import Picture
from core.experiments.results import Results
from core.hull.surface import Surface

Progress = Callable[[str, int, int], None]
"""Called with what is being done, how much is done, and how much there is."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Study:
    """One experiment, ready to be written.

    Attributes:
        results: figures, tables, and what was found in a sentence.
        pictures: frames with outlines, the hull beside the truth, errors.
        hull: the surface that the experiment is about.
    """

    results: Results
    pictures: tuple[Picture, ...]
    hull: Surface
